// What a suite asks, in words for readers: "about" of its file.
#pragma once
#include <map>
#include <optional>
#include <string>

#include <lgabench/core/json.hpp>

namespace lgabench::report {

struct AboutSuite {
  std::string question;                     // a sentence; "" where the suite says none
  std::string main_arm;                     // that its question is about; "" where it says none
  std::optional<int> main_demonstrations;   // likewise
  std::map<std::string, std::string> arms;  // what their test scenes are
  std::map<std::string, std::string> rows;  // method, with its options -> what tells it from the others
  Json options = Json::object();            // method or "*" -> option -> value, of the suite's own design

  /// What the arm's scenes are; that of "seen" for "seen_members_1", an arm of a variant. "" where nothing is said.
  std::string arm(const std::string& name) const;
  /// What tells the row from the others; "" where nothing is said.
  std::string row(const std::string& method) const;
};

/// The file of an installed suite; empty where there is none of that name.
fs::path installed_suite(const std::string& id);

/// That of an installed suite; empty for one that is not installed, such as a file of the user's own.
AboutSuite about_suite(const std::string& id);

}  // namespace lgabench::report
