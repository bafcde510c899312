// run.json: what was asked for, and what computed it (docs/formats/README.md). Read and written here alone.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/record/processor.hpp>

namespace lgabench {

/// A run's record. Texts are empty, and JSON is an empty object, where an older version did not say.
struct RunRecord {
  struct Plugin {
    std::string kind, id, version, sha256;
    std::string asks{};  // as in the plugin's descriptor
  };
  /// One part of a run that several machines compute.
  struct Shard {
    int index = 1, count = 1;  // 1 <= index <= count
    std::size_t cells = 0;     // of this part

    bool operator!=(const Shard& other) const { return !(*this == other); }
    bool operator==(const Shard& other) const {
      return index == other.index && count == other.count && cells == other.cells;
    }
  };

  std::string suite, preset;
  bool smoke = false;              // a smoke or limited run: not for the leaderboard
  std::vector<std::string> cells;  // keys of all parts' cells, in the suite's order
  std::string version, program;    // of lgabench: its number; what --version says
  std::string command, started;    // started: UTC, "2026-01-01T00:00:00Z"
  std::string confinement;         // of the methods' processes
  std::vector<Plugin> plugins;
  Json build = Json::object();     // program or library -> SHA-256
  Json request = Json::object();   // the settings that led to the cells
  Json settings = Json::object();  // row -> options beside the plugin's defaults
  Json machine = Json::object();   // with what read_processor() reads
  Json answers = Json::array();    // the files of answers/, and whose they are
  Json about = nullptr;            // of the user's own suite, what its file said of it (about_suite.hpp); null: none
  Json claims = nullptr;           // of the suite, as its file said when the run began (suite_claims.hpp); null: none
  std::optional<Shard> shard;      // none: the whole run, or more than one part of it
  Json merged = nullptr;           // of a merged run: command, machine and start of each part

  Processor processor() const;
  /// The processors of all parts of a merged run, each once; else processor() alone.
  std::vector<Processor> processors() const;
  /// The SHA-256 of each program that the record names, and of each plugin by its kind and id: "method lga".
  Json programs() const;
};

/// run.json of the run in that directory.
std::filesystem::path record_file(const std::filesystem::path& run);
/// Whether that directory holds a run.
bool is_run(const std::filesystem::path& directory);

/// The record of the run in that directory. No link is followed.
/// @throws InputError naming file and place for what is missing or malformed, and for a run of 0.1 or 0.2.
RunRecord read_run_record(const std::filesystem::path& run);
/// The record in JSON that was read from `file`. @throws as read_run_record(run).
RunRecord read_run_record(const Json& json, const std::string& file);

Json to_json(const RunRecord& record);
/// Writes the record of the run in that directory, atomically.
void write_run_record(const std::filesystem::path& run, const RunRecord& record);

/// `confinement` of a run in which methods were let out of it, for good: whatever cells of it are computed later.
constexpr const char* unconfined_run = "none, by --unconfined";

/// Whether two versions of lgabench compute the same cells: they differ in their last number alone, or are 0.4 and 0.5.
bool same_cells(const std::string& version, const std::string& other);

/// Which setting of two runs differs first; data and versions may differ where no setting does.
std::string difference(const RunRecord& there, const RunRecord& wanted);

}  // namespace lgabench
