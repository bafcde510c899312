// What `lgabench check-plugin` looks at. A method runs in a process of its own, as in a run; an engine in this one.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/host/hosted_method.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// What was found in one respect.
struct Finding {
  enum class State { ok, note, problem } state = State::ok;
  std::string check;   // what was looked at, in a word or two
  std::string detail;  // what was found
  std::string fix;     // of a note or a problem: what to do about it
};
std::string to_string(Finding::State state);
Json to_json(const Finding& finding);
/// @throws InputError for what to_json() did not write.
Finding read_finding(const JsonReader& reader);

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
CheckReport read_check_report(const Json& json, const std::string& file);

/// Told before each step, so that whoever waits knows where a crash happened.
using CheckPhase = std::function<void(const std::string& phase)>;

/// Uses the method twice from loading to acting, on small but real cells (heart, q3_fruit; sweep is selected for only),
/// with the same seed, which is not the job's. Returns all findings; one thread.
/// @throws PluginError if it cannot be loaded, MethodGone where its process ends; whatever else it throws is a finding.
/// EngineError for the engine's fault.
CheckReport check_method(HostJob job, const PluginInfo& engine, const CheckPhase& phase);

/// Lets the oracle play scenes of every task on the engine, forwards and backwards, likewise.
CheckReport check_engine(const PluginInfo& engine, const CheckPhase& phase);

/// Adds what is left behind: `now` says what a process holds beyond what it held before the plugin came. Threads are
/// given half a second to end.
void judge_leftovers(CheckReport& report, const std::function<ProcessState()>& now);

}  // namespace lgabench
