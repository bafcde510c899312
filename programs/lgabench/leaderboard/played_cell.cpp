#include <lgabench/leaderboard/played_cell.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/hash.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench::leaderboard {
namespace {

using statistics::CellResult;

// The Selections of a cell's commands; null for a method that selects nothing.
Json selections_of(const CellResult& result) {
  Json all = Json::array();
  bool selects = false;
  for (const statistics::CommandResult& command : result.commands) {
    if (command.ambiguous) continue;
    selects = selects || !command.quality.empty();
    all.push_back(
        {{"utterance", command.utterance}, {"selection", command.selection}, {"quality", to_json(command.quality)}});
  }
  return selects ? all : Json();
}

}  // namespace

PlayedCell played_cell(const CellResult& result, const fs::path& directory, const std::string& key, Entry& entry) {
  if (entry.failures.size() > most_failure_words)
    throw InputError(
        fmt::format("{} words for failures, of all environments that are installed: a board has letters for {}",
                    entry.failures.size(), most_failure_words));
  PlayedCell cell;
  cell.place = {result.scenario, result.layout, result.demonstrations,
                static_cast<std::uint64_t>(result.training_seed)};
  cell.key = key;
  if (result.failed) {
    cell.failed = result.reason;
    for (const std::string& arm : result.arms_in_means())
      cell.outcomes[arm] = std::string(static_cast<std::size_t>(result.episodes_per_arm), failed_cell_letter);
    return cell;
  }
  std::string scenes, results;
  for (const std::string& arm : result.arms_in_means()) {
    std::string& letters = cell.outcomes[arm];
    for (const Episode& e : result.episodes.at(arm)) {
      scenes += e.scene;
      letters += entry_letter(e, entry.failures);
    }
  }
  for (const char* file : result_files) results += sha256_file(directory / file);
  cell.scenes = sha256(scenes);
  cell.digest = sha256(results);
  if (const Json phi = selections_of(result); !phi.is_null()) {
    Json& known = entry.phi[result.scenario];
    const auto same = std::find(known.begin(), known.end(), phi);
    cell.phi = static_cast<std::size_t>(same - known.begin());
    if (same == known.end()) known.push_back(phi);
  }
  for (const statistics::CommandResult& command : result.commands) {
    const Json& cost = command.selection.at("cost");
    cell.lm_queries += cost.at("lm_queries").get<double>();
    cell.lm_tokens += cost.at("lm_tokens").get<double>();
    cell.human_seconds += cost.at("human_seconds").get<double>();
  }
  // Milliseconds: more digits would be noise, and not every writer of JSON ends such a number in the same digit.
  const auto seconds = [&result](const char* of) {
    return std::round(result.timing.at(of).get<double>() * 1000) / 1000;
  };
  cell.learn_s = seconds("learn_s");
  cell.total_s = seconds("total_s");
  const fs::path training = directory / cell_file::training;
  const std::vector<Json> epochs = parse_json_lines(read_file(training, Links::refused), training.string());
  if (!epochs.empty()) cell.steps = JsonReader(epochs.back(), training.string()).at("steps").integer(0, INT64_MAX);
  return cell;
}

}  // namespace lgabench::leaderboard
