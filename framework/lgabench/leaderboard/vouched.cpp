#include <lgabench/leaderboard/vouched.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/hash.hpp>
#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {
namespace {

// "3" -> the third verification; "withdrawn".
const Json& line_of(const Entry& entry, const std::string& line) {
  if (line == "withdrawn") {
    if (entry.withdrawn.is_null()) throw InputError(fmt::format("{}: is not withdrawn", entry.place().string()));
    return entry.withdrawn;
  }
  for (std::size_t i = 0; i < entry.verifications.size(); ++i)
    if (line == std::to_string(i + 1)) return entry.verifications[i];
  throw InputError(fmt::format("{}/verifications.jsonl: no line \"{}\"; expected one of its {}, or withdrawn",
                               entry.place().string(), line, entry.verifications.size()));
}

}  // namespace

std::string line_hash(const Json& line) { return sha256(canonical(line)); }

Vouched read_vouched(const fs::path& board) {
  Vouched vouched;
  const fs::path file = board / vouched_file;
  if (!fs::exists(fs::symlink_status(file))) return vouched;
  const Json json = read_json(file, Links::refused);
  const JsonReader reader(json, file.string());
  if (!json.is_object()) reader.fail("an object");
  for (const auto& item : json.items()) {
    const std::vector<std::string> lines = reader.at(item.key()).strings();
    vouched[item.key()] = {lines.begin(), lines.end()};
  }
  return vouched;
}

std::string vouch(const fs::path& board, const std::string& name, const std::string& which) {
  const Entry entry = read_entry(board, find_entry(board, name));
  const Json& line = line_of(entry, which);
  const std::size_t enough = std::min(enough_cells, entry.cells.size());
  if (line.value("kind", "") == "replay" && line.at("cells").size() < enough)
    throw InputError(fmt::format("{}: line {} is a replay of {} cells; expected {} or more: verify it with --cells {}",
                                 entry.place().string(), which, line.at("cells").size(), enough, enough));
  if (line.value("kind", "") == "fresh" && !line.contains("successes"))
    throw InputError(fmt::format("{}: line {} is of lgabench 0.2.0, which looked at one arm alone: verify it again",
                                 entry.place().string(), which));
  Vouched vouched = read_vouched(board);
  const std::string hash = line_hash(line);
  if (!vouched[entry.hash()].insert(hash).second)
    throw InputError(fmt::format("{}: line {} is vouched for already", entry.place().string(), which));
  write_file(board / vouched_file, Json(vouched).dump(1) + "\n");
  return hash;
}

}  // namespace lgabench::leaderboard
