#include <lgabench/harness/cell.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <set>

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

// Options of "ID+OPTION=VALUE+OPTION=VALUE". A '+' separates only before a letter, so that a value may be 1e+30.
Json own_options(const std::string& method) {
  Json options = Json::object();
  const auto next = [&method](std::size_t from) {
    const auto separates = [&](std::size_t i) {
      return method[i] == '+' && (i + 1 == method.size() || std::isalpha(static_cast<unsigned char>(method[i + 1])));
    };
    while (from < method.size() && !separates(from)) ++from;
    return from;
  };
  for (std::size_t at = std::min(method.find('+'), method.size()); at < method.size();) {
    const std::size_t end = next(at + 1), equals = method.find('=', at);
    const std::string option = method.substr(at + 1, std::min(equals, end) - at - 1);
    if (option.empty() || equals >= end || options.contains(option))
      throw InputError(fmt::format("method \"{}\": expected ID+OPTION=VALUE+..., each option once", method));
    options[option] = option_value(method.substr(equals + 1, end - equals - 1));
    at = end;
  }
  return options;
}

// The layer's values for the method: those of its id, then those of "*" for options that it has.
Json layer_for(const PluginInfo& info, const Json& layer) {
  const Json any = layer.value("*", Json::object());
  Json values = Json::object();
  for (const auto& [option, value] : any.items())
    if (info.options.contains(option)) values[option] = value;
  values.update(layer.value(info.id, Json::object()));
  return values;
}

// Throws for an option in "*" that no plugin has, and for a value that a method of the run does not take.
void check_layer(const Json& layer, const std::string& file, const std::string& place,
                 const std::vector<const PluginInfo*>& methods, const Catalogue& catalogue) {
  const Json any = layer.value("*", Json::object());
  std::set<std::string> known;
  for (const PluginInfo& plugin : catalogue.plugins)
    if (plugin.kind == "method")
      for (const auto& option : plugin.options.items()) known.insert(option.key());
  JsonReader(any, file, place + "/*").only({known.begin(), known.end()});
  for (const PluginInfo* info : methods) {
    const Json of_any = layer_for(*info, {{"*", any}}), own = layer.value(info->id, Json::object());
    check_options(*info, JsonReader(of_any, file, place + "/*"));
    check_options(*info, JsonReader(own, file, place + "/" + info->id));
  }
}

std::string named(const PluginInfo& info, const Json& options, const Json& usual, const std::set<std::string>& told) {
  std::string name = info.id;
  for (const std::string& option : told)
    if (const Json& value = options.at(option); value != usual.at(option))
      name += fmt::format("+{}={}", option, value.is_string() ? value.get<std::string>() : canonical(value));
  return name;
}

std::vector<Competitor> competitors(const Suite& suite, const Grid& grid, const Json& settings,
                                    const Catalogue& catalogue) {
  std::vector<const PluginInfo*> infos;
  std::vector<Competitor> methods;
  std::map<std::string, Json> usual;                  // id -> options of its row without options of its own
  std::map<std::string, std::set<std::string>> told;  // id -> options in which its rows differ
  for (const std::string& written : grid.methods)
    infos.push_back(&catalogue.find("method", written.substr(0, written.find('+'))));
  check_layer(grid.options, suite.file, grid.options_place, infos, catalogue);
  check_layer(settings, "--set", "", infos, catalogue);
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const PluginInfo& info = *infos[i];
    Json given = layer_for(info, grid.options);
    given.update(layer_for(info, settings));
    usual[info.id] = check_options(info, JsonReader(given, info.id));
    given.update(own_options(grid.methods[i]));
    methods.push_back({"method", info.id, info.id, info.version, resolve_options(info, given), info.asks});
    for (const Competitor& other : methods)
      if (other.id == info.id)
        for (const auto& [option, value] : other.options.items())
          if (value != methods.back().options.at(option)) told[info.id].insert(option);
  }
  for (std::size_t i = 0; i < infos.size(); ++i) {
    Competitor& method = methods[i];
    method.name = named(*infos[i], method.options, usual.at(method.id), told[method.id]);
    for (std::size_t before = 0; before < i; ++before)
      if (methods[before].name == method.name)
        throw InputError(fmt::format("methods: \"{}\" and \"{}\" are the same row, {}; expected each row once",
                                     grid.methods[before], grid.methods[i], method.name));
  }
  for (const auto& item : settings.items())
    if (item.key() != "*" && usual.count(item.key()) == 0)
      throw InputError(
          fmt::format("--set {}: expected a method of this run: {}", item.key(), fmt::join(grid.methods, ", ")));
  return methods;
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
