#include <lgabench/report/pictures.hpp>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/selection.hpp>
#include <lgabench/job/job.hpp>

namespace lgabench::report {
namespace {

struct Request {
  PictureRequest scene;
  std::vector<std::string> masks;   // mask_key of each of its selections
  std::vector<std::string> ends{};  // end_key of the scene itself, then of each engine that is asked for
};

// All that a goal mask depends on beside the scene.
Json what_is_kept(const CellResult& cell, const Json& selection) {
  const Json all = "all", chosen = cell.options.value("instances", all);
  return {{"distribution", distribution_of(selection)}, {"instances", chosen.is_string() ? chosen : all}};
}

// A request for each scene in which a method failed, by index, then as the cells are ordered.
std::vector<Request> requests_of(const fs::path& run, const RunResults& results) {
  std::map<std::string, std::size_t> place;  // of a scene's request
  std::vector<Request> all;
  for (const CellResult& cell : results.cells) {
    if (cell.failed || cell.is_reference()) continue;
    for (const std::string& arm : cell.arms)
      for (std::size_t i = 0; i < cell.episodes.at(arm).size(); ++i) {
        const PlayedEpisode& episode = cell.episodes.at(arm)[i];
        if (episode.success) continue;
        const auto [known, is_new] = place.emplace(episode.scene, all.size());
        if (is_new)
          all.push_back({{run / "cells" / cell.key / "cell.json", arm, static_cast<int>(i), episode.scene}, {}});
        const CommandResult& command = cell.commands[episode.command];
        if (command.quality.is_null()) continue;
        Request& request = all[known->second];
        const std::string key = mask_key(episode.scene, cell, command.selection);
        if (std::find(request.masks.begin(), request.masks.end(), key) != request.masks.end()) continue;
        request.masks.push_back(key);
        request.scene.selections.push_back(what_is_kept(cell, command.selection));
      }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Request& a, const Request& b) { return a.scene.index < b.scene.index; });
  return all;
}

void add_ends(const fs::path& run, const std::vector<EngineAgreement>& agreements, std::vector<Request>& requests) {
  std::size_t added = 0;
  for (const EngineAgreement& agreement : agreements)
    for (const Disagreement& d : agreement.disagreements) {
      if (added++ == most_ends) return;
      requests.push_back({{run / "cells" / d.cell->key / "cell.json",
                           d.arm,
                           static_cast<int>(d.index),
                           d.episode().scene,
                           {},
                           {agreement.first, agreement.second},
                           d.episode().action},
                          {},
                          {end_key(d, ""), end_key(d, agreement.first), end_key(d, agreement.second)}});
    }
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// Standard output of `lgabench-worker pictures`, given `input`. Returns what went wrong, or "".
std::string run_worker(const std::string& input, std::string& output) {
  const File in(std::tmpfile(), std::fclose), out(std::tmpfile(), std::fclose);
  if (!in || !out || std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() || std::fflush(in.get()) != 0)
    return fmt::format("no temporary file could be written: {}", std::strerror(errno));
  std::rewind(in.get());

  const std::string program = (program_directory() / "lgabench-worker").string();
  const int status =
      wait_for(start_process({{program, "pictures"},
                              environment_with({}),
                              {{::fileno(in.get()), STDIN_FILENO}, {::fileno(out.get()), STDOUT_FILENO}}}));
  if (WIFEXITED(status) && WEXITSTATUS(status) == not_started) return "lgabench-worker could not be started";
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "lgabench-worker failed";

  std::rewind(out.get());
  char buffer[1 << 16];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, out.get())) > 0;) output.append(buffer, n);
  return "";
}

}  // namespace

std::string mask_key(const std::string& scene, const CellResult& cell, const Json& selection) {
  return scene + "/" + sha256(canonical(what_is_kept(cell, selection))).substr(0, 8);
}

std::string end_key(const Disagreement& d, const std::string& engine) {
  return fmt::format("{}/{}/{}/{}", d.cell->key, d.arm, d.index, engine);
}

Pictures draw_pictures(const fs::path& run, const RunResults& results, const std::vector<EngineAgreement>& agreements) {
  Pictures pictures;
  std::vector<Request> requests = requests_of(run, results);
  pictures.wanted = requests.size();
  if (requests.size() > most_pictures) requests.resize(most_pictures);
  add_ends(run, agreements, requests);
  if (requests.empty()) return pictures;

  Json asked = Json::array();
  for (const Request& request : requests) asked.push_back(to_json(request.scene));
  std::string lines;
  pictures.problem = run_worker(canonical(asked), lines);
  std::size_t begin = 0;
  for (const Request& request : requests) {
    const std::size_t end = std::min(lines.find('\n', begin), lines.size());
    const Json drawn = json_or_null(lines.substr(begin, end - begin));
    begin = std::min(end + 1, lines.size());
    if (!drawn.is_object() || !drawn.contains("picture")) {
      if (pictures.problem.empty()) pictures.problem = drawn.is_object() ? drawn.value("problem", "") : "no answer";
      continue;
    }
    if (!request.ends.empty()) {
      pictures.ends[request.ends[0]] = drawn.at("picture");
      for (std::size_t i = 1; i < request.ends.size(); ++i)
        if (const Json& png = drawn.at("ends").at(i - 1); png.is_string()) pictures.ends[request.ends[i]] = png;
      continue;
    }
    pictures.scenes[request.scene.scene] = drawn.at("picture");
    for (std::size_t i = 0; i < request.masks.size(); ++i) pictures.masks[request.masks[i]] = drawn.at("masks").at(i);
  }
  return pictures;
}

}  // namespace lgabench::report
