#include <lgabench/report/results.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench::report {
namespace {

constexpr long long most = std::numeric_limits<int>::max();

// The lines of a .jsonl file, each parsed; blank ones are errors too, as nothing writes them.
std::vector<Json> read_lines(const fs::path& file) {
  const std::string text = read_file(file);
  std::vector<Json> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(Json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                text.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false));
    if (lines.back().is_discarded())
      throw InputError(fmt::format("{}: line {}: expected valid JSON", file.string(), lines.size()));
    begin = end + 1;
  }
  return lines;
}

void read_episodes(const fs::path& file, CellResult& cell) {
  std::map<std::string, std::map<long long, PlayedEpisode>> played;
  const std::vector<std::string> words = failure_words();
  int line = 0;
  for (const Json& json : read_lines(file)) {
    const JsonReader reader(json, fmt::format("{}: line {}", file.string(), ++line));
    const std::string arm = reader.at("arm").string();
    if (std::find(cell.arms.begin(), cell.arms.end(), arm) == cell.arms.end())
      reader.at("arm").fail(fmt::format("an arm of the scenario ({})", fmt::join(cell.arms, ", ")));
    PlayedEpisode e;
    e.command =
        static_cast<std::size_t>(reader.at("command").integer(0, static_cast<long long>(cell.commands.size()) - 1));
    e.scene = reader.at("scene").string();
    e.success = reader.at("success").boolean();
    e.failure = reader.at("failure").string();
    if (e.success != (e.failure == "none")) reader.at("failure").fail("\"none\" exactly on success");
    if (!e.success && std::find(words.begin(), words.end(), e.failure) == words.end())
      reader.at("failure").fail(fmt::format("none, {}", fmt::join(words, ", ")));
    if (const JsonReader blamed = reader.at("attribution"); !blamed.json().is_null()) {
      e.attribution = blamed.string();
      if (e.success || cell.is_reference() ||
          std::find(attributions.begin(), attributions.end(), e.attribution) == attributions.end())
        blamed.fail(fmt::format("{} on a method's failure, or null", fmt::join(attributions, ", ")));
    }
    if (const JsonReader action = reader.at("action"); !action.json().is_null())
      for (const JsonReader& number : action.elements()) e.action.push_back(number.number());
    if (reader.has("input_seen")) e.input_seen = reader.at("input_seen").boolean();
    const long long index = reader.at("index").integer(0, cell.episodes_per_arm - 1);
    if (!played[arm].emplace(index, std::move(e)).second)
      reader.at("index").fail(fmt::format("each index once in arm \"{}\"", arm));
  }
  for (const std::string& arm : cell.arms) {
    for (auto& item : played[arm]) cell.episodes[arm].push_back(std::move(item.second));
    if (cell.episodes[arm].size() != static_cast<std::size_t>(cell.episodes_per_arm))
      throw InputError(fmt::format("{}: line {}: expected {} episodes of arm \"{}\", got {}", file.string(), line,
                                   cell.episodes_per_arm, arm, cell.episodes[arm].size()));
  }
}

// What was selected for each of the cell's commands.
void read_selections(const fs::path& file, CellResult& cell) {
  const Json json = read_json(file);
  const JsonReader list = JsonReader(json, file.string()).at("commands");
  const auto commands = list.elements();
  if (commands.size() != cell.commands.size())
    list.fail(fmt::format("an entry for each of the scenario's {} commands", cell.commands.size()));
  for (std::size_t i = 0; i < commands.size(); ++i) {
    CommandResult& command = cell.commands[i];
    if (commands[i].at("utterance").string() != command.utterance)
      commands[i].at("utterance").fail(fmt::format("the scenario's command \"{}\"", command.utterance));
    command.selection = commands[i].at("selection").json();
    command.quality = commands[i].at("quality").json();
    if (!command.quality.is_null()) commands[i].at("quality").at("target");
  }
}

void read_configuration(const fs::path& file, CellResult& cell) {
  const Json json = read_json(file);
  const JsonReader reader(json, file.string());
  const JsonReader scenario = reader.at("scenario"), method = reader.at("method");
  cell.scenario = scenario.at("id").string();
  for (const JsonReader& command : scenario.at("commands").elements())
    cell.commands.push_back(
        {command.at("utterance").string(), !command.has("seen") || command.at("seen").boolean(), Json(), Json()});
  cell.demonstrated_commands = static_cast<int>(
      std::count_if(cell.commands.begin(), cell.commands.end(), [](const CommandResult& c) { return c.seen; }));
  for (const JsonReader& arm : scenario.at("tests").elements()) cell.arms.push_back(arm.at("arm").string());
  cell.layout = reader.at("layout").string();
  cell.engine = reader.at("engine").string();
  cell.method = method.at("name").string();
  cell.kind = method.at("kind").string();
  if (method.has("asks")) cell.asks = method.at("asks").string();
  cell.id = method.at("id").string();
  cell.options = method.at("options").json();
  if (!cell.options.is_object()) method.at("options").fail("an object");
  cell.demonstrations = static_cast<int>(reader.at("demonstrations").integer(0, most));
  cell.training_seed = reader.at("training_seed").integer(0, std::numeric_limits<long long>::max());
  if (reader.has("participant")) cell.participant = reader.at("participant").at("id").string();
  cell.episodes_per_arm = static_cast<int>(reader.at("episodes").integer(1, most));
}

}  // namespace

CellResult read_cell(const fs::path& directory) {
  CellResult cell;
  cell.key = directory.filename().string();
  const fs::path status_file = directory / "status.json";
  const Json status = read_json(status_file);
  const JsonReader reader(status, status_file.string());
  const std::string state = reader.at("state").string();
  if (state != "ok" && state != "failed") reader.at("state").fail("ok or failed");

  read_configuration(directory / "cell.json", cell);
  if (state == "failed") {
    cell.failed = true;
    cell.fault = reader.at("fault").string();
    cell.reason = reader.at("reason").string();
    cell.log_tail = reader.at("log_tail").strings();
    return cell;
  }
  read_selections(directory / "selection.json", cell);
  read_episodes(directory / "episodes.jsonl", cell);
  const fs::path timing_file = directory / "timing.json";
  cell.timing = read_json(timing_file);
  for (const char* phase : phases) JsonReader(cell.timing, timing_file.string()).at(phase).number();
  // Last, so that a torn file is reported with its line rather than as a wrong checksum.
  for (const auto& [name, sum] : reader.at("files").json().items())
    if (sum != sha256_file(directory / name))
      throw InputError(fmt::format("{}: differs from its checksum in status.json; resuming the run makes it anew",
                                   (directory / name).string()));
  return cell;
}

std::vector<std::string> failure_words() {
  std::vector<std::string> words;
  for (int f = static_cast<int>(Failure::none) + 1; f <= static_cast<int>(Failure::method_error); ++f)
    words.push_back(to_string(static_cast<Failure>(f)));
  return words;
}

RunResults read_run(const fs::path& run) {
  RunResults results;
  const fs::path run_file = run / "run.json";
  results.json = read_json(run_file);
  const JsonReader reader(results.json, run_file.string());
  results.suite = reader.at("suite").string();
  results.smoke = reader.at("smoke").boolean();
  if (!reader.at("machine").json().is_object()) reader.at("machine").fail("an object");
  const auto listed = reader.at("cells").strings();
  const std::set<std::string> asked(listed.begin(), listed.end());

  std::set<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(run / "cells", error)) {
    const std::string name = entry.path().filename().string();
    if (name.front() != '.' && entry.is_directory()) found.insert(name);
  }
  for (const std::string& key : found)
    if (asked.count(key) == 0) ++results.foreign;

  const bool divided = reader.at("version").string() == "0.1.0";
  std::map<std::string, std::size_t> order;  // of scenarios: the suite's, which run.json's cells keep
  for (const std::string& key : listed) {
    if (found.erase(key) == 0) {
      ++results.not_run;
      continue;
    }
    results.cells.push_back(read_cell(run / "cells" / key));
    if (divided) results.cells.back().demonstrated_commands = 1;
    order.emplace(results.cells.back().scenario, order.size());
  }
  const auto place = [&order](const CellResult& c) {
    return std::tuple(c.layout, c.engine, order.at(c.scenario), c.kind, c.method, c.demonstrations, c.training_seed,
                      c.participant);
  };
  std::sort(results.cells.begin(), results.cells.end(),
            [&place](const CellResult& a, const CellResult& b) { return place(a) < place(b); });
  const auto twice =
      std::adjacent_find(results.cells.begin(), results.cells.end(),
                         [&place](const CellResult& a, const CellResult& b) { return place(a) == place(b); });
  if (twice != results.cells.end())
    throw InputError(
        fmt::format("{}: /cells: {} and {} measure the same (scenario, layout, engine, method, "
                    "demonstrations, training seed, participant), expected one of them",
                    run_file.string(), twice->key, (twice + 1)->key));
  return results;
}

}  // namespace lgabench::report
