#include <lgabench/harness/cell.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

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

}  // namespace

std::string Cell::title() const {
  return fmt::format("{} {} {} {} n={} seed={}", method.id, scenario_id(), layout, engine, demonstrations,
                     training_seed);
}

Json to_json(const Cell& cell) {
  return {{"suite", cell.suite},
          {"environment", cell.environment},
          {"layout", cell.layout},
          {"scenario", cell.scenario},
          {"engine", cell.engine},
          {"method",
           {{"kind", cell.method.kind},
            {"id", cell.method.id},
            {"version", cell.method.version},
            {"options", cell.method.options}}},
          {"demonstrations", cell.demonstrations},
          {"training_seed", cell.training_seed},
          {"scene_seed", cell.scene_seed},
          {"episodes", cell.episodes},
          {"answers", cell.answers},
          {"data", cell.data},
          {"smoke", cell.smoke}};
}

Cell read_cell(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  reader.only({"suite", "environment", "layout", "scenario", "engine", "method", "demonstrations", "training_seed",
               "scene_seed", "episodes", "answers", "data", "smoke"});
  const JsonReader method = reader.at("method");
  method.only({"kind", "id", "version", "options"});
  constexpr long long most = std::numeric_limits<int>::max();

  Cell cell;
  cell.suite = reader.at("suite").string();
  cell.environment = reader.at("environment").string();
  cell.layout = reader.at("layout").string();
  cell.scenario = reader.at("scenario").json();
  reader.at("scenario").at("id").string();
  cell.engine = reader.at("engine").string();
  cell.method = {method.at("kind").string(), method.at("id").string(), method.at("version").string(),
                 method.at("options").json()};
  if (cell.method.kind != "method" && cell.method.kind != "reference") method.at("kind").fail("method or reference");
  cell.demonstrations = static_cast<int>(reader.at("demonstrations").integer(0, most));
  cell.training_seed = seed_at(reader.at("training_seed"));
  cell.scene_seed = seed_at(reader.at("scene_seed"));
  cell.episodes = static_cast<int>(reader.at("episodes").integer(1, most));
  cell.answers = reader.at("answers").string();
  cell.data = reader.at("data").json();
  cell.smoke = reader.at("smoke").boolean();
  return cell;
}

std::string key(const Cell& cell) { return sha256(canonical(to_json(cell))).substr(0, 16); }

Json data_hashes(const Scenario& scenario) {
  const fs::path data = data_directory();
  return {{"feature_space", sha256_file(data / "spaces" / (scenario.space.id + ".json"))},
          {"answers", folder_hash(data / "answers")},
          {"embeddings", folder_hash(data / "embeddings")}};
}

std::vector<Cell> expand(const Suite& suite, const Grid& grid, const Variation& variation, const Catalogue& catalogue) {
  std::vector<Competitor> methods;
  for (const std::string& id : grid.methods) {
    const PluginInfo& info = catalogue.find("method", id);
    methods.push_back({"method", id, info.version, resolve_options(info, variation.options.value(id, Json::object()))});
  }
  for (const auto& item : variation.options.items())
    if (std::find(grid.methods.begin(), grid.methods.end(), item.key()) == grid.methods.end())
      throw InputError(
          fmt::format("--set {}: expected a method of this run: {}", item.key(), fmt::join(grid.methods, ", ")));
  for (const std::string& engine : grid.engines) catalogue.find("engine", engine);

  std::vector<Cell> cells;
  for (const std::string& id : grid.scenarios) {
    const Scenario scenario = load_scenario(id);
    if (scenario.environment != suite.environment)
      throw InputError(fmt::format("{}: /scenarios: \"{}\" is a scenario of {}, expected {}", suite.file, id,
                                   scenario.environment, suite.environment));
    Cell cell;
    cell.suite = suite.id;
    cell.environment = suite.environment;
    cell.scenario = scenario.json;
    cell.scene_seed = grid.scene_seed;
    cell.episodes = grid.episodes;
    cell.answers = variation.answers;
    cell.data = data_hashes(scenario);
    cell.smoke = grid.smoke;
    const auto add = [&](const Competitor& method, int demonstrations, std::uint64_t seed) {
      cell.method = method;
      cell.demonstrations = demonstrations;
      cell.training_seed = seed;
      cells.push_back(cell);
    };
    const auto reference = [](const char* row) { return Competitor{"reference", row, "1", Json::object()}; };
    for (const std::string& layout : grid.layouts) {
      for (const std::string& engine : grid.engines) {
        cell.layout = layout;
        cell.engine = engine;
        for (const int n : grid.demonstrations)
          for (const std::uint64_t seed : grid.seeds) {
            for (const Competitor& method : methods) add(method, n, seed);
            if (variation.references) add(reference("constant_action"), n, seed);
          }
        if (variation.references) {
          add(reference("random_object"), 0, 0);
          add(reference("oracle"), 0, 0);
        }
      }
    }
  }
  return cells;
}

}  // namespace lgabench
