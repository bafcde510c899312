#include <lgabench/report/names.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include <lgabench/plugin/loader.hpp>

namespace lgabench::report {
namespace {

struct Name {
  const char *id, *shown, *color;
};
constexpr std::array<Name, 7> methods{{{"lga", "LGA", "#0072B2"},
                                       {"lga_hill", "LGA-HILL", "#009E73"},
                                       {"human", "Human", "#CC79A7"},
                                       {"lga_s", "LGA-S", "#56B4E9"},
                                       {"lga_l", "LGA-L", "#E69F00"},
                                       {"gcbc_seg", "GCBC-SEG", "#000000"},
                                       {"gcbc_dart", "GCBC-DART", "#D55E00"}}};
constexpr std::array<Name, 3> references{{{"constant_action", "best constant action", "#666666"},
                                          {"random_object", "random visible object", "#888888"},
                                          {"oracle", "oracle", "#AAAAAA"}}};
constexpr std::array<const char*, 4> spare{"#8C564B", "#7F3C8D", "#4B6A00", "#A5AA00"};

// The entry of the row's id; nullptr where it has none.
template <typename Names>
const Name* find(const Names& names, const std::string& method) {
  const std::string id = row_words(method).front();
  const auto it = std::find_if(names.begin(), names.end(), [&id](const Name& n) { return id == n.id; });
  return it == names.end() ? nullptr : &*it;
}

}  // namespace

std::string display_name(const std::string& method) {
  std::vector<std::string> words = row_words(method);
  if (const Name* name = find(methods, method)) words.front() = name->shown;
  if (const Name* name = find(references, method)) words.front() = name->shown;
  return fmt::format("{}", fmt::join(words, " "));
}

int display_rank(const std::string& method) {
  constexpr int unknown = static_cast<int>(methods.size());
  if (const Name* name = find(methods, method)) return static_cast<int>(name - methods.data());
  if (const Name* name = find(references, method)) return unknown + 1 + static_cast<int>(name - references.data());
  return unknown;
}

std::string display_color(const std::string& method, std::size_t index) {
  if (const Name* name = find(methods, method)) return name->color;
  if (const Name* name = find(references, method)) return name->color;
  return spare[index % spare.size()];
}

std::string provenance_words(const std::string& provenance) {
  if (provenance == "rule") return "computed by the method: nobody was asked";
  if (provenance == "recorded") return "a language model's recorded answers";
  if (provenance == "live") return "a language model asked during this run";
  if (provenance == "cassette") return "a language model's replies, replayed";
  if (provenance == "truth") return "true φ̂: an upper bound, no human data";
  if (provenance == "simulated_edit") return "simulated edit: no human data";
  if (provenance == "human") return "people's answers";
  return "";
}

bool worded_otherwise(const std::string& asked_as, const std::string& utterance) {
  const auto words = [](std::string_view text) {
    return !text.empty() && text.back() == '.' ? text.substr(0, text.size() - 1) : text;
  };
  return words(asked_as) != words(utterance);
}

}  // namespace lgabench::report
