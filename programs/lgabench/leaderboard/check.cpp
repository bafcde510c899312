#include <lgabench/leaderboard/check.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/recompute.hpp>
#include <lgabench/leaderboard/revision.hpp>
#include <lgabench/leaderboard/said.hpp>
#include <lgabench/leaderboard/scenes.hpp>
#include <lgabench/leaderboard/superseded.hpp>

namespace lgabench::leaderboard {
namespace {

bool begins_with(const Json& list, const Json& first) {
  return list.size() >= first.size() && std::equal(first.begin(), first.end(), list.begin());
}

// entry.json may gain evidence, be withdrawn, and say its Selections in its other form; nothing else in it changes or
// appears.
std::string changed_entry(const fs::path& file, const std::string& before, const std::string& now) {
  const Json there = expanded(json_or_null(before), file.string()), here = expanded(json_or_null(now), file.string());
  if (!there.is_object() || !here.is_object()) return "is no JSON object any more";
  for (const auto& [member, value] : there.items()) {
    const Json other = here.value(member, Json());
    if (member == "evidence" ? !begins_with(other, value) : other != value) return fmt::format("/{} changed", member);
  }
  for (const auto& [member, value] : here.items())
    if (!there.contains(member) && member != "withdrawn") return fmt::format("/{} appeared", member);
  return "";
}

}  // namespace

std::string what_changed(const fs::path& file, const std::string& before) {
  if (!fs::exists(fs::symlink_status(file))) return "is gone (leaderboard withdraw keeps the record)";
  const std::string now = read_file(file, Links::refused);
  if (now == before) return "";
  if (file.filename() == "entry.json") return changed_entry(file, before, now);
  if (file.filename() == "verifications.jsonl") return now.rfind(before, 0) == 0 ? "" : "a verification changed";
  return "an outcome or a cell changed";
}

namespace {

using Files = std::map<std::string, std::string>;

// `entries`: of the board, as far as they can be read.
void compare_with(const Files& before, const fs::path& board, const std::vector<Entry>& entries,
                  const CheckOptions& options, Checked& checked) {
  for (const char* file : maintainers_files) {
    const auto there = before.find(file);
    const bool is = fs::exists(fs::symlink_status(board / file)), was = there != before.end();
    if (!options.maintainer && (is != was || (is && read_file(board / file, Links::refused) != there->second)))
      checked.problems.push_back(
          fmt::format("{}: changed since {}: it is the maintainers' (--maintainer)", file, options.against));
  }
  std::set<std::string> superseded;
  try {
    superseded = superseded_since(before, board, entries, options.against, checked.problems);
  } catch (const InputError& e) {  // likewise below
    checked.problems.emplace_back(e.what());
  }
  for (const std::string& place : superseded)
    if (!options.maintainer)
      checked.problems.push_back(
          fmt::format("{}: superseded since {}: only the maintainers do that (--maintainer)", place, options.against));
  for (const auto& [file, bytes] : before) {
    try {
      if (file.rfind("entries/", 0) != 0 || superseded.count(fs::path(file).parent_path().string()) > 0) continue;
      if (const std::string what = what_changed(board / file, bytes); !what.empty())
        checked.problems.push_back(fmt::format("{}: {} since {}", file, what, options.against));
    } catch (const InputError& e) {  // a link, say, in the place of a file
      checked.problems.emplace_back(e.what());
    }
  }
}

// Entries of one table played the same scenes: a cell's hash of scenes is every other entry's.
void expect_same_scenes(const std::vector<Entry>& entries, Checked& checked) {
  for (const auto& table : tables(entries)) {
    std::map<std::tuple<std::string, std::string, std::uint64_t>, std::pair<std::string, const Entry*>> scenes;
    for (const Entry* entry : table)
      for (const PlayedCell& cell : entry->cells) {
        if (cell.scenes.empty()) continue;
        const std::uint64_t set = scene_set(entry->setting.test_scenes, cell.place.seed);
        const auto& [first, by] =
            scenes.try_emplace({cell.place.scenario, cell.place.layout, set}, cell.scenes, entry).first->second;
        if (first == cell.scenes) continue;
        checked.problems.push_back(fmt::format("{}: other test scenes than {} in {}", entry->place().string(),
                                               by->place().string(), cell.place.text()));
        break;
      }
  }
}

void expect_answers(const fs::path& board, const Entry& entry, Checked& checked) {
  const fs::path kept = answers_file(entry.identity), file = board / kept;
  if (kept.empty()) return;
  if (!fs::exists(file) || sha256_file(file) != entry.identity.answers_sha256)
    checked.problems.push_back(
        fmt::format("{}: {} is not there, or not what its name says", entry.place().string(), file.string()));
}

// One that is what its name says may be of an `add` that was killed, which a request has not.
void expect_no_other_answers(const fs::path& board, const std::vector<Entry>& entries, bool is_request,
                             Checked& checked) {
  const bool was_killed = !is_request && fs::exists(board / adding_directory);
  for (const fs::path& file : other_answers(board, entries)) {
    const std::string ending = file.extension();
    if (was_killed && fs::symlink_status(board / file).type() == fs::file_type::regular &&
        (ending == ".json" || ending == ".jsonl") && sha256_file(board / file) == file.stem())
      continue;
    checked.problems.push_back(fmt::format("{}: no entry is based on it; remove it", file.string()));
  }
}

std::string between(const std::string& bytes, const char* begin, const char* end) {
  const std::size_t from = bytes.find(begin), to = from == bytes.npos ? from : bytes.find(end, from);
  return to == bytes.npos ? "" : bytes.substr(from, to - from);
}

// What of a file comes from the entries: the rest of a page may be another version's.
std::string substance(const fs::path& file, const std::string& bytes) {
  if (file.extension() != ".html") return bytes;
  return between(bytes, "<main>", "</main>") + between(bytes, "id=\"data\">", "</script>");
}

void expect_current(const fs::path& board, const std::vector<Entry>& entries, const CheckOptions& options,
                    Checked& checked) {
  try {
    for (const auto& [file, bytes] : made_files(board, entries, options.documents, options.on_progress))
      if (!fs::exists(file) || substance(file, read_file(file)) != substance(file, bytes))
        checked.problems.push_back(
            fmt::format("{}: not what lgabench leaderboard build makes of the entries", file.string()));
  } catch (const InputError& e) {  // a document
    checked.problems.emplace_back(e.what());
  }
}

// The rest of a page: its style, scripts and words.
std::string frame(std::string bytes) {
  for (const auto& [begin, end] :
       {std::pair<std::string, const char*>("<main>", "</main>"), {"id=\"data\">", "</script>"}})
    if (const std::size_t from = bytes.find(begin), to = bytes.find(end, from); from != bytes.npos && to != bytes.npos)
      bytes.erase(from + begin.size(), to - from - begin.size());
  return bytes;
}

// A page may be as it was at the revision, or as this build writes it; whoever opens one runs its scripts.
void expect_frames(const fs::path& board, const std::vector<Entry>& entries, const Files& before, Checked& checked) {
  for (const auto& [file, bytes] : made_files(board, entries, {})) {
    if (file.extension() != ".html") continue;
    const std::string name = file.filename(), now = frame(read_file(file, Links::refused));
    const auto there = before.find(name);
    if (now != frame(bytes) && (there == before.end() || now != frame(there->second)))
      checked.problems.push_back(
          fmt::format("{}: changed outside its tables; lgabench leaderboard build writes it", name));
  }
}

// Nothing lies beside what a board has: git, a web server or a browser obeys some names.
void expect_nothing_else(const fs::path& board, const std::vector<Entry>& entries, bool is_request, Checked& checked) {
  std::set<std::string> files{"README.md", "index.html", "leaderboard.csv"};
  std::set<std::string> directories{"entries", "answers", scenes_directory, superseded_directory};
  if (!is_request) directories.insert(adding_directory);
  files.insert(maintainers_files.begin(), maintainers_files.end());
  for (const Entry& entry : entries) files.insert(entry.setting.suite + ".html");
  const auto expect = [&](const fs::directory_entry& item, bool known) {
    if (!known || item.is_symlink())
      checked.problems.push_back(fmt::format("{}: {}", item.path().lexically_relative(board).string(),
                                             known ? "a symbolic link" : "no file of a board"));
  };
  for (const auto& item : fs::directory_iterator(board))
    expect(item, (item.is_directory() ? directories : files).count(item.path().filename()) > 0);
  if (fs::symlink_status(board / adding_directory).type() != fs::file_type::directory) return;
  for (const auto& item : fs::recursive_directory_iterator(board / adding_directory)) {
    const std::string name = item.path().filename(), ending = item.path().extension();
    expect(item, name[0] != '.' &&
                     (item.is_directory() || ending == ".json" || ending == ".jsonl" || is_temporary(item.path())));
  }
}

// What is not yet replayed was played here and now: in a preset and on an engine that are installed. Older entries were
// replayed while theirs were.
void expect_installed(const Entry& entry, const Catalogue& installed, Checked& checked) {
  if (entry.was_replayed()) return;
  try {
    installed_as(entry, installed);
  } catch (const Error& e) {
    checked.problems.push_back(fmt::format("{}: {}", entry.place().string(), e.what()));
  }
}

// Every line that is vouched for is there: an entry that changed would lose what it was vouched for.
void expect_vouched(const std::vector<Entry>& entries, const Vouched& vouched, Checked& checked) {
  std::set<std::string> there;
  for (const Entry& entry : entries) {
    const std::string hash = entry.hash();
    for (const Json& line : entry.verifications) there.insert(hash + line_hash(line));
    if (!entry.withdrawn.is_null()) there.insert(hash + line_hash(entry.withdrawn));
    if (vouched.lines.count(hash) > 0 && entry.vouched.empty())
      checked.problems.push_back(fmt::format(
          vouched.entries.count(hash) > 0 ? "{}: entry.json is not the one that {} has the hash of"
                                          : "{}: {} has no hash of its entry.json; lgabench leaderboard vouch adds it",
          entry.place().string(), vouched_entries_file));
  }
  for (const auto& [entry, lines] : vouched.lines)
    for (const std::string& line : lines)
      if (there.count(entry + line) == 0)
        checked.problems.push_back(
            fmt::format("{}: /{}: no entry of this hash has the line {}", vouched_file, entry, line));
  for (const auto& [entry, ignored] : vouched.entries)
    if (vouched.lines.count(entry) == 0)
      checked.problems.push_back(
          fmt::format("{}: /{}: no line of this entry is vouched for", vouched_entries_file, entry));
}

// Instructions are inferred for entries alone that do not record them.
void expect_inferred(const std::vector<Entry>& entries, const Vouched& vouched, Checked& checked) {
  std::set<std::string> unknown;
  for (const Entry& entry : entries)
    if (const Processor processor = entry.processor(); processor.inferred || processor.instructions.empty())
      unknown.insert(entry.id());
  for (const auto& [id, ignored] : vouched.instructions)
    if (unknown.count(id) == 0)
      checked.problems.push_back(
          fmt::format("{}: /{}: no entry of this id whose record lacks its instructions", instructions_file, id));
}

}  // namespace

Checked check(const fs::path& board, const CheckOptions& options) {
  Checked checked;
  const bool is_request = !options.against.empty();
  Files before;
  if (is_request) before = files_at(options.against, board);
  std::vector<Entry> entries;
  try {
    const Vouched vouched = read_vouched(board);
    const std::vector<fs::path> directories = entry_directories(board);
    for (const fs::path& directory : directories) {
      ++checked.entries;
      try {
        entries.push_back(read_entry(board, directory, &vouched));
        expect_answers(board, entries.back(), checked);
        if (options.installed) expect_installed(entries.back(), *options.installed, checked);
      } catch (const InputError& e) {
        checked.problems.emplace_back(e.what());
      }
      if (options.on_progress) options.on_progress("read", checked.entries, directories.size(), "entries");
    }
    expect_vouched(entries, vouched, checked);
    if (entries.size() == checked.entries) expect_inferred(entries, vouched, checked);
    if (entries.size() == checked.entries) {
      expect_no_other_answers(board, entries, is_request, checked);
      for (std::string& problem : problems_of_superseded(board, entries))
        checked.problems.push_back(std::move(problem));
      for (std::string& problem : problems_of_scenes(board, read_scenes(board, entries)))
        checked.problems.push_back(std::move(problem));
    }
  } catch (const InputError& e) {  // something else than directories, or vouched.json is not as it should be
    checked.problems.emplace_back(e.what());
  }
  expect_nothing_else(board, entries, is_request, checked);
  expect_same_scenes(entries, checked);
  if (checked.problems.empty()) expect_current(board, entries, options, checked);
  if (!is_request) return checked;
  compare_with(before, board, entries, options, checked);
  if (checked.problems.empty()) expect_frames(board, entries, before, checked);
  return checked;
}

}  // namespace lgabench::leaderboard
