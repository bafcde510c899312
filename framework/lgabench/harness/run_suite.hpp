// A run: cells in, a directory of finished cells out.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/harness/answers.hpp>
#include <lgabench/harness/expand.hpp>
#include <lgabench/harness/forecast.hpp>
#include <lgabench/harness/run_directory.hpp>
#include <lgabench/harness/schedule.hpp>
#include <lgabench/harness/worker_pool.hpp>

namespace lgabench {

/// Whether a method that did not come with the installation is told the truth, which finding causes of failures needs.
enum class Strangers {
  told_nothing,     // on the leaderboard, and where cells are checked; cells are then played in an order that is drawn
  told_afterwards,  // not by run_suite(), but by who calls it, once the run's last cell is scored (cli/causes.hpp)
  told_in_cells     // at the end of each
};

struct RunPlan {
  std::vector<Cell> cells;    // of the whole run
  Shard shard;                // the part of them that is played here
  Json request;               // the settings that led to the cells, for run.json
  std::string command;        // as typed
  std::string program{};      // as --version says, for run.json
  std::filesystem::path out;  // the run directory
  std::filesystem::path cache;
  std::vector<AnswerFile> answers{};  // that the cells name
  std::optional<LiveModel> live{};    // that the cells ask
  Json live_about{};                  // {"model", "provider", "prompt"}: who that is, for run.json
  Json about = nullptr;               // of the user's own suite, for run.json; null: none
  Json claims = nullptr;              // the suite's own, for run.json; null: none
  Existing existing = Existing::same;
  PoolOptions pool;
  bool confined = true;         // methods' processes, see host/confine.hpp
  bool keeps_policies = false;  // of cells that are computed
  bool quiet = false;           // stderr has what went wrong, and nothing of how far it is
  Strangers strangers = Strangers::told_nothing;
  std::string purpose{};  // what is computed, where it is no run: begins the forecast's line
  Costs costs{};          // learnt beforehand
};

struct FailedCell {
  std::string title, reason;
  std::filesystem::path log;
};

/// How the computed cells spent their time.
struct TimeSpent {
  std::map<std::string, double> phase_s;  // as in timing.json, without total_s
  double workers_s = 0;                   // from start to end of each worker, added up
  double wall_s = 0;
  /// "learn 80 %, ...; 2 workers busy 97 % of 63.1 s"
  std::string text(int jobs) const;
};

struct RunOutcome {
  std::size_t computed = 0, reused = 0;
  std::size_t elsewhere = 0;  // cells of other shards that the directory lacks
  std::vector<FailedCell> failed;
  TimeSpent time;
  bool plugin_refused = false;  // a worker could not load a plugin
  bool interrupted = false;     // by a signal; all that was finished is kept
};

/// The first 8 digits of a hash of the cells and of what computes them: names a run's default directory, so that
/// another configuration or build never meets its results.
std::string run_hash(const std::vector<Cell>& cells, const Catalogue& catalogue);

/// Whether what acts in the cell is a method that did not come with the installation, told by its bytes.
bool is_strangers(const Cell& cell, const Catalogue& catalogue);

/// Whether a plugin that is not lgabench's own plays, perturbs, perceives, learns or selects in the cell: nobody has
/// measured what it takes.
bool takes_unknown_time(const Cell& cell, const Catalogue& catalogue);
/// Whether nothing but the installation's own arithmetic computes the cell: no plugin that came from elsewhere, and no
/// LibTorch, whose kernels are chosen by the processor. Such a cell has the same bits on every processor with fused
/// multiply-add, owe_same_bits(). @throws as Catalogue::find().
bool has_own_arithmetic(const Cell& cell, const Catalogue& catalogue);

/// What lgabench-worker is told of a cell. `answers` holds the plan's (keep_answers), `scratch` is empty.
CellJob cell_job(const RunPlan& plan, const Catalogue& catalogue, const Cell& cell,
                 const std::filesystem::path& directory, const std::filesystem::path& answers,
                 const std::filesystem::path& scratch);

/// Computes those of the shard's cells that the directory lacks, long ones first. A cell that fails is recorded as
/// failed and costs no other; it is tried again by the next run in this directory. Progress goes to stderr.
/// @throws InputError, with nothing overwritten, if the directory cannot be used; PluginError for a missing plugin.
RunOutcome run_suite(const RunPlan& plan, const Catalogue& catalogue);

/// What run_suite() would have to do. Reads the run directory, if it is there, and changes nothing.
Forecast forecast(const RunPlan& plan, const Catalogue& catalogue);

}  // namespace lgabench
