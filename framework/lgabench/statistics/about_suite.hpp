// What a suite asks, in words for readers: "about" of its file.
#pragma once
#include <map>
#include <optional>
#include <string>

#include <lgabench/core/json.hpp>

namespace lgabench::statistics {

struct AboutSuite {
  std::string title;                              // its id where it says none
  std::string question;                           // a sentence; "" where the suite says none
  std::string main_arm;                           // that its question is about; "" where it says none
  std::optional<int> main_demonstrations;         // likewise
  std::map<std::string, std::string> arms;        // what their test scenes are
  std::map<std::string, std::string> arm_titles;  // of arms, and of variants
  std::map<std::string, std::string> rows;        // method, with its options -> what tells it from the others
  std::map<std::string, std::string> presets;     // what the board says beside a preset's table
  Json options = Json::object();                  // method or "*" -> option -> value, of the suite's own design

  /// What the arm's scenes are; that of "seen" for "seen_members_1", an arm of a variant. "" where nothing is said.
  std::string arm(const std::string& name) const;
  /// "4 near misses" for "near_4"; "new, 2 members" for "new_members_2", an arm of a variant; the id where nothing is
  /// said.
  std::string arm_title(const std::string& name) const;
  /// What tells the row from the others; "" where nothing is said.
  std::string row(const std::string& method) const;
};

/// The file of an installed suite; empty where there is none of that name.
fs::path installed_suite(const std::string& id);

/// What is said about the suite of a run: `of_run`, what the run says (else null), or what the installed suite says.
/// For any other suite it is the title alone, which is its id. @throws InputError for an `of_run` that is not as
/// docs/formats says.
AboutSuite about_suite(const std::string& id, const Json& of_run = nullptr);

}  // namespace lgabench::statistics
