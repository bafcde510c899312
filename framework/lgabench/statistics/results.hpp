// A run as it lies on disk (docs/formats), read and checked into values.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <lgabench/abstraction/quality.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/record/cell.hpp>
#include <lgabench/record/episode.hpp>
#include <lgabench/record/run_record.hpp>

namespace lgabench::statistics {

/// Members of timing.json: of cell_phases in their order, then "total_s".
const std::vector<std::string>& phases();

/// A command of the cell's scenario, and what the method selected for it.
struct CommandResult {
  std::string utterance;
  bool seen = true;        // trained on; the others are tested only
  Json truth;              // as the scenario says: an object
  Json selection;          // as in selection.json
  Quality quality;         // of the Selection; empty for a method that selects nothing
  bool ambiguous = false;  // as the scenario says
};

/// How many of a perturbed arm's played episodes (`of`) had the control's input as the policy's whole input.
struct UnchangedInputs {
  int unchanged = 0, of = 0;
};

/// One cell's outcome. A cell that failed keeps its configuration and its reason, and has no episodes.
struct CellResult {
  lgabench::Cell configuration;                             // whole; below, its texts in one line
  std::string key, scenario, layout, engine, method, kind;  // method: its row's name; kind: method or reference
  std::string environment;                                  // whose scenario it is; may be one that is not installed
  std::string space;                                        // the scenario's feature space
  std::string id;                                           // of the plugin, or of the reference row
  Json options = Json::object();                            // of the method, all of them
  int demonstrations = 0, episodes_per_arm = 0;
  long long training_seed = 0;
  std::string participant;  // whose answers it is based on; empty where nobody was asked
  bool rehearsal = false;   // that was no person
  std::string asks;         // whom its method asks beside the language model, as cell.json says; else empty
  std::vector<std::string> arms;
  std::set<std::string> ambiguous;                    // arms that give an ambiguous command: shown, in no mean
  std::map<std::string, Perturbation> perturbations;  // of the arms that have one; their control is the first arm
  std::map<std::string, UnchangedInputs> inputs;      // of these, as perturbed.jsonl says
  std::vector<CommandResult> commands;
  int demonstrated_commands = 1;  // each had `demonstrations`
  bool failed = false;
  std::string fault, reason;          // where it failed; fault: plugin or host, which it is too where it cannot be read
  std::vector<std::string> log_tail;  // what a failed cell's worker printed last
  std::string method_error;           // what the first episode of that failure threw
  std::map<std::string, std::vector<Episode>> episodes;  // of each arm, by index
  // Curves of training.jsonl: "loss", or a name of the method's own -> its values along the epochs.
  std::map<std::string, std::map<long long, double>> training;
  Json timing;  // as in timing.json

  bool is_reference() const { return kind == "reference"; }
  /// The arms that are not ambiguous.
  std::vector<std::string> arms_in_means() const;
};

struct RunResults {
  fs::path directory;  // as it was named
  RunRecord record;
  std::string suite;  // the record's, in one line
  std::vector<CellResult>
      cells;               // by layout, engine, scenario (run.json's order), method, demonstrations, seed, participant
  bool rehearsal = false;  // a cell is based on answers of a rehearsal, not people's
  int not_run = 0;         // asked for by run.json, not there
  std::vector<std::string> unreadable;  // why, of each cell that cannot be read; where cell.json can, it failed
  int foreign = 0;                      // there, not asked for by run.json: ignored
};

/// What stands wherever answers of a rehearsal decide a number.
constexpr const char* rehearsal_words = "rehearsal, not people";

/// Reads a cell's directory. @throws InputError naming file and line or place for a file that is missing, malformed, or
/// not what status.json's checksums say.
CellResult read_cell(const fs::path& directory);

/// Reads the cells that run.json asks for. Hidden directories (a worker's unfinished work) are no cells. A cell that
/// read_cell() refuses counts as failed: what it holds may be a method's doing, and takes nothing from other rows.
/// @throws InputError naming file and place for a run.json that is missing or malformed, and for two cells that measure
/// the same.
RunResults read_run(const fs::path& run);

}  // namespace lgabench::statistics
