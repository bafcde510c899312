// What `lgabench check-plugin` finds.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// What was found in one respect. A note is no fault: a sound method may leave out a sweep's obstacle, say, and fail
/// those cells.
struct Finding {
  enum class State { ok, note, problem } state = State::ok;
  std::string check;   // what was looked at, in a word or two
  std::string detail;  // what was found
  std::string fix;     // of a note or a problem: what to do about it
};
std::string to_string(Finding::State state);

/// All of one process's findings, and hashes of what the plugin computed there: two processes must agree on them.
struct CheckReport {
  std::vector<Finding> findings;
  Json hashes = Json::object();  // {"selections": ..., "training": ..., "actions": ...}

  void ok(const std::string& check, const std::string& detail);
  void note(const std::string& check, const std::string& detail, const std::string& fix);
  void problem(const std::string& check, const std::string& detail, const std::string& fix);
  /// ok(), or problem() where `fault` is not empty.
  void judge(const std::string& check, const std::string& fault, const std::string& detail, const std::string& fix);
};
Json to_json(const CheckReport& report);
/// @throws InputError for what to_json() did not write.
CheckReport read_check_report(const Json& json, const std::string& file);

}  // namespace lgabench
