#include <lgabench/record/cell.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include <lgabench/abstraction/prompt.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

// SHA-256 over the names and contents of a folder's JSON files.
std::string folder_hash(const fs::path& folder) {
  std::error_code none_to_hash;
  std::string lines;
  for (const std::string& name : json_names(folder, none_to_hash))
    lines += fmt::format("{}.json {}\n", name, sha256_file(folder / (name + ".json")));
  return sha256(lines);
}

std::uint64_t seed_at(const JsonReader& reader) {
  return static_cast<std::uint64_t>(reader.integer(0, std::numeric_limits<std::int64_t>::max()));
}

}  // namespace

std::string Cell::title() const {
  return fmt::format("{} {} {} {} n={} seed={}{}", method.name, scenario_id(), layout, engine, demonstrations,
                     training_seed, participant ? " participant=" + participant->id : "");
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

Json to_json(const ActingMethod& acts) {
  return {{"id", acts.id}, {"version", acts.version}, {"options", acts.options}};
}

ActingMethod read_acting_method(const JsonReader& reader) {
  reader.only({"id", "version", "options"});
  ActingMethod acts{reader.at("id").string(), reader.at("version").string(), reader.at("options").json()};
  if (!acts.options.is_object()) reader.at("options").fail("an object");
  return acts;
}

Json to_json(const Cell& cell) {
  Json json{{"suite", cell.suite},
            {"environment", cell.environment},
            {"layout", cell.layout},
            {"scenario", *cell.scenario},
            {"engine", cell.engine},
            {"method",
             {{"kind", cell.method.kind},
              {"id", cell.method.id},
              {"name", cell.method.name},
              {"version", cell.method.version},
              {"options", cell.method.options}}},
            {"demonstrations", cell.demonstrations},
            {"training_seed", cell.training_seed},
            {"scene_seed", cell.scene_seed},
            {"test_scenes", cell.test_scenes},
            {"episodes", cell.episodes},
            {"answers", to_string(cell.answers)},
            {"data", cell.data},
            {"smoke", cell.smoke}};
  if (!cell.method.asks.empty()) json["method"]["asks"] = cell.method.asks;
  if (cell.method.acts) json["method"]["acts"] = to_json(*cell.method.acts);
  if (cell.participant) json["participant"] = {{"id", cell.participant->id}, {"sha256", cell.participant->sha256}};
  if (!cell.selection_errors.none()) json["selection_errors"] = to_json(cell.selection_errors);
  if (cell.train_on) json["train_on"] = to_json(*cell.train_on);
  if (cell.reading.names != Reading::simulator) json["names"] = cell.reading.names;
  if (cell.reading.segments != Reading::simulator) json["segments"] = cell.reading.segments;
  if (cell.participant && cell.participant->rehearsal) json["participant"]["rehearsal"] = true;
  return json;
}

Cell read_cell(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  reader.only({"suite", "environment", "layout", "scenario", "engine", "method", "demonstrations", "training_seed",
               "scene_seed", "test_scenes", "episodes", "answers", "participant", "selection_errors", "train_on",
               "names", "segments", "data", "smoke"});
  const JsonReader method = reader.at("method");
  method.only({"kind", "id", "name", "version", "options", "asks", "acts"});
  constexpr long long most = std::numeric_limits<int>::max();

  Cell cell;
  cell.suite = reader.at("suite").string();
  cell.environment = reader.at("environment").string();
  cell.layout = reader.at("layout").string();
  cell.scenario = std::make_shared<const Json>(reader.at("scenario").json());
  reader.at("scenario").at("id").string();
  cell.engine = reader.at("engine").string();
  cell.method = {method.at("kind").string(), method.at("id").string(), method.at("name").string(),
                 method.at("version").string(), method.at("options").json()};
  if (!cell.method.options.is_object()) method.at("options").fail("an object");
  if (method.has("asks")) cell.method.asks = method.at("asks").string();
  if (method.has("acts")) cell.method.acts = read_acting_method(method.at("acts"));
  if (cell.method.kind != "method" && cell.method.kind != "reference") method.at("kind").fail("method or reference");
  cell.demonstrations = static_cast<int>(reader.at("demonstrations").integer(0, most));
  cell.training_seed = seed_at(reader.at("training_seed"));
  cell.scene_seed = seed_at(reader.at("scene_seed"));
  if (reader.has("test_scenes")) cell.test_scenes = read_test_scenes(reader.at("test_scenes"));
  cell.episodes = static_cast<int>(reader.at("episodes").integer(1, most));
  cell.answers = read_answer_source(reader.at("answers").string());
  if (reader.has("participant")) {
    const JsonReader participant = reader.at("participant");
    participant.only({"id", "sha256", "rehearsal"});
    cell.participant = CellParticipant{participant.at("id").string(), participant.at("sha256").string(),
                                       participant.has("rehearsal") && participant.at("rehearsal").boolean()};
  }
  if (reader.has("selection_errors")) cell.selection_errors = read_selection_errors(reader.at("selection_errors"));
  if (reader.has("train_on")) cell.train_on = read_train_on(reader.at("train_on"));
  if (reader.has("names")) cell.reading.names = reader.at("names").string();
  if (reader.has("segments")) cell.reading.segments = read_segments(reader.at("segments"));
  cell.data = reader.at("data").json();
  cell.smoke = reader.at("smoke").boolean();
  return cell;
}

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
  Json hashes{{"feature_space", sha256_file(data / "spaces" / (scenario.space.id + ".json"))},
              {"answers", folder_hash(data / "answers")},
              {"embeddings", folder_hash(data / "embeddings")}};
  if (const fs::path own = data / scenario.environment; fs::is_directory(own)) hashes["environment"] = folder_hash(own);
  if (std::holds_alternative<LiveAnswers>(answers)) hashes["prompt"] = PromptTemplate().version();
  if (const fs::path file = reader_file(scenario.environment, reading); !file.empty())
    hashes["reader"] = sha256_file(file);
  return hashes;
}

}  // namespace lgabench
