#include <lgabench/report/pictures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/selection.hpp>
#include <lgabench/job/job.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/settings.hpp>
#include <lgabench/report/worker.hpp>

namespace lgabench::report {
namespace {

struct Request {
  PictureRequest scene;
  std::vector<std::string> masks;     // mask_key of each of its selections
  std::vector<std::string> ends{};    // end_key of each of its ends
  std::string before{};               // end_key of the scene itself, where engines disagree about its end
  bool failed = false;                // a method in it
  std::string environment{};          // whose actions these are
  std::vector<std::string> inputs{};  // input_key of each of its inputs
};

// All that a goal mask depends on beside the scene.
Json what_is_kept(const CellResult& cell, const Json& selection) {
  const Json all = "all", chosen = cell.options.value("instances", all);
  return {{"distribution", distribution_of(selection)}, {"instances", chosen.is_string() ? chosen : all}};
}

// What learning/shown_input.hpp makes of the cell's policy, as methods.json describes its method; null where it does
// not.
Json input_of(const CellResult& cell, const CommandResult& command) {
  static const fs::path file = data_directory() / "paper" / "methods.json";
  static const Json json = read_json(file);
  for (const JsonReader& one : JsonReader(json, file.string()).at("inputs").elements()) {
    if (!fits(cell, one)) continue;
    Json input{{"selection", nullptr}};
    for (const char* member : {"pictures", "text", "left_out"})
      if (one.has(member)) input[member] = one.at(member).json();
    for (const auto& [option, usual] :
         {std::pair{"policy", "regression"}, {"instances", "all"}, {"mask", "binary"}})  // no option of every method
      input[option] = cell.options.value(option, Json(usual));
    const Json& pictures = input.at("pictures");
    if (std::find(pictures.begin(), pictures.end(), Json("mask")) != pictures.end())
      input["selection"] = one.has("true_mask") ? command.truth : distribution_of(command.selection);
    return input;
  }
  return nullptr;
}

// Whether the list lacked the scene's picture of that name, which it then has; not of "".
bool is_new_in(std::vector<std::string>& names, const std::string& scene, const std::string& name) {
  if (name.empty() || std::find(names.begin(), names.end(), scene + name) != names.end()) return false;
  names.push_back(scene + name);
  return true;
}

// A request for each scene that a method played: those in which one failed first, then by index, then as the cells are
// ordered.
std::vector<Request> requests_of(const fs::path& run, const RunResults& results) {
  std::map<std::string, std::size_t> place;  // of a scene's request
  std::vector<Request> all;
  for (const CellResult& cell : results.cells) {
    if (cell.failed || cell.is_reference()) continue;
    std::vector<std::string> masks, inputs;  // of each command, what follows the scene's hash in their names
    for (const CommandResult& command : cell.commands) {
      masks.push_back(command.quality.empty() ? "" : mask_key("", cell, command.selection));
      inputs.push_back(input_key("", cell, command));
    }
    for (const std::string& arm : cell.arms)
      for (std::size_t i = 0; i < cell.episodes.at(arm).size(); ++i) {
        const Episode& episode = cell.episodes.at(arm)[i];
        const auto [known, is_new] = place.emplace(episode.scene, all.size());
        if (is_new)
          all.push_back(
              {{run / "cells" / cell.key / cell_file::configuration, arm, static_cast<int>(i), episode.scene}, {}});
        all[known->second].environment = cell.environment;
        Request& request = all[known->second];
        request.failed = request.failed || !episode.success();
        const CommandResult& command = cell.commands[episode.command];
        if (is_new_in(request.masks, episode.scene, masks[episode.command]))
          request.scene.selections.push_back(what_is_kept(cell, command.selection));
        if (is_new_in(request.inputs, episode.scene, inputs[episode.command]))
          request.scene.inputs.push_back(input_of(cell, command));
      }
  }
  std::stable_sort(all.begin(), all.end(), [](const Request& a, const Request& b) {
    return std::tuple(!a.failed, a.scene.index) < std::tuple(!b.failed, b.scene.index);
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
    request.scene.ends.push_back({c.cell->engine, c.episode().action});
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
                           {{agreement.first, d.episode().action}, {agreement.second, d.episode().action}}},
                          {},
                          {key(agreement.first), key(agreement.second)},
                          key("")});
    }
}

// A picture that is there already, of another policy, is not kept twice.
Pictures::Input read_input(const Json& drawn, std::vector<std::string>& seen) {
  Pictures::Input input;
  for (const Json& picture : drawn.at("pictures")) {
    const auto at = std::find(seen.begin(), seen.end(), picture.at(1).get<std::string>()) - seen.begin();
    if (static_cast<std::size_t>(at) == seen.size()) seen.push_back(picture.at(1));
    input.pictures.emplace_back(picture.at(0), at);
  }
  input.texts = drawn.at("texts").get<std::vector<std::string>>();
  input.unread = drawn.at("unread").get<std::vector<std::string>>();
  return input;
}

}  // namespace

std::string mask_key(const std::string& scene, const CellResult& cell, const Json& selection) {
  return scene + "/" + sha256(canonical(what_is_kept(cell, selection))).substr(0, 8);
}

std::string input_key(const std::string& scene, const CellResult& cell, const CommandResult& command) {
  const Json input = input_of(cell, command);
  return input.is_null() ? "" : scene + "/" + sha256(canonical(input)).substr(0, 8);
}

std::string end_key(const CellResult& cell, const std::string& arm, std::size_t index, const std::string& engine) {
  return fmt::format("{}/{}/{}/{}", cell.key, arm, index, engine);
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
      if (const Json& png = drawn.at("ends").at(i); png.is_string()) pictures.ends[request.ends[i]] = png;
    for (std::size_t i = 0; i < request.inputs.size(); ++i)
      if (const Json& input = drawn.at("inputs").at(i); !input.is_null())
        pictures.inputs[request.inputs[i]] = read_input(input, pictures.seen);
    if (!request.before.empty()) {
      pictures.ends[request.before] = drawn.at("picture");
      continue;
    }
    const std::string& scene = request.scene.scene;
    pictures.scenes[scene] = drawn.at("picture");
    pictures.targets[scene] = drawn.at("targets");
    if (drawn.at("oracle").is_array()) pictures.oracle[scene] = {request.environment, drawn.at("oracle").get<Action>()};
    for (std::size_t i = 0; i < request.masks.size(); ++i) pictures.masks[request.masks[i]] = drawn.at("masks").at(i);
  }
  return pictures;
}

}  // namespace lgabench::report
