// The board's tracks: what each preset asks for, by the board's tracks.json.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <lgabench/leaderboard/setting.hpp>

namespace lgabench::leaderboard {

inline constexpr const char* tracks_file = "tracks.json";

/// What competes in a table. abstraction: what is selected, while the shipped policy learns and acts; open: all that
/// acts; reproduction, every preset that is in no track: likewise, and those with the paper's network by themselves.
struct Track {
  enum Kind { reproduction, abstraction, open } kind = reproduction;
  std::vector<std::string> arms{};      // of the abstraction track: where an abstraction decides
  std::string answers{};                // likewise: whose frozen answers the rows share that are ranked; "": nobody is
  bool names_read = false;              // of any: whether rows whose names were read from pictures are ranked
  std::map<int, std::string> labels{};  // by demonstrations: the rule of labels that was best in development scenes
  bool persons = false;  // of any: rows may ask simulated people, and are ranked once they met other persons
};

/// By preset, as "clutter-abstraction".
using Tracks = std::map<std::string, Track>;

/// The tracks of the board's tracks.json; none where there is no such file. @throws InputError with file and place.
Tracks read_tracks(const std::filesystem::path& board);
/// The suites that pages have first, in their order, by the same file. @throws as read_tracks().
std::vector<std::string> read_order(const std::filesystem::path& board);
/// @throws InputError with file and place for an arm of the setting's track that none of its scenarios has.
void expect_arms(const std::filesystem::path& board, const Tracks& tracks, const Setting& setting);

/// Rows that are ranked against each other, in a table of their own: all of a preset; those of them that learn as the
/// paper does; those of the abstraction track, which differ in their answers alone.
enum class Ranking { any_policy, papers_network, answers_only };
/// "any policy", "paper's network", "answers only"
std::string to_string(Ranking ranking);
/// A preset's, the first of which has all of its rows.
std::vector<Ranking> rankings_of(const Track& track);

/// The setting's.
Track track_of(const Tracks& tracks, const Setting& setting);

/// What a page says of it, of a table in that track. Of several tables together: without a track.
std::string words_of(Ranking ranking, const Track* track = nullptr);

}  // namespace lgabench::leaderboard
