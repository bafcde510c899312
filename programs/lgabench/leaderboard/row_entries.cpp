#include <lgabench/leaderboard/row_entries.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/harness/answers.hpp>
#include <lgabench/harness/run_directory.hpp>
#include <lgabench/leaderboard/answer_score.hpp>
#include <lgabench/leaderboard/played_cell.hpp>

namespace lgabench::leaderboard {
namespace {

using statistics::CellResult;
using statistics::RunResults;

using Row = std::map<Place, const CellResult*>;
using Rows = std::map<std::pair<std::string, std::string>, Row>;  // by the row's name and the engine

// Reasons, those that hold for many cells counted.
class Reasons {
 public:
  void add(const std::string& reason) { lines_.push_back(reason); }
  void of_cell(const std::string& reason, const std::string& title) {
    auto& [count, first] = cells_[reason];
    if (count++ == 0) first = title;
  }
  std::vector<std::string> lines() const {
    std::vector<std::string> all = lines_;
    for (const auto& [reason, cells] : cells_)
      all.push_back(fmt::format("{}: {}{}", reason, cells.second,
                                cells.first > 1 ? fmt::format(" and {} more cells", cells.first - 1) : ""));
    return all;
  }

 private:
  std::vector<std::string> lines_;
  std::map<std::string, std::pair<int, std::string>> cells_;
};

Rows rows_of(const RunResults& run, const std::vector<std::string>& wanted) {
  Rows rows;
  std::set<std::string> names;
  for (const CellResult& result : run.cells) {
    names.insert(result.method);
    if (!wanted.empty() && !contains(wanted, result.method)) continue;
    const Place place{result.scenario, result.layout, result.demonstrations, result.configuration.training_seed};
    rows[{result.method, result.engine}][place] = &result;
  }
  for (const std::string& name : wanted)
    if (names.count(name) == 0)
      throw InputError(
          fmt::format("{}: no row {}, the run has: {}", run.directory.string(), name, fmt::join(names, ", ")));
  return rows;
}

// How much of a row's preset is there, and the first places that are not.
void add_missing(const std::string& row, const std::vector<std::string>& places, std::size_t of, Reasons& reasons) {
  constexpr std::size_t most = 10;
  if (places.empty()) return;
  reasons.add(fmt::format("{}: {} of the preset's {} cells are there", row, of - places.size(), of));
  for (std::size_t i = 0; i < std::min(most, places.size()); ++i)
    reasons.add(fmt::format("missing: {} {}", row, places[i]));
  if (places.size() > most) reasons.add(fmt::format("missing: {}, {} more cells", row, places.size() - most));
}

// What of a cell's settings is not the board's, the first of them; "" where all is.
std::string other_setting(const Json& cell, const Json& expected) {
  for (const auto& [member, value] : expected.items()) {
    const Json there = cell.value(member, Json());
    if (there == value) continue;
    if (member == "scenario") return "the scenario is not as the board's preset has it";
    if (member == "data") return "computed with other data than this installation's";
    return fmt::format("{} is {}, the board's preset has {}", member, canonical(there), canonical(value));
  }
  if (cell.contains("selection_errors")) return "errors were made in what was selected (selection_errors)";
  for (const auto& [member, ignored] : Conditions().values())
    if (cell.contains(member) && !expected.contains(member))
      return fmt::format("{} is {}, unlike in other cells of the row", member, canonical(cell.at(member)));
  if (cell.contains("train_on")) return "demonstrations were seen through a perturbation (train_on)";
  return cell.contains("participant") ? "based on a person's answers, for which the board has no place" : "";
}

// SHA-256 of what a cell's answers are: of the cassette, or of the files that it names.
std::string answers_hash(const fs::path& run, const Installed& installed, const Cell& cell, Reasons& reasons) {
  if (std::holds_alternative<LiveAnswers>(cell.answers)) {
    const std::optional<AnswerFile> replies = kept_replies(run);
    if (!replies) {
      reasons.add(to_string(cell.answers) + ": a live model's answers without their cassette (answers/ of the run)");
      return "";
    }
    return sha256_file(replies->path);
  }
  if (const auto* cassette = std::get_if<CassetteAnswers>(&cell.answers)) {
    if (!fs::exists(run / "answers" / (cassette->file + ".jsonl")))
      reasons.add(to_string(cell.answers) + ": the cassette is not in answers/ of the run");
    return cassette->file;
  }
  if (const auto* written = std::get_if<FileAnswers>(&cell.answers)) {
    if (!fs::exists(run / "answers" / (written->file + ".json")))
      reasons.add(to_string(cell.answers) + ": the file is not in answers/ of the run");
    return written->file;
  }
  std::set<std::string> lines;
  if (const auto* recorded = std::get_if<RecordedAnswers>(&cell.answers))
    for (const Setting::Scenario& s : installed.setting.scenarios) {
      const Scenario scenario = suite_scenario(installed.suite, s.id, Truth::released, &installed.design);
      const std::string source = recorded_source(scenario, recorded->source, cell.method.asks == "edit");
      lines.insert(source + " " + sha256_file(data_directory() / "answers" / (source + ".json")));
    }
  return sha256(fmt::format("{}", fmt::join(lines, "\n")));
}

std::string version_of(const RunResults& run, const std::string& kind, const std::string& id) {
  for (const RunRecord::Plugin& plugin : run.record.plugins)
    if (plugin.kind == kind && plugin.id == id) return plugin.version;
  throw InputError(fmt::format("{}: no {} {} in its /plugins", record_file(run.directory).string(), kind, id));
}

// A run's command without the program's directory, which is nobody else's business.
std::string published(const std::string& command) {
  const bool quoted = command.rfind('\'', 0) == 0;
  const std::size_t slash = command.rfind('/', command.find(quoted ? "' " : " "));
  return slash == std::string::npos ? command : (quoted ? "'" : "") + command.substr(slash + 1);
}

Json evidence_of(const RunResults& run, const Suite& suite, const Identity& identity, const Json& data,
                 const Json& about) {
  Json plugins = Json::array();
  const RunRecord& record = run.record;
  const auto& acts = identity.row.acts;
  const auto player = player_of(identity.engine, suite);
  for (const RunRecord::Plugin& plugin : record.plugins)
    if (std::pair(plugin.kind, plugin.id) == player ||
        (plugin.kind == "method" && (plugin.id == identity.row.id || (acts && plugin.id == acts->id))))
      plugins.push_back(
          {{"kind", plugin.kind}, {"id", plugin.id}, {"version", plugin.version}, {"sha256", plugin.sha256}});
  return {{"by", about.at("by")},
          {"program", record.program.empty() ? "lgabench " + record.version : record.program},
          {"version", record.version},
          {"build", record.build},
          {"plugins", plugins},
          {"machine", record.machine},
          {"confinement", record.confinement.empty() ? "unknown" : record.confinement},
          {"started", record.started},
          {"command", published(record.command)},
          {"data", data}};
}

// Whether a failure has a cause, which is found by telling the method the truth.
bool is_attributed(const CellResult& result) {
  const auto has_cause = [](const Episode& e) { return !e.attribution.empty(); };
  return std::any_of(result.episodes.begin(), result.episodes.end(),
                     [&](const auto& arm) { return std::any_of(arm.second.begin(), arm.second.end(), has_cause); });
}

// A record's plugin goes by id and version, since another build's bytes differ: beside the installation's plugin none
// of that id is ever loaded.
bool is_shipped_version(const std::string& id, const std::string& version, const Catalogue& shipped) {
  return std::any_of(shipped.plugins.begin(), shipped.plugins.end(), [&](const PluginInfo& one) {
    return one.kind == "method" && one.id == id && one.version == version;
  });
}

std::set<std::string> failures_of(const Row& row) {
  std::set<std::string> found;
  for (const auto& cell : row)
    for (const auto& arm : cell.second->episodes)
      for (const Episode& episode : arm.second)
        if (!episode.success()) found.insert(episode.failure);
  return found;
}

Entry entry_of(const RunResults& run, const Installed& installed, const Catalogue& shipped, const Row& row,
               const Json& about, Reasons& reasons) {
  const Cell& first = row.begin()->second->configuration;
  Entry entry;
  entry.setting = installed.setting;
  entry.about = about;
  entry.failures = failure_words(failures_of(row));
  entry.identity.row = first.method;
  entry.identity.row.name = first.method.own_name();
  entry.identity.answers = first.answers;
  entry.identity.answers_sha256 = answers_hash(run.directory, installed, first, reasons);
  entry.identity.engine = first.engine;
  const auto [kind, player] = player_of(first.engine, installed.suite);
  entry.identity.engine_version = version_of(run, kind, player);
  const Conditions conditions = entry.identity.conditions = Conditions::of(first);
  if (const std::string refusal = conditions.refusal(); !refusal.empty())
    reasons.add(first.method.name + ": " + refusal);
  entry.identity.preset_sha256 = hash(installed.setting);
  entry.identity.scene_seed = installed.setting.scene_seed;
  const bool may_be_told = first.method.is_reference() ||
                           is_shipped_version(first.method.id, version_of(run, "method", first.method.id), shipped);
  Json data = Json::object();
  const std::vector<Cell> cells = cells_of_row(installed, first.method, first.engine, first.answers, conditions);
  std::vector<std::string> missing;
  for (const Cell& cell : cells) {
    const Place place{cell.scenario_id(), cell.layout, cell.demonstrations, cell.training_seed};
    const auto found = row.find(place);
    if (found == row.end()) {
      missing.push_back(place.text());
      continue;
    }
    Json expected = to_json(cell);
    expected["method"]["name"] = first.method.name;
    const CellResult& result = *found->second;
    const std::string title = result.configuration.title();
    if (const std::string reason = other_setting(to_json(result.configuration), expected); !reason.empty()) {
      reasons.of_cell(reason, title);
    } else if (result.failed && result.fault != "plugin") {
      reasons.add(fmt::format("failed by the {}, not by the method: {}: {}", result.fault, title, result.reason));
    } else if (!may_be_told && is_attributed(result)) {
      reasons.of_cell("failures have causes, for which the method was told the truth: add a run without causes", title);
    } else {
      entry.cells.push_back(played_cell(result, run.directory / "cells" / result.key, key(cell), entry));
      data.update(cell.data);
    }
  }
  add_missing(first.method.name, missing, cells.size(), reasons);
  const auto played = [](const PlayedCell& cell) { return cell.failed.empty(); };
  if (entry.cells.size() == cells.size() && conditions.none() &&  // they change no answer
      std::all_of(entry.cells.begin(), entry.cells.end(), played)) {
    const fs::path kept = answers_file(entry.identity).filename();
    const fs::path file = kept.empty() ? kept : run.directory / "answers" / kept;
    if (file.empty() || fs::exists(file))  // else there is a reason already
      entry.score = score_of_answers(installed, entry.identity.row, entry.identity.answers, file);
  }
  entry.evidence.push_back(evidence_of(run, installed.suite, entry.identity, data, about));
  return entry;
}

void expect_run_of_the_board(const RunResults& run, Reasons& reasons) {
  if (run.record.smoke) reasons.add("a smoke or limited run (run.json: smoke)");
  if (run.record.confinement.rfind("none", 0) == 0) reasons.add("methods were not confined (--unconfined)");
  if (run.not_run > 0)
    reasons.add(fmt::format("{} cell{} of the run not played yet", run.not_run, run.not_run == 1 ? "" : "s"));
  std::set<std::string> axes;
  for (const CellResult& cell : run.cells)
    for (const std::string& id : cell.configuration.plugin_axes()) axes.insert(id);
  if (!axes.empty())
    reasons.add(fmt::format("arms under an axis of a plugin ({}), which no leaderboard ranks", fmt::join(axes, ", ")));
  for (const CellResult& cell : run.cells)
    if (!cell.participant.empty()) {
      reasons.add("answers of people (--humans), for which the board has no place");
      break;
    }
}

}  // namespace

RowEntries row_entries(const fs::path& directory, const Json& about, const std::vector<std::string>& wanted) {
  RowEntries all;
  Reasons reasons;
  RunResults run;
  try {
    run = statistics::read_run(directory);
    all.refused = run.unreadable;  // an edited file, among others
  } catch (const InputError& e) {
    all.refused.emplace_back(e.what());
  }
  if (!all.refused.empty()) return all;
  expect_run_of_the_board(run, reasons);
  std::optional<Installed> installed;
  try {
    installed = installed_setting(run.suite, run.record.preset);
  } catch (const InputError& e) {
    reasons.add(e.what());
    all.refused = reasons.lines();
    return all;
  }
  const Rows rows = rows_of(run, wanted);
  if (rows.empty()) reasons.add("no cell has been played");
  const Catalogue shipped = scan_plugins({shipped_plugin_directory()});
  for (const auto& item : rows) {
    const std::size_t before = reasons.lines().size();
    Entry entry = entry_of(run, *installed, shipped, item.second, about, reasons);
    if (reasons.lines().size() == before) all.entries.push_back(std::move(entry));
  }
  all.refused = reasons.lines();
  return all;
}

}  // namespace lgabench::leaderboard
