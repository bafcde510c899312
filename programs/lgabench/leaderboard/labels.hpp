// What the rows of a board are called: results/leaderboard/labels.json, which is the maintainers'.
#pragma once
#include <map>
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

inline constexpr const char* labels_file = "labels.json";
constexpr std::size_t longest_label = 60;  // characters that authors may propose

/// Words in place of options. `values`: "network=plain" -> "without batch normalisation". `rows`: of an id with these
/// options, the words that stand for both.
struct Labels {
  struct RowLabel {
    std::string id, label;
    Json options = Json::object();
  };
  std::map<std::string, std::string> values;
  std::vector<RowLabel> rows;
};

/// The board's labels; none where it has no such file. @throws InputError for a file that is not as docs/formats says.
Labels read_labels(const fs::path& board);

/// What the entry is called, of whose options those in `telling` tell it from other rows of the table: the words of
/// `rows` with the most options that fit, else a reference row's name, else the label that its authors propose, else
/// the method's name; then, unless they stand for them, the words of its telling options, "option=value" where `values`
/// has none; then where its names and segments come from, likewise. An empty word is left out; `policy` and `network`
/// stand in policy_label().
std::string label_of(const Labels& labels, const Entry& entry, const std::vector<std::string>& telling);

/// What its policy is called: the words of `policy`, and of `network` where that is the paper's; "its own" of a method
/// without that option, "" of a reference row.
std::string policy_label(const Labels& labels, const Entry& entry);

/// Whose answers it acts on, in a few words: "a model, recorded"; "" of what selects nothing.
std::string answers_label(const Entry& entry);

}  // namespace lgabench::leaderboard
