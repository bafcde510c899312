// Two episodes of an entry that its page shows as pictures: files of the board's scenes/, listed in scenes.json.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>
#include <lgabench/leaderboard/recompute.hpp>

namespace lgabench::leaderboard {

inline constexpr const char *scenes_file = "scenes.json", *scenes_directory = "scenes";
constexpr std::uintmax_t most_picture_bytes = 18'000, most_scenes_bytes = 10'000'000;

/// An episode: the scene before its action and after it.
struct EntryScene {
  std::string cell, arm;  // the cell's key
  int index = 0;
  std::string command{}, sha256{};
};
/// An entry's scenes: "best", an episode that succeeded, and "worst", one that failed.
using EntryScenes = std::map<std::string, EntryScene>;
using BoardScenes = std::map<std::string, EntryScenes>;

/// "scenes/ID-best.png", relative to the board.
fs::path scene_picture(const std::string& entry, const std::string& which);

/// scenes.json of the board; nothing where there is none. @throws InputError with file and place for what is not as
/// docs/formats says, names an entry or episode that is not there, or an end that it did not have.
BoardScenes read_scenes(const fs::path& board, const std::vector<Entry>& entries);

/// @throws InputError where scenes.json names an entry that has no directory, before any entry is read.
void expect_entries_of_scenes(const fs::path& board);
/// Drops an entry's episodes from scenes.json, and their pictures.
void drop_scenes(const fs::path& board, const std::string& id);

/// A line for each picture that is missing, too large or not what scenes.json lists, and for each file that it does
/// not list.
std::vector<std::string> problems_of_scenes(const fs::path& board, const BoardScenes& scenes);

/// Plays two cells of the entry again, those with the fewest demonstrations in which it did best and worst, and draws
/// an episode of each that ends here as the entry says. Writes the pictures and, with those of `scenes`, which gets
/// them, scenes.json. Returns the pictures' paths; none where it was interrupted. @throws InputError and PluginError as
/// verification(), and where no episode ends here as the entry says, or a picture is too large.
std::optional<std::vector<fs::path>> add_scenes(const fs::path& board, const Entry& entry, const Catalogue& catalogue,
                                                const VerifyOptions& options, BoardScenes& scenes);
/// Seconds that the entry's two cells took, over all their scenes.
double seconds_of_scenes(const Entry& entry);

}  // namespace lgabench::leaderboard
