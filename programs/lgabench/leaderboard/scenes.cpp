#include <lgabench/leaderboard/scenes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/job/job.hpp>
#include <lgabench/job/worker.hpp>
#include <lgabench/leaderboard/fields.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/statistics/results.hpp>

namespace lgabench::leaderboard {
namespace {

constexpr int looked_at = 10;  // episodes of an arm, the first ones

bool is_end(const std::string& which, char letter) {
  return letter != failed_cell_letter && is_success(letter) == (which == "best");
}

std::string first_of(const std::string& letters) { return letters.substr(0, looked_at); }

auto find_cell(const Entry& entry, const std::string& key) {
  return std::find_if(entry.cells.begin(), entry.cells.end(),
                      [&key](const PlayedCell& cell) { return cell.key == key; });
}

const PlayedCell& cell_of(const Entry& entry, const std::string& key) { return *find_cell(entry, key); }

// The arm with most success, or with least, in a cell of the fewest demonstrations and the first training seed; none
// where no episode ended so. The first of equal ones, as the setting has them.
std::optional<EntryScene> chosen_arm(const Entry& entry, const std::string& which) {
  std::optional<EntryScene> chosen;
  double before = 0;
  for (const PlayedCell& cell : entry.cells) {
    const Place &place = cell.place, &first = entry.cells.front().place;
    if (place.demonstrations != first.demonstrations || place.seed != first.seed) continue;
    for (const std::string& arm : entry.setting.scenario(place.scenario).arms) {
      const std::string letters = first_of(cell.outcomes.at(arm));
      if (std::none_of(letters.begin(), letters.end(), [&](char letter) { return is_end(which, letter); })) continue;
      const double rate = static_cast<double>(successes(cell.outcomes.at(arm))) * (which == "best" ? 1 : -1);
      if (chosen && rate <= before) continue;
      chosen = EntryScene{cell.key, arm, 0};
      before = rate;
    }
  }
  return chosen;
}

EntryScenes chosen_scenes(const Entry& entry) {
  EntryScenes of_entry;
  for (const char* which : {"best", "worst"})
    if (const auto chosen = chosen_arm(entry, which)) of_entry[which] = *chosen;
  return of_entry;
}

EntryScene read_scene(const JsonReader& reader, const std::string& which, const Entry& entry) {
  const EntryScene scene = value_of<EntryScene>(reader);
  const auto cell = find_cell(entry, scene.cell);
  if (cell == entry.cells.end()) reader.at("cell").fail("a cell of the entry");
  const auto letters = cell->outcomes.find(scene.arm);
  if (letters == cell->outcomes.end()) reader.at("arm").fail("an arm of the cell");
  reader.at("index").integer(0, static_cast<long long>(letters->second.size()) - 1);
  if (!is_end(which, letters->second[static_cast<std::size_t>(scene.index)]))
    reader.at("index").fail(which == "best" ? "an episode that succeeded" : "an episode that failed");
  return scene;
}

// scenes.json by entry; an empty object where there is none. `is_known`: of ids
Json read_scenes_file(const fs::path& board, const std::function<bool(const std::string&)>& is_known) {
  const fs::path file = board / scenes_file;
  if (!fs::exists(fs::symlink_status(file))) return Json::object();
  Json json = read_json(file, Links::refused);
  if (!json.is_object()) JsonReader(json, file.string()).fail("an object: scenes by entry");
  for (const auto& item : json.items())
    if (!is_known(item.key()))
      throw InputError(fmt::format("{}: /{}: expected the id of an entry of the board", file.string(), item.key()));
  return json;
}

void write_scenes(const fs::path& board, const BoardScenes& scenes) {
  Json json = Json::object();
  for (const auto& [entry, of_entry] : scenes)
    for (const auto& [which, scene] : of_entry) json[entry][which] = json_of(scene);
  write_file(board / scenes_file, json.dump(1) + "\n");
}

// Of the episodes that are looked at, those that ended as they should, in the entry and here.
std::vector<const Episode*> same_ends(const std::string& which, const std::string& letters,
                                      const std::vector<Episode>& played) {
  std::vector<const Episode*> same;
  for (std::size_t i = 0; i < played.size(); ++i)
    if (is_end(which, letters[i]) && played[i].success() == is_success(letters[i])) same.push_back(&played[i]);
  return same;
}

// The first with an action to draw; null where all said at once that nothing is left to do.
const Episode* to_draw(const std::vector<const Episode*>& episodes) {
  const auto acts = [](const Episode* episode) { return !episode->action.empty(); };
  const auto found = std::find_if(episodes.begin(), episodes.end(), acts);
  return found == episodes.end() ? nullptr : *found;
}

}  // namespace

void fields(EntryScene& scene, Fields& field) {
  field("cell", scene.cell);
  field("arm", scene.arm);
  field("index", scene.index);
  field("command", scene.command);
  field("sha256", scene.sha256);
}

fs::path scene_picture(const std::string& entry, const std::string& which) {
  return fs::path(scenes_directory) / fmt::format("{}-{}.png", entry, which);
}

double seconds_of_scenes(const Entry& entry) {
  std::set<std::string> keys;
  for (const auto& [which, scene] : chosen_scenes(entry)) keys.insert(scene.cell);
  double seconds = 0;
  for (const std::string& key : keys) seconds += cell_of(entry, key).total_s;
  return seconds;
}

BoardScenes read_scenes(const fs::path& board, const std::vector<Entry>& entries) {
  BoardScenes scenes;
  std::map<std::string, const Entry*> by_id;
  for (const Entry& entry : entries) by_id[entry.id()] = &entry;
  const Json json = read_scenes_file(board, [&](const std::string& id) { return by_id.count(id) > 0; });
  const JsonReader reader(json, (board / scenes_file).string());
  for (const auto& [id, ignored] : json.items()) {
    reader.at(id).only({"best", "worst"});
    for (const char* which : {"best", "worst"})
      if (reader.at(id).has(which)) scenes[id][which] = read_scene(reader.at(id).at(which), which, *by_id.at(id));
  }
  return scenes;
}

void expect_entries_of_scenes(const fs::path& board) {
  std::set<std::string> ids;
  for (const fs::path& directory : entry_directories(board)) ids.insert(directory.parent_path().filename());
  read_scenes_file(board, [&](const std::string& id) { return ids.count(id) > 0; });
}

void drop_scenes(const fs::path& board, const std::string& id) {
  const fs::path file = board / scenes_file;
  if (!fs::exists(fs::symlink_status(file))) return;
  Json scenes = read_json(file, Links::refused);
  if (!scenes.is_object() || scenes.erase(id) == 0) return;
  write_file(file, scenes.dump(1) + "\n");
  for (const char* which : {"best", "worst"}) fs::remove(board / scene_picture(id, which));
}

std::vector<std::string> problems_of_scenes(const fs::path& board, const BoardScenes& scenes) {
  std::vector<std::string> problems;
  std::set<fs::path> listed;
  std::uintmax_t bytes = 0;
  for (const auto& [entry, of_entry] : scenes)
    for (const auto& [which, scene] : of_entry) {
      const fs::path picture = scene_picture(entry, which), file = board / picture;
      listed.insert(picture.filename());
      if (fs::symlink_status(file).type() != fs::file_type::regular) {
        problems.push_back(fmt::format("{}: expected the picture that {} lists", picture.string(), scenes_file));
        continue;
      }
      bytes += fs::file_size(file);
      if (fs::file_size(file) > most_picture_bytes)
        problems.push_back(fmt::format("{}: expected at most {} bytes, got {}", picture.string(), most_picture_bytes,
                                       fs::file_size(file)));
      else if (sha256_file(file) != scene.sha256)
        problems.push_back(fmt::format("{}: not the picture whose SHA-256 {} has", picture.string(), scenes_file));
    }
  if (bytes > most_scenes_bytes)
    problems.push_back(
        fmt::format("{}/: expected at most {} bytes in all, got {}", scenes_directory, most_scenes_bytes, bytes));
  if (fs::symlink_status(board / scenes_directory).type() == fs::file_type::directory)
    for (const auto& item : fs::directory_iterator(board / scenes_directory))
      if (listed.count(item.path().filename()) == 0)
        problems.push_back(fmt::format("{}/{}: no picture that {} lists", scenes_directory,
                                       item.path().filename().string(), scenes_file));
  return problems;
}

std::optional<std::vector<fs::path>> add_scenes(const fs::path& board, const Entry& entry, const Catalogue& catalogue,
                                                const VerifyOptions& options, BoardScenes& scenes) {
  EntryScenes of_entry = chosen_scenes(entry);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < entry.cells.size(); ++i)
    if (std::any_of(of_entry.begin(), of_entry.end(),
                    [&](const auto& one) { return one.second.cell == entry.cells[i].key; }))
      places.push_back(i);
  const std::optional<Recomputed> again = played_again(board, entry, places, looked_at, catalogue, options);
  if (!again) return std::nullopt;
  std::map<std::string, statistics::CellResult> results;  // by the entry's key
  std::map<std::string, fs::path> directories;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string& key = entry.cells[places[i]].key;
    directories[key] = again->cells[i];
    if (results.emplace(key, statistics::read_cell(again->cells[i])).first->second.failed)
      throw InputError(fmt::format("{}: failed here: {}", entry.cells[places[i]].place.text(), results.at(key).reason));
  }
  const Scratch scratch("scenes");
  Json requests = Json::array();
  for (auto one = of_entry.begin(); one != of_entry.end();) {
    auto& [which, scene] = *one;
    const statistics::CellResult& result = results.at(scene.cell);
    const std::string letters = first_of(cell_of(entry, scene.cell).outcomes.at(scene.arm));
    const std::vector<const Episode*> same = same_ends(which, letters, result.episodes.at(scene.arm));
    if (same.empty())
      throw InputError(fmt::format("{} {}: none of the first {} episodes ends here as in the entry",
                                   cell_of(entry, scene.cell).place.text(), scene.arm, letters.size()));
    const Episode* const episode = to_draw(same);
    if (!episode) {
      one = of_entry.erase(one);
      continue;
    }
    ++one;
    scene.index = episode->index;
    scene.command = result.commands.at(static_cast<std::size_t>(episode->command)).utterance;
    requests.push_back(to_json(PictureRequest{directories.at(scene.cell) / cell_file::configuration,
                                              scene.arm,
                                              episode->index,
                                              episode->scene,
                                              {},
                                              {{entry.identity.engine, episode->actions()}}}));
    requests.back()["out"] = (scratch.path / which).string();
    requests.back()["most_bytes"] = most_picture_bytes;
  }
  const WorkerAnswers answers = ask_worker("strips", requests);
  for (const Json& line : answers.lines)
    if (!line.is_object() || line.contains("problem"))
      throw InputError(line.is_object() ? line.at("problem").get<std::string>() : answers.problem);
  std::vector<fs::path> paths;
  const BoardWriter writer(board);
  for (auto& [which, scene] : of_entry) {
    const std::string png = read_file(scratch.path / which);
    const fs::path picture = scene_picture(entry.id(), which);
    if (png.size() > most_picture_bytes)
      throw InputError(
          fmt::format("{}: expected at most {} bytes, got {}", picture.string(), most_picture_bytes, png.size()));
    scene.sha256 = sha256(png);
    write_file(board / picture, png);
    paths.push_back(picture);
  }
  scenes[entry.id()] = std::move(of_entry);
  write_scenes(board, scenes);
  return paths;
}

}  // namespace lgabench::leaderboard
