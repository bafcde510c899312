#include <lgabench/statistics/results.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <tuple>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/meaning.hpp>
#include <lgabench/core/parallel.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/record/cell_status.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/record/perturbed.hpp>

namespace lgabench::statistics {
namespace {

// A name or a message as tables, pages and terminals may show it: it comes from a plugin, or from somebody else's run.
std::string shown(const JsonReader& text) { return one_line(text.string()); }

// The failures of the tasks of one of lgabench's own environments, beside those that all runs know.
std::set<std::string> further_words(const std::string& environment) {
  std::set<std::string> words;
  for (const TaskInfo& task : find_environment(environment).tasks()) {
    if (task.most_steps > 1) words.insert(failure::goes_on);
    words.insert(task.failures.begin(), task.failures.end());
  }
  return words;
}

bool is_word(const std::string& text) {
  const auto in_word = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !text.empty() && text.size() <= 40 && std::all_of(text.begin(), text.end(), in_word);
}

void read_episodes(const fs::path& file, CellResult& cell) {
  std::map<std::string, std::map<int, Episode>> played;
  const bool any_word = cell.configuration.has_plugin_environment();  // which may not be there to ask
  std::vector<std::string> words;
  if (!any_word) words = failure_words(further_words(cell.environment));
  int line = 0;
  for (const Json& json : parse_json_lines(read_file(file, Links::refused), file.string())) {
    const JsonReader reader(json, fmt::format("{}: line {}", file.string(), ++line));
    Episode e = read_episode(reader);
    e.arm = one_line(e.arm);
    if (!contains(cell.arms, e.arm))
      reader.at("arm").fail(fmt::format("an arm of the scenario ({})", fmt::join(cell.arms, ", ")));
    reader.at("command").integer(0, static_cast<long long>(cell.commands.size()) - 1);
    if (e.told) reader.at("told").integer(0, static_cast<long long>(cell.commands.size()) - 1);
    reader.at("index").integer(0, cell.episodes_per_arm - 1);
    if (any_word && !e.success() && !is_word(e.failure)) reader.at("failure").fail("a word");
    if (!any_word && !e.success() && !contains(words, e.failure))
      reader.at("failure").fail(fmt::format("none, {}", fmt::join(words, ", ")));
    if (!e.attribution.empty() && cell.is_reference()) reader.at("attribution").fail("null for a reference row");
    if (!played[e.arm].emplace(e.index, e).second)
      reader.at("index").fail(fmt::format("each index once in arm \"{}\"", e.arm));
  }
  for (const std::string& arm : cell.arms) {
    for (auto& item : played[arm]) cell.episodes[arm].push_back(std::move(item.second));
    if (cell.episodes[arm].size() != static_cast<std::size_t>(cell.episodes_per_arm))
      throw InputError(fmt::format("{}: line {}: expected {} episodes of arm \"{}\", got {}", file.string(), line,
                                   cell.episodes_per_arm, arm, cell.episodes[arm].size()));
  }
}

void read_perturbed(const fs::path& file, CellResult& cell) {
  constexpr auto input = static_cast<std::size_t>(EpisodePart::input);
  std::map<int, std::string> control;  // by index
  int line = 0;
  for (const Json& json : parse_json_lines(read_file(file, Links::refused), file.string())) {
    const JsonReader reader(json, fmt::format("{}: line {}", file.string(), ++line));
    const PerturbedEpisode episode = read_perturbed_episode(reader);
    if (one_line(episode.arm) == cell.arms.front()) control[episode.index] = episode.hashes[input];
    const auto same = control.find(episode.index);
    if (cell.perturbations.count(one_line(episode.arm)) == 0 || same == control.end()) continue;
    UnchangedInputs& inputs = cell.inputs[one_line(episode.arm)];
    ++inputs.of;
    inputs.unchanged += same->second == episode.hashes[input];
  }
}

void read_training(const fs::path& file, CellResult& cell) {
  int line = 0;
  for (const Json& json : parse_json_lines(read_file(file, Links::refused), file.string())) {
    const JsonReader reader(json, fmt::format("{}: line {}", file.string(), ++line));
    expect_training_line(reader);
    const auto epoch = json.at("epoch").get<long long>();
    for (const auto& item : json.items())
      if (item.key() != "epoch" && item.key() != "steps")
        cell.training[one_line(item.key())][epoch] = item.value().get<double>();
  }
}

void expect_selection(const JsonReader& selection) {
  if (const JsonReader target = selection.at("target"); target.has("turns") || target.has("sets"))
    read_unchecked_meaning(target);
  else
    target.at("object_types");
  for (const char* text : {"provenance", "source", "asked_as"}) selection.at(text).string();
  constexpr double most = 1e15;  // of which a run may have many in a sum
  for (const char* number : {"lm_queries", "lm_tokens", "lm_seconds", "human_seconds"})
    if (const JsonReader cost = selection.at("cost").at(number); !(cost.number() >= 0 && cost.number() <= most))
      cost.fail(fmt::format("a number from 0 to {:g}", most));
}

// What was selected for each of the cell's commands.
void read_selections(const fs::path& file, CellResult& cell) {
  const Json json = read_json(file, Links::refused);
  const JsonReader list = JsonReader(json, file.string()).at("commands");
  const auto commands = list.elements();
  if (commands.size() != cell.commands.size())
    list.fail(fmt::format("an entry for each of the scenario's {} commands", cell.commands.size()));
  for (std::size_t i = 0; i < commands.size(); ++i) {
    CommandResult& command = cell.commands[i];
    if (shown(commands[i].at("utterance")) != command.utterance)
      commands[i].at("utterance").fail(fmt::format("the scenario's command \"{}\"", command.utterance));
    expect_selection(commands[i].at("selection"));
    command.selection = commands[i].at("selection").json();
    command.quality = read_quality(commands[i].at("quality"));
  }
}

// Of an axis that need not be installed.
Perturbation perturbation_of(const JsonReader& reader) {
  if (!reader.json().is_object() || reader.json().size() != 1) reader.fail("an object with one axis and its level");
  const std::string axis = reader.json().begin().key();
  return {one_line(axis), static_cast<int>(reader.at(axis).integer(1, std::numeric_limits<int>::max()))};
}

// The arms that give the command.
void note_ambiguous(const JsonReader& scenario, const JsonReader& command, CellResult& result) {
  if (!command.has("wording")) {
    result.ambiguous.insert(shown(command.at("arm")));
    return;
  }
  for (const JsonReader& arm : scenario.at("tests").elements())
    for (const char* axis : {"paraphrase", all_axes})
      if (arm.has("perturbation") && arm.at("perturbation").json() == Json{{axis, command.at("wording").json()}})
        result.ambiguous.insert(shown(arm.at("arm")));
}

void read_configuration(const fs::path& directory, CellResult& result) {
  const lgabench::Cell& cell = result.configuration = recorded_cell(directory);
  const JsonReader scenario(*cell.scenario, (directory / cell_file::configuration).string(), "/scenario");
  result.scenario = shown(scenario.at("id"));
  if (scenario.has("feature_space")) result.space = shown(scenario.at("feature_space"));
  for (const JsonReader& command : scenario.at("commands").elements()) {
    result.commands.push_back({shown(command.at("utterance")),
                               !command.has("seen") || command.at("seen").boolean(),
                               command.has("truth") ? command.at("truth").json() : Json::object(),
                               Json(),
                               {},
                               command.has("ambiguous") && command.at("ambiguous").boolean()});
    if (result.commands.back().ambiguous) note_ambiguous(scenario, command, result);
    if (!result.commands.back().truth.is_object()) command.at("truth").fail("an object");
  }
  result.demonstrated_commands = static_cast<int>(
      std::count_if(result.commands.begin(), result.commands.end(), [](const CommandResult& c) { return c.seen; }));
  const auto played = scenario.has("played") ? std::optional(scenario.at("played").strings()) : std::nullopt;
  for (const JsonReader& arm : scenario.at("tests").elements()) {
    if (played && std::count(played->begin(), played->end(), arm.at("arm").string()) == 0) continue;
    result.arms.push_back(shown(arm.at("arm")));
    if (arm.has("perturbation")) result.perturbations[result.arms.back()] = perturbation_of(arm.at("perturbation"));
  }
  result.environment = one_line(cell.environment);
  result.layout = one_line(cell.layout);
  result.engine = one_line(cell.engine);
  result.method = one_line(cell.method.name);
  result.kind = cell.method.kind;
  result.asks = cell.method.asks;
  result.id = cell.method.id;
  result.options = cell.method.options;
  result.demonstrations = cell.demonstrations;
  result.training_seed = static_cast<long long>(cell.training_seed);
  if (cell.participant) result.participant = one_line(cell.participant->id);
  result.rehearsal = cell.participant && cell.participant->rehearsal;
  result.episodes_per_arm = cell.episodes;
}

}  // namespace

const std::vector<std::string>& phases() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> members;
    for (const std::string& phase : cell_phases) members.push_back(phase + "_s");
    members.emplace_back("total_s");
    return members;
  }();
  return all;
}

std::vector<std::string> CellResult::arms_in_means() const {
  std::vector<std::string> some;
  std::copy_if(arms.begin(), arms.end(), std::back_inserter(some),
               [this](const std::string& arm) { return ambiguous.count(arm) == 0; });
  return some;
}

CellResult read_cell(const fs::path& directory) {
  CellResult cell;
  cell.key = directory.filename().string();
  expect_plain_entries(directory);
  const CellStatus status = read_cell_status(directory);
  read_configuration(directory, cell);
  if (status.failed) {
    cell.failed = true;
    cell.fault = status.fault;
    cell.reason = one_line(status.reason);
    for (const std::string& line : status.log_tail) cell.log_tail.push_back(one_line(line));
    return cell;
  }
  cell.method_error = one_line(status.method_error);
  read_selections(directory / cell_file::selections, cell);
  read_training(directory / cell_file::training, cell);
  read_episodes(directory / cell_file::episodes, cell);
  if (!cell.perturbations.empty()) read_perturbed(directory / cell_file::perturbed, cell);
  const fs::path timing_file = directory / cell_file::timing;
  cell.timing = read_json(timing_file, Links::refused);
  if (cell.timing.is_object()) cell.timing.emplace("load_s", 0.0);  // a part of select_s in runs of 0.3.0 and earlier
  for (const std::string& phase : phases()) JsonReader(cell.timing, timing_file.string()).at(phase).number();
  // Last, so that a torn file is reported with its line rather than as a wrong checksum.
  if (const fs::path changed = changed_file(directory, status); !changed.empty())
    throw InputError(fmt::format("{}: differs from its checksum in status.json; --resume computes the cell again",
                                 changed.string()));
  return cell;
}

namespace {

// A cell as one that failed, since it cannot be read; none where nobody can say of which row it is.
std::optional<CellResult> failed_cell(const fs::path& directory, const std::string& why) {
  CellResult cell;
  cell.key = directory.filename().string();
  try {
    read_configuration(directory, cell);
  } catch (const InputError&) {
    return {};
  }
  cell.failed = true;
  cell.fault = "host";
  const std::string where = one_line(directory.string()) + "/";
  cell.reason = "cannot be read: " + (why.rfind(where, 0) == 0 ? why.substr(where.size()) : why);
  return cell;
}

}  // namespace

RunResults read_run(const fs::path& run) {
  RunResults results;
  results.directory = run;
  results.record = read_run_record(run);
  results.suite = one_line(results.record.suite);
  const std::vector<std::string>& listed = results.record.cells;
  expect_plain_run(run);
  const std::set<std::string> asked(listed.begin(), listed.end());

  std::set<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(run / "cells", error)) {
    const std::string name = entry.path().filename().string();
    if (name.front() != '.' && entry.is_directory()) found.insert(name);
  }
  for (const std::string& key : found)
    if (asked.count(key) == 0) ++results.foreign;

  std::map<std::string, std::size_t> order;  // of scenarios: the suite's, which run.json's cells keep
  std::vector<std::string> played;
  for (const std::string& key : listed)
    if (found.erase(key) == 0)
      ++results.not_run;
    else
      played.push_back(key);
  std::vector<std::optional<CellResult>> cells(played.size());
  std::vector<std::string> refused(played.size());
  std::mutex mutex;
  // One copy of each scenario, which has more bytes than all else that a report keeps of a cell.
  std::vector<std::shared_ptr<const Json>> scenarios;
  const auto share = [&](std::shared_ptr<const Json>& scenario) {
    const std::lock_guard lock(mutex);
    const auto same =
        std::find_if(scenarios.begin(), scenarios.end(), [&](const auto& one) { return *one == *scenario; });
    scenario = same == scenarios.end() ? scenarios.emplace_back(scenario) : *same;
  };
  in_parallel(played.size(), [&](std::size_t i) {
    const fs::path directory = run / "cells" / played[i];
    try {
      cells[i] = read_cell(directory);
    } catch (const InputError& e) {
      refused[i] = one_line(e.what());
      cells[i] = failed_cell(directory, refused[i]);
    }
    if (cells[i]) share(cells[i]->configuration.scenario);
  });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i]) results.cells.push_back(std::move(*cells[i]));
    if (!refused[i].empty()) results.unreadable.push_back(std::move(refused[i]));
  }
  for (CellResult& cell : results.cells) {
    if (cell.rehearsal) results.rehearsal = true;
    order.emplace(cell.scenario, order.size());
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
                    record_file(run).string(), twice->key, (twice + 1)->key));
  return results;
}

}  // namespace lgabench::statistics
