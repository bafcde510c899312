#include <lgabench/leaderboard/superseded.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/leaderboard/check.hpp>

namespace lgabench::leaderboard {
namespace {

using Files = std::map<std::string, std::string>;

// The bytes of the files of a directory, by their names.
Files files_of(const fs::path& directory) {
  Files files;
  for (const char* file : entry_files)
    if (fs::exists(fs::symlink_status(directory / file))) files[file] = read_file(directory / file, Links::refused);
  return files;
}

// Likewise of a directory of the revision.
Files files_of(const Files& before, const std::string& directory) {
  Files files;
  for (const char* file : entry_files)
    if (const auto there = before.find(directory + "/" + file); there != before.end()) files[file] = there->second;
  return files;
}

}  // namespace

std::string other_cell(const Entry& there, const Entry& here) {
  if (there.cells.size() != here.cells.size())
    return fmt::format("{} cells, {} in its place", there.cells.size(), here.cells.size());
  for (std::size_t i = 0; i < there.cells.size(); ++i) {
    const PlayedCell &a = there.cells[i], &b = here.cells[i];
    if (!(a.place == b.place)) return fmt::format("cell {} has {} in its place", a.place.text(), b.place.text());
    if (!a.scenes.empty() && !b.scenes.empty() && a.scenes != b.scenes)
      return fmt::format("cell {} has another with other test scenes in its place", a.place.text());
  }
  return "";
}

std::vector<std::string> problems_of_superseded(const fs::path& board, const std::vector<Entry>& entries) {
  std::vector<std::string> problems;
  std::set<std::string> there;
  std::map<std::string, const Entry*> by_id;
  for (const Entry& entry : entries) by_id[entry.id()] = &entry;
  for (const fs::path& directory : superseded_directories(board)) try {
      const Entry old = read_superseded(board, directory);
      const auto now = by_id.find(old.id());
      const bool is_named =
          now != by_id.end() && std::any_of(now->second->supersedes.begin(), now->second->supersedes.end(),
                                            [hash = old.hash()](const Json& one) { return one.at("hash") == hash; });
      there.insert(directory.string());
      if (!is_named)
        problems.push_back(fmt::format("{}: no entry of this id names it in /supersedes", directory.string()));
      else if (const std::string other = other_cell(old, *now->second); !other.empty())
        problems.push_back(fmt::format("{}: {}", directory.string(), other));
      else if (old.about != now->second->about || old.score != now->second->score)
        problems.push_back(fmt::format("{}: other authors or another score in its place", directory.string()));
    } catch (const InputError& e) {
      there.insert(directory.string());
      problems.emplace_back(e.what());
    }
  for (const Entry& entry : entries)
    for (const Json& one : entry.supersedes)
      if (const std::string kept = superseded_place(entry.id(), one.at("hash")).string(); there.count(kept) == 0)
        problems.push_back(fmt::format("{}: {}, whose place it took, is not there", entry.place().string(), kept));
  return problems;
}

std::set<std::string> superseded_since(const Files& before, const fs::path& board, const std::vector<Entry>& entries,
                                       const std::string& revision, std::vector<std::string>& problems) {
  std::set<std::string> places, known;
  for (const Entry& entry : entries) {
    const std::string place = entry.place().string();
    const Files there = files_of(before, place);
    const auto text = there.find("entry.json");
    if (text == there.end()) continue;
    const Json old = json_or_null(text->second);
    const Json named = old.is_object() ? old.value("supersedes", Json::array()) : Json::array();
    const Json& now = entry.supersedes;
    if (named.size() >= now.size() || !std::equal(named.begin(), named.end(), now.begin())) continue;
    std::vector<std::string> kept;  // of those that are new
    for (std::size_t i = named.size(); i < now.size(); ++i)
      kept.push_back(superseded_place(entry.id(), now[i].at("hash")).string());
    const auto stayed = [&](const auto& file) {
      return what_changed(board / kept.front() / file.first, file.second).empty();
    };
    if (!std::all_of(there.begin(), there.end(), stayed)) continue;
    places.insert(place);
    known.insert(kept.begin(), kept.end());
  }
  for (const fs::path& directory : superseded_directories(board)) {
    const std::string kept = directory.string();
    const Files was = files_of(before, kept);
    if (was.empty() ? known.count(kept) == 0 : files_of(board / kept) != was)
      problems.push_back(
          was.empty() ? fmt::format("{}: is no entry of the board whose place another took", kept)
                      : fmt::format("{}: changed since {}: what was superseded stays as it was", kept, revision));
  }
  for (const auto& [file, ignored] : before)
    if (file.rfind(std::string(superseded_directory) + "/", 0) == 0 && !fs::exists(board / file))
      problems.push_back(fmt::format("{}: is gone since {}", file, revision));
  return places;
}

}  // namespace lgabench::leaderboard
