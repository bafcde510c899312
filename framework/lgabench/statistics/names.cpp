#include <lgabench/statistics/names.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <tuple>

#include <lgabench/core/json.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/reference_rows.hpp>

namespace lgabench::statistics {
namespace {

struct Symbol {
  const char* name;
  int sides;
  double turned;
};
constexpr std::array<Symbol, 9> marks{{{"circle", 0, 0},
                                       {"square", 4, 45},
                                       {"triangle", 3, -90},
                                       {"diamond", 4, 0},
                                       {"triangle_down", 3, 90},
                                       {"pentagon", 5, -90},
                                       {"hexagon", 6, 0},
                                       {"triangle_right", 3, 0},
                                       {"triangle_left", 3, 180}}};
constexpr std::array<const char*, 4> spare{"#8C564B", "#7F3C8D", "#4B6A00", "#909400"};

struct Known {
  std::string name, colour;  // "" for a reference row
  int rank = 0;
  std::size_t mark = 0;
  std::vector<double> dashes{};
};

const JsonReader& methods_file() {
  static const fs::path file = data_directory() / "paper" / "methods.json";
  static const Json json = read_json(file);
  static const JsonReader reader(json, file.string());
  return reader;
}

// The methods of methods.json and the reference rows, by id.
const std::map<std::string, Known>& known() {
  static const std::map<std::string, Known> all = [] {
    const JsonReader& reader = methods_file();
    std::map<std::string, Known> found;
    int rank = 0;
    for (const JsonReader& method : reader.at("methods").elements()) {
      const std::string word = method.at("mark").string();
      const auto mark = std::find_if(marks.begin(), marks.end(), [&word](const Symbol& m) { return word == m.name; });
      if (mark == marks.end()) method.at("mark").fail("circle, square, triangle, diamond, triangle_down, ...");
      found[method.at("id").string()] = {method.at("name").string(), method.at("colour").string(), rank++,
                                         static_cast<std::size_t>(mark - marks.begin())};
    }
    if (const auto people = found.find("human"); people != found.end()) {
      Known stand_in = people->second;
      stand_in.name = "True mask";
      found[true_mask_row] = stand_in;
    }
    ++rank;  // that of methods which are not there
    for (const bool bounds : {false, true})
      for (const ReferenceRow& row : reference_rows())
        if (row.is_bound == bounds) found[row.id] = {row.name, "", rank++, 0, row.dashes};
    return found;
  }();
  return all;
}

// The words for an id, or the text where it is none. A letter after a dot is a file's or an option's name.
std::string id_in_words(const std::string& text) {
  const auto inside = text.find_first_of("_=", 1);
  const auto dot = text.find('.');
  if (inside == text.npos || inside + 1 == text.size() || text.find('/') != text.npos || text.front() == '-' ||
      std::none_of(text.begin(), text.end(), [](unsigned char c) { return std::islower(c); }) ||
      (dot + 1 < text.size() && dot != text.npos && std::isalpha(static_cast<unsigned char>(text[dot + 1]))))
    return text;
  const Json& values = methods_file().at("values").json();
  if (const auto value = values.find(text); value != values.end()) return value->get<std::string>();
  if (const auto method = known().find(text); method != known().end()) return method->second.name;
  std::string words = text;
  for (char& c : words)
    if (c == '_' || c == '=') c = ' ';
  return words;
}

// nullptr for an id that is not known().
const Known* find(const std::string& method) {
  const auto it = known().find(row_id(method));
  return it == known().end() ? nullptr : &it->second;
}

}  // namespace

std::string display_name(const std::string& method) {
  std::vector<std::string> words = row_words(without_selected_by(method));
  if (const Known* known = find(method)) words.front() = known->name;
  if (selects_alone(method)) words.front() = "selected by " + words.front();
  return fmt::format("{}", fmt::join(words, " "));
}

std::string readable(const std::string& text) {
  const auto of_id = [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '=' || c == '-' || c == '.' || c == '/';
  };
  std::string out;
  for (auto at = text.begin(); at != text.end();) {
    auto end = std::find_if_not(at, text.end(), of_id);
    const bool quoted = at != text.begin() && std::string_view("\"'`").find(at[-1]) != std::string_view::npos;
    while (end - at > 1 && end[-1] == '.') --end;
    if (end == at) ++end;
    const std::string id(at, end);
    std::string words = quoted ? id : id_in_words(id);
    const std::string with = "with ";  // said before the id, it is not said again
    if (words != id && words.rfind(with, 0) == 0 && out.size() >= with.size() &&
        out.compare(out.size() - with.size(), with.size(), with) == 0)
      words.erase(0, with.size());
    if (words.empty() && !out.empty() && out.back() == ' ') out.pop_back();  // what goes without saying
    out += words;
    at = end;
  }
  return out;
}

std::string capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

int display_rank(const std::string& method) {
  if (const Known* known = find(method)) return known->rank;
  return static_cast<int>(
      std::count_if(known().begin(), known().end(), [](const auto& item) { return !item.second.colour.empty(); }));
}

bool ByRank::operator()(const std::string& a, const std::string& b) const {
  return std::tuple(display_rank(a), a) < std::tuple(display_rank(b), b);
}

MethodStyles::MethodStyles(const std::vector<std::string>& methods, std::map<std::string, std::string> shown_names)
    : told_(std::move(shown_names)) {
  std::vector<std::string> ordered = methods, strange;
  std::sort(ordered.begin(), ordered.end(), ByRank());
  std::map<std::string, std::size_t> variants;  // so far, by id
  for (const std::string& method : ordered) {
    if (styles_.count(method) != 0) continue;
    const std::string id = row_id(method);
    const std::size_t variant = variants[id]++;
    std::size_t mark = 0;
    MethodStyle& style = styles_[method];
    if (const Known* known = find(method)) {
      style.colour = known->colour;
      style.dashes = known->dashes;
      mark = known->mark;
    } else {
      if (variant == 0) strange.push_back(id);
      mark = static_cast<std::size_t>(std::find(strange.begin(), strange.end(), id) - strange.begin());
      style.colour = spare[mark % spare.size()];
    }
    const Symbol& drawn = marks[(mark + variant / 2) % marks.size()];
    style.sides = drawn.sides;
    style.turned = drawn.turned;
    style.hollow = variant % 2 == 1;
  }
}

std::string MethodStyles::name(const std::string& method) const {
  const auto found = told_.find(method);
  return display_name(found == told_.end() ? method : found->second);
}

const MethodStyle& MethodStyles::operator()(const std::string& method) const {
  static const MethodStyle none{};
  const auto it = styles_.find(method);
  return it == styles_.end() ? none : it->second;
}

std::string provenance_words(const std::string& provenance, bool erring) {
  const char* errors = erring ? ", with errors made in φ̂" : "";
  if (provenance == "rule") return fmt::format("computed by the method: nobody was asked{}", errors);
  if (provenance == "recorded") return fmt::format("a language model's recorded answers{}", errors);
  if (provenance == "live") return fmt::format("a language model asked during this run{}", errors);
  if (provenance == "cassette") return fmt::format("a language model's replies, replayed{}", errors);
  if (provenance == "truth") return erring ? "true φ̂ with errors made in it: no human data" : "true φ̂: no human data";
  if (provenance == "simulated_edit") return fmt::format("simulated edit{}: no human data", errors);
  if (provenance == "human") return fmt::format("people's answers{}", errors);
  return "";
}

bool was_asked(const std::string& provenance, const std::string& source) {
  return provenance != "recorded" || source.rfind("Claude (Anthropic", 0) != 0;
}

bool worded_otherwise(const std::string& asked_as, const std::string& utterance) {
  const auto words = [](std::string_view text) {
    return !text.empty() && text.back() == '.' ? text.substr(0, text.size() - 1) : text;
  };
  return !asked_as.empty() && words(asked_as) != words(utterance);
}

}  // namespace lgabench::statistics
