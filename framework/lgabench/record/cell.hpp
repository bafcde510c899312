// A cell: the unit of work, failure and resuming. It trains one policy and plays every arm of its scenario.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/reading.hpp>
#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/record/answer_source.hpp>
#include <lgabench/record/test_scenes.hpp>
#include <lgabench/record/train_on.hpp>

namespace lgabench {

/// The method that learns and acts with what another one selects.
struct ActingMethod {
  std::string id, version;
  Json options = Json::object();  // every option
};

/// A method, or a row of the table that a method is measured against.
struct Competitor {
  std::string kind = "method";  // or "reference": constant_action, random_object, oracle
  std::string id;
  std::string name;  // its row's: the id, and what tells it from other rows of that id (harness/competitors.hpp)
  std::string version;
  Json options = Json::object();       // every option, defaults included
  std::string asks{};                  // whom beside the language model: see LGABENCH_METHOD_ASKING
  std::optional<ActingMethod> acts{};  // another method, where this one selects alone

  bool is_reference() const { return kind == "reference"; }
  /// As a run of this row alone names it, and a command line writes it but for options.
  std::string own_name() const { return (acts ? "selected_by:" : "") + id; }
};

/// A person whose answers a cell is based on.
struct CellParticipant {
  std::string id, sha256;  // pseudonym; of the file
  bool rehearsal = false;  // no person's answers
};

/// All that a cell's results depend on, besides the programs themselves.
struct Cell {
  std::string suite, environment, layout, engine;
  std::shared_ptr<const Json> scenario = std::make_shared<const Json>();  // the file, whole; a plan's cells share it
  Competitor method;
  int demonstrations = 0;
  std::uint64_t training_seed = 0, scene_seed = 0;
  TestScenes test_scenes = TestScenes::shared;
  int episodes = 0;
  AnswerSource answers;
  std::optional<CellParticipant> participant;  // of a method that asks people, where there are any
  SelectionErrors selection_errors;            // made in what the method selects
  std::optional<TrainOn> train_on;             // what the method's demonstrations are perceived through
  Reading reading;                             // of what the method sees
  Json data;                                   // sha256 of the shipped data that the cell reads
  bool smoke = false;

  std::string scenario_id() const { return scenario->at("id"); }
  /// Whether its environment is a plugin's, not lgabench's own.
  bool has_plugin_environment() const;
  /// What the environment's file is called in a cell's "build".
  std::string environment_in_build() const;
  /// Whether an arm of its scenario has a perturbation.
  bool perturbs() const;
  /// Ids of the plugins' axes that its arms have.
  std::vector<std::string> plugin_axes() const;
  /// Whether its results depend on the perturbation axes.
  bool needs_axes() const { return train_on || perturbs(); }
  /// For people: "lga heart cells n=20 seed=0".
  std::string title() const;
  /// The training seed where the test scenes are its own.
  std::optional<std::uint64_t> scenes_of_seed() const;
};

Json to_json(const Cell& cell);
/// Without `test_scenes` they are shared. @throws InputError with `file` and place.
Cell read_cell(const Json& json, const std::string& file);

/// The cell that cell.json in `directory` describes. No link is followed.
/// @throws InputError if it is not there, or not a cell.
Cell recorded_cell(const std::filesystem::path& directory);
/// Wall-clock seconds that the cell in `directory` took, from its timing.json. No link is followed.
/// @throws InputError if the file is not there, or holds no such number.
double recorded_seconds(const std::filesystem::path& directory);

/// First 16 digits of the SHA-256 of the canonical JSON: names the cell's directory.
std::string key(const Cell& cell);

/// SHA-256 of what the data directory holds for this scenario: feature space, answers, sentence embeddings; where a
/// model is asked live the prompt too, and where names are read the reader's file.
Json data_hashes(const Scenario& scenario, const AnswerSource& answers, const Reading& reading);

}  // namespace lgabench
