#include <lgabench/drawn/phrases.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace lgabench::drawn {
namespace {

bool begins(const std::string& text, const std::string& with) { return text.compare(0, with.size(), with) == 0; }

// A look's words behind a noun: "that looks ... on it", "that look ... on them".
std::string behind(std::string words, bool many) {
  const std::string looks = "that looks ", on_it = " on it";
  if (many && begins(words, looks)) words = "that look " + words.substr(looks.size());
  if (many && words.size() > on_it.size() && words.compare(words.size() - on_it.size(), on_it.size(), on_it) == 0)
    words = words.substr(0, words.size() - 2) + "them";
  return words;
}

std::string relative_clause(const std::string& words, bool many) {
  const std::string with = "with ";
  const std::string text = behind(words, many);
  if (begins(text, "that ")) return text;
  if (begins(text, with)) return (many ? "that have " : "that has ") + text.substr(with.size());
  return (many ? "that are " : "that is ") + text;
}

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

// "leaving out the vowels and those with stripes"; "but neither a vowel nor one with stripes"; nothing without words.
std::string exceptions_in_words(const std::string& of, std::vector<Exception> exceptions, bool of_many) {
  std::stable_partition(exceptions.begin(), exceptions.end(), [](const Exception& one) { return !one.is_look; });
  std::vector<std::string> words;
  for (const Exception& one : exceptions) words.push_back(of_many ? one.many : one.a);
  if (std::count(words.begin(), words.end(), "") > 0) return "";
  if (of_many) return fmt::format(", leaving out {}", fmt::join(words, " and "));
  const bool something = begins(of, "something ");
  if (exceptions.size() == 1 && exceptions.front().is_look)
    return fmt::format(", but {} {}", something ? "nothing" : "none", words.front());
  for (std::size_t i = 0; i < words.size(); ++i)
    if (exceptions[i].is_look) words[i] = (something ? "anything " : "one ") + words[i];
  if (words.size() == 1) return ", but not " + words.front();
  return fmt::format(", but neither {}", fmt::join(words, " nor "));
}

}  // namespace

Phrase phrase(const FeatureSpace& space, const Things& things) {
  Phrase made{things.a, things.many, of_types(space, things.types, things.undecided), {}, {things.why}};
  if (!things.near.empty()) made.near.push_back(of_types(space, things.near, {}));
  return made;
}

Phrase with(const FeatureSpace& space, Phrase phrase, const Look& look, bool relative) {
  const Extent textures = of_textures(space, look.textures, look.undecided);
  for (Extent& near : phrase.near) near = both(near, textures);
  phrase.near.push_back(both(phrase.holds, of_textures(space, look.near, {})));
  phrase.holds = both(phrase.holds, textures);
  for (const auto& [words, many] : {std::pair{&phrase.a, false}, {&phrase.many, true}})
    if (!words->empty())
      *words += relative
                    ? (words->find(" that ") == std::string::npos ? " " : " and ") + relative_clause(look.words, many)
                    : " " + behind(look.words, many);
  phrase.why.push_back(look.why);
  return phrase;
}

Exception except(const FeatureSpace& space, const Things& things) {
  return {things.a,
          things.many.empty() ? "" : "the " + things.many,
          false,
          of_types(space, things.types, things.undecided),
          {things.why}};
}

Exception except(const FeatureSpace& space, const Look& look) {
  return {behind(look.words, false),
          "those " + behind(look.words, true),
          true,
          of_textures(space, look.textures, look.undecided),
          {look.why}};
}

Exception unless(const FeatureSpace& space, Exception look, const Things& things) {
  look.a = things.a.empty() ? "" : look.a + " unless it is " + things.a;
  look.many = things.many.empty() ? "" : look.many + " unless they are " + things.many;
  look.holds = both(look.holds, none_of(of_types(space, things.types, things.undecided)));
  look.why.push_back(things.why);
  return look;
}

Phrase without(Phrase phrase, const std::vector<Exception>& exceptions, bool of_many) {
  std::vector<Extent> excepted(exceptions.size(), phrase.holds);
  for (std::size_t i = 0; i < exceptions.size(); ++i) {
    const Extent others = none_of(exceptions[i].holds);
    phrase.holds = both(phrase.holds, others);
    for (Extent& near : phrase.near) near = both(near, others);
    for (std::size_t j = 0; j < exceptions.size(); ++j)
      excepted[j] = both(excepted[j], i == j ? exceptions[i].holds : others);
    append(phrase.why, exceptions[i].why);
  }
  phrase.near.insert(phrase.near.end(), excepted.begin(), excepted.end());
  std::string& words = of_many ? phrase.many : phrase.a;
  const std::string more = exceptions_in_words(phrase.a, exceptions, of_many);
  words = words.empty() || more.empty() ? "" : words + more;
  return phrase;
}

Rule relation(const FeatureSpace& space, Which::Rule rule, const Things& reference) {
  const bool beside = rule <= Which::Rule::farthest_from;
  Rule made;
  made.which.rule = rule;
  if (beside) {
    made.which.of = FeatureSet{reference.types, space.textures};
    made.undecided = reference.undecided;
    made.why = {reference.why};
    if (reference.ref.empty()) return made;
  }
  switch (rule) {
    case Which::Rule::left_of:
      made.words = fmt::format("the one nearest to {} among those to its left in the picture", reference.ref);
      break;
    case Which::Rule::right_of:
      made.words = fmt::format("the one nearest to {} among those to its right in the picture", reference.ref);
      break;
    case Which::Rule::nearest_to:
      made.words = "the one nearest to " + reference.ref;
      break;
    case Which::Rule::farthest_from:
      made.words = "the one farthest from " + reference.ref;
      break;
    case Which::Rule::leftmost:
      made.words = "the one on the far left of the picture";
      break;
    case Which::Rule::rightmost:
      made.words = "the one on the far right of the picture";
      break;
    case Which::Rule::first_in:
      break;
  }
  return made;
}

Rule comparison(const Order& order, bool last) {
  Rule made{"the one " + (last ? order.last : order.first),
            {Which::Rule::first_in, std::nullopt, order.names},
            {},
            {order.why}};
  if (last) std::reverse(made.which.order.begin(), made.which.order.end());
  return made;
}

}  // namespace lgabench::drawn
