#include <lgabench/record/cell.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/abstraction/asked_model.hpp>
#include <lgabench/abstraction/prompt.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/read_space.hpp>
#include <lgabench/core/shipped.hpp>
#include <lgabench/record/fields.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

// SHA-256 over the names and contents of the JSON files in a folder of the data.
std::string folder_hash(const std::string& folder) {
  std::string lines;
  for (const std::string& name : shipped_names(folder))
    lines += fmt::format("{}.json {}\n", name, shipped_sha256(data_directory() / folder / (name + ".json")));
  return sha256(lines);
}

// Of the recorded answers that are read, or would be.
std::string folder_of_answers(const Scenario& scenario, const AnswerSource& answers) {
  const auto* recorded = std::get_if<RecordedAnswers>(&answers);
  const std::string source = recorded_source(scenario, recorded ? recorded->source : "recorded", false);
  return contains(shipped_answers(), source) ? (fs::path("answers") / source).parent_path().string() : "answers";
}

}  // namespace

std::string Cell::title() const {
  return fmt::format("{} {} {} {} n={} seed={}{}", method.name, scenario_id(), layout, engine, demonstrations,
                     training_seed, participant ? " participant=" + participant->id : "");
}

bool Cell::has_plugin_environment() const { return !contains(environment_ids(), environment); }

std::string Cell::environment_in_build() const {
  return has_plugin_environment() ? "environment " + environment : fmt::format("liblgabench_env_{}.so", environment);
}

bool Cell::perturbs() const {
  const auto tests = scenario->find("tests");
  return tests != scenario->end() &&
         std::any_of(tests->begin(), tests->end(), [](const Json& arm) { return arm.contains("perturbation"); });
}

std::vector<std::string> Cell::plugin_axes() const {
  std::vector<std::string> ids;
  if (const auto axes = scenario->find("axes"); axes != scenario->end() && axes->is_object())
    for (const auto& [id, ignored] : axes->items()) ids.push_back(id);
  return ids;
}

std::optional<std::uint64_t> Cell::scenes_of_seed() const {
  return test_scenes == TestScenes::per_seed ? std::optional(training_seed) : std::nullopt;
}

void visit(const Slot& slot, AnswerSource& source, const Form& form) {
  std::string word = to_string(source);
  visit(slot, word, form);
  if (slot.read) source = read_answer_source(word);
}

static void visit(const Slot& slot, std::shared_ptr<const Json>& any, const Form&) {
  if (slot.read) any = std::make_shared<const Json>(slot.read->json());
  if (slot.write) *slot.write = *any;
}

void fields(ActingMethod& acts, Fields& field) {
  field("id", acts.id);
  field("version", acts.version);
  field("options", acts.options, object());
}

static void fields(Competitor& method, Fields& field) {
  field("kind", method.kind, one_of(competitor_kinds));
  field("id", method.id);
  field("name", method.name);
  field("version", method.version);
  field("options", method.options, object());
  field("asks", method.asks, when(!method.asks.empty()));
  field("acts", method.acts, when(method.acts.has_value()));
}

static void fields(CellParticipant& participant, Fields& field) {
  field("id", participant.id);
  field("sha256", participant.sha256);
  field("rehearsal", participant.rehearsal, when(participant.rehearsal));
}

// A cell's key is a hash of these bytes: what is new is written only where it is set.
void fields(Cell& cell, Fields& field) {
  field("suite", cell.suite);
  field("environment", cell.environment);
  field("layout", cell.layout);
  field("scenario", cell.scenario);
  if (field.reading()) field.reading()->at("scenario").at("id").string();
  field("engine", cell.engine);
  field("method", cell.method);
  field("demonstrations", cell.demonstrations);
  field("training_seed", cell.training_seed);
  field("scene_seed", cell.scene_seed);
  field("test_scenes", cell.test_scenes, may_lack());
  field("episodes", cell.episodes, at_least(1));
  field("answers", cell.answers);
  field("participant", cell.participant, when(cell.participant.has_value()));
  field("selection_errors", cell.selection_errors, when(!cell.selection_errors.none()));
  field("train_on", cell.train_on, when(cell.train_on.has_value()));
  field("names", cell.reading.names, when(cell.reading.names != Reading::simulator));
  field("segments", cell.reading.segments, segments_form(cell.reading));
  field("data", cell.data);
  field("smoke", cell.smoke);
}

Json to_json(const Cell& cell) { return json_of(cell); }

Cell read_cell(const Json& json, const std::string& file) { return value_of<Cell>(JsonReader(json, file)); }

Cell recorded_cell(const fs::path& directory) {
  const fs::path file = directory / cell_file::configuration;
  return read_cell(read_json(file, Links::refused), file.string());
}

double recorded_seconds(const fs::path& directory) {
  const fs::path file = directory / cell_file::timing;
  const Json timing = read_json(file, Links::refused);
  return JsonReader(timing, file.string()).at("total_s").number();
}

std::string key(const Cell& cell) { return sha256(canonical(to_json(cell))).substr(0, 16); }

Json data_hashes(const Scenario& scenario, const AnswerSource& answers, const Reading& reading) {
  const fs::path data = data_directory();
  Json hashes{{"feature_space", shipped_sha256(feature_space_file(scenario.space.id))},
              {"answers", folder_hash(folder_of_answers(scenario, answers))},
              {"embeddings", folder_hash("embeddings")}};
  const std::string& environment = scenario.environment->id();
  if (fs::is_directory(data / environment)) hashes["environment"] = folder_hash(environment);
  if (const auto* live = std::get_if<LiveAnswers>(&answers)) {
    const std::string given = read_asked_model(live->model).prompt;
    hashes["prompt"] = given.empty() ? PromptTemplate().version() : given;
  }
  if (const fs::path file = reader_file(environment, reading); !file.empty()) hashes["reader"] = shipped_sha256(file);
  return hashes;
}

}  // namespace lgabench
