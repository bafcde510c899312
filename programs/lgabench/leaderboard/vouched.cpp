#include <lgabench/leaderboard/vouched.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>
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

// Whether the line is enough for an entry to count.
void expect_enough(const Entry& entry, const Json& line, const std::string& which) {
  const std::size_t enough = enough_cells_of(entry);
  if (line.value("kind", "") == "replay" && line.at("cells").size() < enough)
    throw InputError(fmt::format("{}: line {} is a replay of {} cells; expected {} or more: verify it with --cells {}",
                                 entry.place().string(), which, line.at("cells").size(), enough, enough));
  if (line.value("kind", "") == "fresh" && !line.contains("successes"))
    throw InputError(fmt::format("{}: line {} is of lgabench 0.2.0, which looked at one arm alone: verify it again",
                                 entry.place().string(), which));
}

// Calls it with each member of a file, an object; with none where there is no such file.
template <typename Function>
void for_each_member(const fs::path& file, const Function& call) {
  if (!fs::exists(fs::symlink_status(file))) return;
  const Json json = read_json(file, Links::refused);
  const JsonReader reader(json, file.string());
  if (!json.is_object()) reader.fail("an object");
  for (const auto& item : json.items()) call(item.key(), reader.at(item.key()));
}

}  // namespace

std::size_t enough_cells_of(const Entry& entry) { return std::min(enough_cells, entry.cells.size()); }

std::string line_hash(const Json& line) { return sha256(canonical(line)); }

Vouched read_vouched(const fs::path& board) {
  Vouched vouched;
  for_each_member(board / vouched_file, [&](const std::string& entry, const JsonReader& value) {
    const std::vector<std::string> lines = value.strings();
    vouched.lines[entry] = {lines.begin(), lines.end()};
  });
  for_each_member(board / vouched_entries_file,
                  [&](const std::string& entry, const JsonReader& value) { vouched.entries[entry] = value.string(); });
  for_each_member(board / instructions_file, [&](const std::string& entry, const JsonReader& value) {
    vouched.instructions[entry] = value.string();
    if (!contains(vector_instructions, value.string()))
      value.fail(fmt::format("one of {}", fmt::join(vector_instructions, ", ")));
  });
  return vouched;
}

void forget(const fs::path& board, const Entry& entry) {
  Vouched vouched = read_vouched(board);
  if (vouched.lines.erase(entry.hash()) > 0) write_file(board / vouched_file, Json(vouched.lines).dump(1) + "\n");
  if (vouched.entries.erase(entry.hash()) > 0)
    write_file(board / vouched_entries_file, Json(vouched.entries).dump(1) + "\n");
  if (vouched.instructions.erase(entry.id()) > 0)
    write_file(board / instructions_file, Json(vouched.instructions).dump(1) + "\n");
}

Json vouch(const fs::path& board, const std::string& name, const std::string& which) {
  const BoardWriter writer(board);
  const Entry entry = read_entry(board, find_entry(board, name));
  const Json& line = line_of(entry, which);
  Vouched vouched = read_vouched(board);
  const bool is_new = vouched.lines[entry.hash()].insert(line_hash(line)).second;
  const auto [rest, has_new] = vouched.entries.try_emplace(entry.hash(), entry.rest_hash());
  if (rest->second != entry.rest_hash())
    throw InputError(fmt::format("{}: entry.json is not the one that {} has the hash of", entry.place().string(),
                                 vouched_entries_file));
  if (is_new) expect_enough(entry, line, which);
  if (!is_new && !has_new)
    throw InputError(fmt::format("{}: line {} is vouched for already", entry.place().string(), which));
  write_file(board / vouched_entries_file, Json(vouched.entries).dump(1) + "\n");
  write_file(board / vouched_file, Json(vouched.lines).dump(1) + "\n");
  return line;
}

}  // namespace lgabench::leaderboard
