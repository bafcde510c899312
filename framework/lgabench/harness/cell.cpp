#include <lgabench/harness/cell.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include <lgabench/abstraction/prompt.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>

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

// Those whose answers the method is based on in this scenario; one that is nobody where it asks no people, or where the
// truth stands in for them.
using Answering = std::vector<std::optional<CellParticipant>>;
Answering participants(const Competitor& method, const Scenario& scenario, const std::vector<Participant>& all) {
  if (all.empty() || (method.asks != "specify" && method.asks != "edit")) return {std::nullopt};
  const auto how = method.asks == "specify" ? &Participant::Answer::specified : &Participant::Answer::edited;
  Answering some;
  for (const Participant& one : all)
    if (one.answered_all(scenario, how)) some.push_back(CellParticipant{one.id, one.sha256});
  return some;
}

// A method that people answer for shall not vanish from the table because they were asked about other scenarios.
void expect_each_method(const std::vector<Competitor>& methods, const std::vector<Cell>& cells) {
  for (const Competitor& method : methods)
    if (std::none_of(cells.begin(), cells.end(), [&](const Cell& c) { return c.method.name == method.name; }))
      throw InputError(
          fmt::format("--humans: expected answers for {} in a scenario of this run, there are none", method.name));
}

// The suite's own arms come after the scenario's.
Scenario with_arms(const Scenario& scenario, const Suite& suite) {
  Json json = scenario.json;
  const Json first = json["tests"].front();
  for (const Json& arm : suite.arms) {
    json["tests"].push_back(first);
    json["tests"].back().update(arm);
  }
  return read_scenario(json, fmt::format("{}: scenario {} with /arms", suite.file, scenario.id));
}

}  // namespace

std::string Cell::title() const {
  return fmt::format("{} {} {} {} n={} seed={}{}", method.name, scenario_id(), layout, engine, demonstrations,
                     training_seed, participant ? " participant=" + participant->id : "");
}

std::optional<std::uint64_t> Cell::scenes_of_seed() const {
  return test_scenes == "per_seed" ? std::optional(training_seed) : std::nullopt;
}

Json to_json(const Cell& cell) {
  Json json{{"suite", cell.suite},
            {"environment", cell.environment},
            {"layout", cell.layout},
            {"scenario", cell.scenario},
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
            {"answers", cell.answers},
            {"data", cell.data},
            {"smoke", cell.smoke}};
  if (!cell.method.asks.empty()) json["method"]["asks"] = cell.method.asks;
  if (cell.participant) json["participant"] = {{"id", cell.participant->id}, {"sha256", cell.participant->sha256}};
  return json;
}

Cell read_cell(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  reader.only({"suite", "environment", "layout", "scenario", "engine", "method", "demonstrations", "training_seed",
               "scene_seed", "test_scenes", "episodes", "answers", "participant", "data", "smoke"});
  const JsonReader method = reader.at("method");
  method.only({"kind", "id", "name", "version", "options", "asks"});
  constexpr long long most = std::numeric_limits<int>::max();

  Cell cell;
  cell.suite = reader.at("suite").string();
  cell.environment = reader.at("environment").string();
  cell.layout = reader.at("layout").string();
  cell.scenario = reader.at("scenario").json();
  reader.at("scenario").at("id").string();
  cell.engine = reader.at("engine").string();
  cell.method = {method.at("kind").string(), method.at("id").string(), method.at("name").string(),
                 method.at("version").string(), method.at("options").json()};
  if (method.has("asks")) cell.method.asks = method.at("asks").string();
  if (cell.method.kind != "method" && cell.method.kind != "reference") method.at("kind").fail("method or reference");
  cell.demonstrations = static_cast<int>(reader.at("demonstrations").integer(0, most));
  cell.training_seed = seed_at(reader.at("training_seed"));
  cell.scene_seed = seed_at(reader.at("scene_seed"));
  if (reader.has("test_scenes")) cell.test_scenes = reader.at("test_scenes").string();
  if (cell.test_scenes != "shared" && cell.test_scenes != "per_seed")
    reader.at("test_scenes").fail("shared or per_seed");
  cell.episodes = static_cast<int>(reader.at("episodes").integer(1, most));
  cell.answers = reader.at("answers").string();
  if (reader.has("participant")) {
    const JsonReader participant = reader.at("participant");
    participant.only({"id", "sha256"});
    cell.participant = CellParticipant{participant.at("id").string(), participant.at("sha256").string()};
  }
  cell.data = reader.at("data").json();
  cell.smoke = reader.at("smoke").boolean();
  return cell;
}

std::string key(const Cell& cell) { return sha256(canonical(to_json(cell))).substr(0, 16); }

Json data_hashes(const Scenario& scenario, const std::string& answers) {
  const fs::path data = data_directory();
  Json hashes{{"feature_space", sha256_file(data / "spaces" / (scenario.space.id + ".json"))},
              {"answers", folder_hash(data / "answers")},
              {"embeddings", folder_hash(data / "embeddings")}};
  if (is_live(answers)) hashes["prompt"] = PromptTemplate().version();
  return hashes;
}

bool is_live(const std::string& answers) { return answers.rfind(live_prefix, 0) == 0; }

std::vector<Cell> expand(const Suite& suite, const Grid& grid, const Variation& variation, const Catalogue& catalogue) {
  const std::vector<Competitor> methods = competitors(suite, grid, variation.options, catalogue);
  for (const std::string& engine : grid.engines) catalogue.find("engine", engine);

  std::vector<Cell> cells;
  for (const std::string& id : grid.scenarios) {
    const Scenario scenario = with_arms(load_scenario(id, variation.truth), suite);
    if (scenario.environment != suite.environment)
      throw InputError(fmt::format("{}: /scenarios: \"{}\" is a scenario of {}, expected {}", suite.file, id,
                                   scenario.environment, suite.environment));
    Cell cell;
    cell.suite = suite.id;
    cell.environment = suite.environment;
    cell.scenario = scenario.json;
    cell.scene_seed = grid.scene_seed;
    cell.test_scenes = grid.test_scenes;
    cell.episodes = grid.episodes;
    cell.answers = variation.answers;
    cell.data = data_hashes(scenario, cell.answers);
    cell.smoke = grid.smoke;
    const auto add = [&](const Competitor& method, int demonstrations, std::uint64_t seed) {
      cell.method = method;
      cell.demonstrations = demonstrations;
      cell.training_seed = seed;
      for (const auto& participant : participants(method, scenario, variation.participants)) {
        cell.participant = participant;
        cells.push_back(cell);
      }
    };
    // One that learns nothing plays each set of test scenes once.
    const std::vector<std::uint64_t> scene_sets = cell.scenes_of_seed() ? grid.seeds : std::vector<std::uint64_t>{0};
    const auto reference = [](const char* row) { return Competitor{"reference", row, row, "1", Json::object()}; };
    for (const std::string& layout : grid.layouts) {
      for (const std::string& engine : grid.engines) {
        cell.layout = layout;
        cell.engine = engine;
        for (const int n : grid.demonstrations)
          for (const std::uint64_t seed : grid.seeds) {
            for (const Competitor& method : methods) add(method, n, seed);
            if (variation.references) add(reference("constant_action"), n, seed);
          }
        if (variation.references)
          for (const char* row : {"random_object", "oracle"})
            for (const std::uint64_t seed : scene_sets) add(reference(row), 0, seed);
      }
    }
  }
  expect_each_method(methods, cells);
  return cells;
}

}  // namespace lgabench
