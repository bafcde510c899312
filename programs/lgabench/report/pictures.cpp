#include <lgabench/report/pictures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/selection.hpp>
#include <lgabench/job/job.hpp>
#include <lgabench/job/worker.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/record/shown.hpp>

namespace lgabench::report {
namespace {

struct Request {
  PictureRequest scene;
  std::vector<std::string> masks;   // mask_key of each of its selections
  std::vector<std::string> ends{};  // end_key of each of its ends
  std::string before{};             // end_key of the scene itself, where engines disagree about its end
  bool failed = false;              // a method in it
  bool of_levels = false;           // the first scene of a run with perturbations, in one of its arms
  std::string environment{};        // whose actions these are
};

// All that a goal mask depends on beside the scene.
Json what_is_kept(const CellResult& cell, const Json& selection) {
  const Json all = "all", chosen = cell.options.value("instances", all);
  return {{"distribution", distribution_of(selection)}, {"instances", chosen.is_string() ? chosen : all}};
}

// Whether the list lacked the scene's picture of that name, which it then has; not of "".
bool is_new_in(std::vector<std::string>& names, const std::string& scene, const std::string& name) {
  if (name.empty() || contains(names, scene + name)) return false;
  names.push_back(scene + name);
  return true;
}

// A request for each scene that a method played: one that shows each level of each perturbation, then those in which
// one failed, then by index, then as the cells are ordered.
std::vector<Request> requests_of(const fs::path& run, const RunResults& results) {
  std::map<std::string, std::size_t> place;  // of a scene's request
  std::vector<Request> all;
  for (const CellResult& cell : results.cells) {
    if (cell.failed || cell.is_reference()) continue;
    std::vector<std::string> masks;  // of each command, what follows the scene's hash in their names
    for (const CommandResult& command : cell.commands)
      masks.push_back(command.quality.empty() ? "" : mask_key("", cell, command.selection));
    for (const std::string& arm : cell.arms)
      for (std::size_t i = 0; i < cell.episodes.at(arm).size(); ++i) {
        const Episode& episode = cell.episodes.at(arm)[i];
        const auto [known, is_new] = place.emplace(episode.scene, all.size());
        if (is_new)
          all.push_back(
              {{run / "cells" / cell.key / cell_file::configuration, arm, static_cast<int>(i), episode.scene}, {}});
        all[known->second].environment = cell.environment;
        Request& request = all[known->second];
        request.of_levels = i == 0 && !cell.perturbations.empty() && cell.scenario == results.cells.front().scenario;
        request.failed = request.failed || !episode.success();
        const CommandResult& command = cell.commands[episode.command];
        if (is_new_in(request.masks, episode.scene, masks[episode.command]))
          request.scene.selections.push_back(what_is_kept(cell, command.selection));
      }
  }
  std::stable_sort(all.begin(), all.end(), [](const Request& a, const Request& b) {
    return std::tuple(!a.of_levels, !a.failed, a.scene.index) < std::tuple(!b.of_levels, !b.failed, b.scene.index);
  });
  return all;
}

// How the methods' episodes in these scenes ended, each row's in turn.
void add_ends(const RunResults& results, std::vector<Request>& requests) {
  std::map<std::string, Request*> request_of;  // by the scene's hash
  for (Request& request : requests) request_of[request.scene.scene] = &request;
  struct Candidate {
    int before, demonstrations;  // of its row and outcome
    const CellResult* cell;
    const std::string* arm;
    std::size_t index;
    const Episode& episode() const { return cell->episodes.at(*arm)[index]; }
  };
  std::vector<Candidate> all;
  std::map<std::tuple<std::string, std::string, std::string, std::string, int, std::string, bool>, int> so_far;
  for (const CellResult& cell : results.cells) {
    if (cell.failed || cell.is_reference()) continue;
    for (const std::string& arm : cell.arms)
      for (std::size_t i = 0; i < cell.episodes.at(arm).size(); ++i) {
        const Episode& episode = cell.episodes.at(arm)[i];
        if (episode.action.empty() || request_of.count(episode.scene) == 0) continue;
        int& before =
            so_far[{cell.layout, cell.engine, cell.scenario, cell.method, cell.demonstrations, arm, episode.success()}];
        all.push_back({before++, cell.demonstrations, &cell, &arm, i});
      }
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return std::tuple(a.before, -a.demonstrations) < std::tuple(b.before, -b.demonstrations);
  });
  if (all.size() > most_ends) all.resize(most_ends);
  for (const Candidate& c : all) {
    Request& request = *request_of.at(c.episode().scene);
    request.scene.ends.push_back({c.cell->engine, c.episode().actions()});
    request.ends.push_back(end_key(*c.cell, *c.arm, c.index, c.cell->engine));
  }
}

void add_disagreements(const fs::path& run, const std::vector<EngineAgreement>& agreements,
                       std::vector<Request>& requests) {
  std::size_t added = 0;
  for (const EngineAgreement& agreement : agreements)
    for (const Disagreement& d : agreement.disagreements) {
      if (added++ == most_disagreements) return;
      const auto key = [&d](const std::string& engine) { return end_key(*d.cell, d.arm, d.index, engine); };
      requests.push_back({{run / "cells" / d.cell->key / cell_file::configuration,
                           d.arm,
                           static_cast<int>(d.index),
                           d.episode().scene,
                           {},
                           {{agreement.first, d.episode().actions()}, {agreement.second, d.episode().actions()}}},
                          {},
                          {key(agreement.first), key(agreement.second)},
                          key("")});
    }
}

// What policies read of the scenes that are drawn. A picture that is there already, of another policy, is not kept
// twice; what would take more than most_read_bytes is left out.
void add_inputs(const fs::path& run, const RunResults& results, Pictures& pictures) {
  std::map<std::string, std::size_t> known;  // PNG -> its index in `seen`
  std::size_t bytes = 0;
  for (const CellResult& cell : results.cells) {
    if (cell.failed) continue;
    for (const ShownScene& shown : read_shown_scenes(run / "cells" / cell.key)) {
      const auto arm = cell.episodes.find(shown.arm);
      const auto index = static_cast<std::size_t>(shown.index);
      if (arm == cell.episodes.end() || index >= arm->second.size() ||
          pictures.scenes.count(arm->second[index].scene) == 0)
        continue;
      Pictures::Input input{{}, shown.texts, shown.unread};
      for (const auto& [caption, png] : shown.pictures) {
        const auto [at, is_new] = known.emplace(png, pictures.seen.size());
        if (is_new) {
          pictures.seen.push_back(png);
          bytes += png.size();
        }
        input.pictures.emplace_back(caption, at->second);
      }
      if (bytes > most_read_bytes) return;
      pictures.inputs[episode_key(cell, shown.arm, index)] = std::move(input);
    }
  }
}

}  // namespace

std::string mask_key(const std::string& scene, const CellResult& cell, const Json& selection) {
  return scene + "/" + sha256(canonical(what_is_kept(cell, selection))).substr(0, 8);
}

std::string episode_key(const CellResult& cell, const std::string& arm, std::size_t index) {
  return fmt::format("{}/{}/{}", cell.key, arm, index);
}

std::string end_key(const CellResult& cell, const std::string& arm, std::size_t index, const std::string& engine) {
  return episode_key(cell, arm, index) + "/" + engine;
}

Pictures draw_pictures(const fs::path& run, const RunResults& results, const std::vector<EngineAgreement>& agreements) {
  Pictures pictures;
  std::vector<Request> requests = requests_of(run, results);
  pictures.wanted = requests.size();
  if (requests.size() > most_pictures) requests.resize(most_pictures);
  add_ends(results, requests);
  add_disagreements(run, agreements, requests);
  if (requests.empty()) return pictures;

  Json asked = Json::array();
  for (const Request& request : requests) asked.push_back(to_json(request.scene));
  const WorkerAnswers answers = ask_worker("pictures", asked);
  pictures.problem = answers.problem;
  for (std::size_t k = 0; k < requests.size(); ++k) {
    const Request& request = requests[k];
    const Json& drawn = answers.lines[k];
    if (!drawn.is_object() || !drawn.contains("picture")) {
      if (pictures.problem.empty()) pictures.problem = drawn.is_object() ? drawn.value("problem", "") : "no answer";
      continue;
    }
    for (std::size_t i = 0; i < request.ends.size(); ++i)
      if (const Json& png = drawn.at("ends").at(i); !png.is_null()) pictures.ends[request.ends[i]] = png;
    if (!request.before.empty()) {
      pictures.ends[request.before] = drawn.at("picture");
      continue;
    }
    const std::string& scene = request.scene.scene;
    pictures.scenes[scene] = drawn.at("picture");
    pictures.targets[scene] = drawn.at("targets");
    if (const Json& perturbed = drawn.at("perturbed"); perturbed.is_array())
      pictures.perturbed[scene] = {perturbed.at(0), perturbed.at(1)};
    if (drawn.at("oracle").is_array()) pictures.oracle[scene] = {request.environment, drawn.at("oracle").get<Action>()};
    for (std::size_t i = 0; i < request.masks.size(); ++i) pictures.masks[request.masks[i]] = drawn.at("masks").at(i);
  }
  try {
    add_inputs(run, results, pictures);
  } catch (const InputError& e) {
    pictures.problem = e.what();
  }
  return pictures;
}

}  // namespace lgabench::report
