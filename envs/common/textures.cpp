#include <common/textures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include <common/patterns.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench::common {
namespace {

// docs/gallery.md.
const std::map<std::string, Rgb> palette{
    {"blue", {78, 121, 167}},   {"red", {255, 87, 89}},     {"green", {89, 169, 79}},
    {"orange", {242, 142, 43}}, {"yellow", {237, 201, 72}}, {"purple", {176, 122, 161}},
    {"pink", {255, 157, 167}},  {"cyan", {118, 183, 178}},  {"olive", {128, 128, 0}},
};

// HSV value - .3 at the same hue and saturation: every channel shrinks by (max - 76.5) / max, rounded half up.
Rgb darkened(Rgb colour) {
  const int twice_max = 2 * *std::max_element(colour.begin(), colour.end());
  for (std::uint8_t& c : colour)
    c = static_cast<std::uint8_t>((2 * c * std::max(twice_max - 153, 0) + twice_max) / (2 * twice_max));
  return colour;
}

// Removes the word and its blank from the front of the text; false where it is not there.
bool take_prefix(std::string& text, const std::string& word) {
  if (text.compare(0, word.size() + 1, word + " ") != 0) return false;
  text.erase(0, word.size() + 1);
  return true;
}

// Takes the word from the back.
bool take_suffix(std::string& text, const std::string& word) {
  const std::string end = " " + word;
  if (text.size() <= end.size() || text.compare(text.size() - end.size(), end.size(), end) != 0) return false;
  text.erase(text.size() - end.size());
  return true;
}

std::optional<Pattern> pattern(const std::string& name) {
  if (Pattern made_of = material(name); made_of.paint) return made_of;
  std::string words = name;
  const bool dark = take_prefix(words, "dark");
  const auto colour = [dark](const std::string& word) -> std::optional<Rgb> {
    const auto found = palette.find(word);
    if (found == palette.end()) return std::nullopt;
    return dark ? darkened(found->second) : found->second;
  };
  const auto of_one = [&](Pattern (*make)(Rgb)) -> std::optional<Pattern> {
    const auto c = colour(words);
    if (!c) return std::nullopt;
    return make(*c);
  };
  const auto of_two = [&](Pattern (*make)(Rgb, Rgb)) -> std::optional<Pattern> {
    const std::size_t gap = words.find(" and ");
    if (gap == std::string::npos) return std::nullopt;
    const auto a = colour(words.substr(0, gap)), b = colour(words.substr(gap + 5));
    if (!a || !b) return std::nullopt;
    return make(*a, *b);
  };
  if (take_suffix(words, "stripe")) return of_two(stripe);
  if (take_suffix(words, "polka dot")) return of_two(polka_dot);
  if (take_suffix(words, "swirl")) return of_one(swirl);
  if (take_suffix(words, "paisley")) return of_one(paisley);
  return of_one(plain);
}

Texture painted(const std::string& name, const Pattern& pattern) {
  Texture made{name, pattern.scale_m, {}};
  made.pixels.reserve(Texture::size * Texture::size);
  for (int row = 0; row < Texture::size; ++row)
    for (int column = 0; column < Texture::size; ++column)
      made.pixels.push_back(pattern.paint((column + 0.5) / Texture::size, (row + 0.5) / Texture::size));
  return made;
}

}  // namespace

const Texture& texture(const std::string& name) {
  static std::mutex guard;
  static std::map<std::string, Texture> made;  // a map's elements stay where they are
  const std::lock_guard<std::mutex> lock(guard);
  const auto known = made.find(name);
  if (known != made.end()) return known->second;
  const std::optional<Pattern> found = pattern(name);
  if (!found) throw InputError(fmt::format("texture \"{}\": no such texture", name));
  return made.emplace(name, painted(name, *found)).first->second;
}

}  // namespace lgabench::common
