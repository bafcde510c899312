// An entry that somebody sends, and the pages that a board makes of some: entry.json in the first line, then
// cells.jsonl.
#include <algorithm>
#include <utility>

#include <lgabench/core/hash.hpp>
#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/said.hpp>
#include <lgabench/leaderboard/verification.hpp>

#include "../unit/programs/leaderboard_board.hpp"
#include "fuzz.hpp"

namespace {

using namespace lgabench;
using namespace lgabench::leaderboard;

// What an honest writer's hashes would be, and its form, so that what lies behind these checks is reached.
void put_right(Json& entry) {
  try {
    const Setting setting = read_setting(JsonReader(entry, "entry").at("preset"));
    entry["identity"]["preset"] = hash(setting);
    entry["identity"]["scene_seed"] = setting.scene_seed;
    entry["id"] = sha256(canonical(entry["identity"])).substr(0, 16);
  } catch (const InputError&) {  // the reader will say so
  } catch (const Json::exception&) {
  }
}

fs::path place_of(const Json& entry) {
  try {
    return fs::path("entries") / entry.at("identity").at("method").get<std::string>() /
           entry.at("id").get<std::string>() /
           (entry.at("preset").at("suite").get<std::string>() + "-" +
            entry.at("preset").at("preset").get<std::string>());
  } catch (const Json::exception&) {
    return "entries/m/0/q1-board";
  }
}

bool is_small(const Entry& entry) {
  std::size_t episodes = 0;
  for (const PlayedCell& cell : entry.cells) episodes += static_cast<std::size_t>(cell.episodes());
  return entry.cells.size() <= 40 && episodes <= 4000;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path board = fuzz::directory() / "board";
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t end = std::min(text.find('\n'), text.size());
  Json json = json_or_null(text.substr(0, end));
  put_right(json);
  fs::path place = place_of(json).lexically_normal();
  if (!place.is_relative() || *place.begin() != "entries" || place.string().find('\0') != std::string::npos ||
      place.string().size() > 200)
    place = "entries/m/0/q1-board";
  std::string cells;
  for (const std::string_view line : fuzz::split(text.substr(std::min(end + 1, text.size())), "\n"))
    if (!line.empty()) {
      const Json cell = json_or_null(line);
      cells += (cell.is_object() ? canonical(cell) : std::string(line)) + "\n";
    }
  fuzz::write(board / place / "entry.json",
              json.is_null() ? std::string(text.substr(0, end)) : text_of_entry(std::move(json)));
  if (end < text.size()) fuzz::write(board / place / "cells.jsonl", cells);
  try {
    Entry entry = read_entry(board, place);
    entry.spec();
    claims(entry);
    if (fuzz::takes_long(text) && is_small(entry)) {
      made_files(board, read_entries(board), {});
      add_vouched(entry, replay_of(entry, "somebody", entry.processor().name));
      made_files(board, {entry}, {});
    }
  } catch (const InputError&) {
  }
  std::error_code nothing_there;
  fs::remove_all(board / "entries", nothing_there);
  return 0;
}
