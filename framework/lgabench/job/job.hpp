// The messages between `lgabench` and the workers that it starts. Each form is written and read here alone. A job is a
// JSON object on a worker's standard input.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/openai_options.hpp>
#include <lgabench/core/action.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench {

/// Set by a worker before it loads a plugin.
struct Limits {
  long long cpu_s = 1LL << 40, data_bytes = 1LL << 60;
};
/// A job's "limits". @throws InputError
Limits read_limits(const JsonReader& job);

/// A server's model that cells ask through Services::lm as they run: each question that the cassette does not answer,
/// once. Runs may share a cassette.
struct LiveModel {
  std::filesystem::path cassette;
  bool asks = true;      // false: the cassette must hold every reply
  int max_queries = -1;  // of a cell to the server; -1: no limit
  long reply_timeout_s = OpenAiOptions().timeout_s;
  int concurrency = 4;      // questions under way at once; cells take turns
  bool any_served = false;  // as of Cassette::add()
  std::string prompt{};     // as in ChatOptions
};

/// lgabench-worker cell
struct CellJob {
  Cell cell;
  std::optional<PluginInfo> engine;  // none: its environment has none
  std::optional<PluginInfo> method;  // none for a reference row
  std::filesystem::path directory;   // gets the cell's files
  std::filesystem::path cache;       // of demonstrations
  std::filesystem::path answers;     // files of answers that the cell names (harness/answers.hpp)
  std::filesystem::path scratch;     // empty, of the method's process
  Json build;                        // of build_hashes()
  bool confined = true;              // the method's process, see host/confine.hpp
  Limits limits{};                   // of the worker; of the method's process likewise
  std::optional<LiveModel> live{};   // that the cell asks
  std::optional<PluginInfo> acts{};  // the cell's acting method, where it has one
  bool attributed = true;            // whether the method is told the truth in the end, to find causes
  std::optional<std::vector<std::string>> debugger{};  // of HostJob
  bool keeps_policy = false;                           // what is learned stays with the cell
  std::optional<PluginInfo> environment{};             // of its scenes, where that is a plugin
  std::vector<PluginInfo> axes{};                      // perturbations that its scenario has of plugins
  std::optional<PluginInfo> perceiver{};               // what reads the cell's names, where that is a plugin
};
Json to_json(const CellJob& job);
/// Makes its environment's plugin known. @throws InputError; PluginError where a plugin is refused, or another one by
/// now.
CellJob read_cell_job(const JsonReader& reader);

/// lgabench-worker check-job
struct CheckJob {
  std::optional<PluginInfo> engine;  // none: `environment`, or the one that is checked, has none
  std::optional<PluginInfo> method;  // that is checked; none: the engine is
  Json options = Json::object();     // of the method, every one
  std::filesystem::path scratch;     // empty, of the method's process
  int perturb = 0;                   // as perturb_heap()
  std::filesystem::path report;      // gets a CheckReport
  Limits limits{};
  std::string environment{};                        // to play in; "": check_method() and the like say which
  Json scenario{};                                  // that a method plays alone; null: likewise
  std::optional<PluginInfo> perturbation{};         // that is checked instead; or a perceiver
  std::optional<PluginInfo> checked_environment{};  // that is checked instead
};
Json to_json(const CheckJob& job);
/// @throws as read_cell_job().
CheckJob read_check_job(const JsonReader& reader);

/// One scene for `lgabench-worker pictures`, which is told a list of them and answers with a line of JSON each.
struct PictureRequest {
  std::filesystem::path cell;  // a cell.json
  std::string arm;
  int index = 0;
  std::string scene;  // its hash, as in episodes.jsonl
  /// A goal mask is drawn of each: {"distribution", "instances": "all" or "first"}.
  std::vector<Json> selections{};
  /// The scene is drawn after each of these, all actions carried out from its beginning.
  struct End {
    std::string engine;
    std::vector<Action> actions{};  // Episode::actions()
  };
  std::vector<End> ends{};
};
Json to_json(const PictureRequest& request);
/// @throws InputError
PictureRequest read_picture_request(const JsonReader& reader);

/// lgabench-worker ask: what methods of a run will ask a server's model (LGABENCH_QUESTIONNAIRE), beforehand.
struct AskJob {
  std::string model;  // to_text() of an AskedModel
  LiveModel live;     // its max_queries are for each scenario
  std::vector<Json> scenarios;
  Limits limits{};
};
Json to_json(const AskJob& job);
/// @throws InputError
AskJob read_ask_job(const JsonReader& reader);

/// A phase of a worker that waits for another one's questions to be answered: no time of its own.
inline constexpr const char* in_line_phase = "wait for other cells' questions";
/// What `lgabench-worker ask` tells: questions that were answered, and, as a phase with a count of 0, what it waits
/// for.
inline constexpr const char* asked_phase = "ask";

/// What a worker does, and how far it is: a line of JSON on its descriptor 3.
struct PhaseCount {
  std::string phase;
  long long count = 0;
};
/// Why it gave up, in its own words: likewise.
struct Complaint {
  std::string reason;
  bool by_plugin = false;  // else the host is at fault
  int signal = 0;          // that ended the method's process
  bool refused = false;    // a plugin could not be loaded
};
/// Whose plugin's process it has waited for, for longer than a call should take; "": for none any more. Likewise.
struct Waiting {
  std::string whom;
};
Json to_json(const PhaseCount& message);
Json to_json(const Complaint& message);
Json to_json(const Waiting& message);
/// The message in the line; none where the line is something else: a plugin could write there too.
std::optional<PhaseCount> read_phase_count(const Json& line);
std::optional<Complaint> read_complaint(const Json& line);
std::optional<Waiting> read_waiting(const Json& line);

}  // namespace lgabench
