// The rows that tables and figures are made of.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/statistics/curves.hpp>
#include <lgabench/statistics/paired.hpp>
#include <lgabench/statistics/paper.hpp>
#include <lgabench/statistics/regret.hpp>
#include <lgabench/statistics/results.hpp>
#include <lgabench/statistics/statistics.hpp>
#include <lgabench/statistics/steps.hpp>

namespace lgabench::statistics {

constexpr const char* mean_scenario = "(mean)";

/// What an arm changed: its success minus that of the first arm, whose scenes and commands are paired with the arm's.
struct Shift {
  std::string against;  // the first arm
  double difference = 0;
  Interval interval;          // 95 %
  bool same_actions = false;  // every policy acted in every scene exactly as in its pair
  double p = 1;               // two-sided, that the difference is 0
  int lost = 0, gained = 0;   // episodes that failed, or succeeded, in this arm alone
  /// Where the arm says the same in other words: the share of episodes for whose words something else was selected than
  /// for the first arm's, as a mean like success. None for a method that selects nothing.
  std::optional<double> selected_otherwise;
  std::string against_title{};  // what readers are shown of the first arm
};

/// What a row's cells selected for one command. Words: the different ones, joined by "; "; numbers: means over cells.
struct PhiOfCommand {
  std::string utterance;
  bool seen = true;  // trained on; the others are tested only
  std::string provenance, source, asked_as;
  std::optional<double> lm_queries, human_seconds;
  Quality quality;
  bool erring = false;  // errors were made in it on purpose
};
Json to_json(const PhiOfCommand& phi);
/// null where nothing was selected.
Json to_json(const std::vector<PhiOfCommand>& phi);
/// What was selected for each command that the arm gives, where a cell selected. @pre `cells` differ in seed or
/// participant
std::vector<PhiOfCommand> phi_of(const std::vector<const CellResult*>& cells, const std::string& arm);

/// What a method did in one arm at one number of demonstrations, in one scenario or on the mean over all of them.
struct Row {
  std::size_t index = 0;  // among summary.json's rows
  std::string scenario, layout, engine, arm, method, kind;
  std::optional<Perturbation> perturbation;  // of its arm
  SelectionErrors errors;                    // that were made in what it selected
  int demonstrations = 0;
  int seeds = 0, scenes = 0, episodes = 0, successes = 0;  // scenes: distinct ones
  int participants = 0;           // whose answers the row is based on; 0 where nobody was asked
  std::optional<double> success;  // mean over scenarios of the mean over training seeds (participants, where there are
                                  // several); none without episodes
  Interval interval;              // 95 %; docs/formats says which
  std::map<std::string, int> failures;
  std::map<std::string, int> attribution{{"abstraction", 0}, {"policy", 0}};  // failures attributed to each
  std::optional<Shift> shift;            // none in the first arm, nor where the arms give different commands
  int inputs_told = 0, inputs_seen = 0;  // episodes whose policy told whether its input stood in training; where it did
  std::optional<PairedSuccess>
      paired{};                    // where the arm's scenes are pairs; none in a scenario with one of the commands
  std::optional<Course> course{};  // where commands say how objects are used
  int n_error = 0;                 // episodes not played: the engine or the host failed
  std::vector<std::string> marks;
  std::vector<PhiOfCommand> phi;  // of each of the arm's commands for which a cell selected; none in mean rows

  bool is_reference() const { return kind == "reference"; }
  bool is_mean() const { return scenario == mean_scenario; }
  bool marked(const std::string& mark) const;
  /// `method` without what its end says of errors.
  std::string without_errors() const;
  std::optional<double> seen_share() const {
    return inputs_told > 0 ? std::optional(static_cast<double>(inputs_seen) / inputs_told) : std::nullopt;
  }
  int attributed_to(const std::string& what) const {
    const auto found = attribution.find(what);
    return found == attribution.end() ? 0 : found->second;
  }
  int attributed() const {
    int all = 0;
    for (const auto& [what, n] : attribution) all += n;
    return all;
  }
};

/// Rows of one (layout, engine), in the order of tables: arms as the scenarios list them; scenarios, the mean last;
/// methods, reference rows last; demonstrations ascending.
struct Table {
  std::string layout, engine;
  std::vector<std::string> arms;
  std::map<std::string, std::string> arm_titles;  // what readers are shown of them
  int demonstrated_commands = 1;  // of each scenario, each with as many demonstrations; 0 where scenarios differ
  std::vector<Row> rows;
  std::optional<Nearness> nearness;  // to the paper's curves; none unless the rows of all three methods are there

  std::vector<std::string> scenarios() const;  // in order, the mean last
  std::vector<int> demonstrations() const;     // those of the methods, or of all where there is none
  /// "50 demonstrations", or where several commands were demonstrated "demonstrations: 50 per command, 100 in all".
  std::string demonstrations_text(int n) const;
  /// The table without rows in which errors were made, where it has the same row without any.
  Table without_errors() const;
  /// The row, nullptr where there is none. A reference row that learns nothing (demonstrations 0) stands in every
  /// number of demonstrations.
  const Row* find(const std::string& arm, const std::string& scenario, const std::string& method,
                  int demonstrations) const;
  /// Ids of a scenario's methods, or of its reference rows, in order.
  std::vector<std::string> methods(const std::string& scenario) const { return ids(scenario, "method"); }
  std::vector<std::string> references(const std::string& scenario) const { return ids(scenario, "reference"); }
  /// Scenarios that have the arm and whose words in it are not ambiguous; a mean in an arm is over these.
  std::vector<std::string> scenarios_with(const std::string& arm) const;
  /// "mean over 3 scenarios" for the mean, else the scenario's own id.
  std::string title(const std::string& scenario) const;
  /// Whether the arm's scenes are perturbed ones of the first arm.
  bool perturbs(const std::string& arm) const;
  /// What readers are shown of the arm: the id where there is nothing else.
  std::string arm_title(const std::string& arm) const;
  /// arm_title() at the head of a column: "similar object (1 of 3)" for an arm of one of three scenarios.
  std::string arm_head(const std::string& arm) const;
  /// "layout cells, engine mujoco"
  std::string title() const;

 private:
  std::vector<std::string> ids(const std::string& scenario, const std::string& kind) const;
};

struct Summary {
  std::string suite;
  std::vector<Table> tables;
  std::vector<ErrorCurve> error_curves;
  std::vector<PerturbationCurve> perturbations;  // by table, method, demonstrations, axis
  std::vector<Regret> regrets;                   // of a suite of persons
  std::vector<Steps> steps;                      // pixels, labels, language, truth
  std::vector<CellResult> failed;                // cells
};

/// Appends the string where the list does not hold it yet.
void append_unique(std::vector<std::string>& all, const std::string& one);

/// Aggregates the cells. Deterministic: the bootstrap's random stream is named after the row.
Summary summarize(const RunResults& run);

/// summary.json (docs/formats).
Json to_json(const Summary& summary);

}  // namespace lgabench::statistics
