#include <lgabench/leaderboard/check.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/recompute.hpp>

namespace lgabench::leaderboard {
namespace {

// What git prints, in the board's directory; none where it fails.
std::optional<std::string> git(const fs::path& board, std::vector<std::string> words) {
  const Scratch scratch("git");
  const fs::path out = scratch.path / "out";
  const int file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600),
            null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  words.insert(words.begin(), {"git", "-C", board.string()});
  const int status = wait_for(start_process({words, environment_with({"LC_ALL=C"}), {{file, 1}, {null, 2}}}));
  ::close(file);
  ::close(null);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return read_file(out);
}

bool begins_with(const Json& list, const Json& first) {
  return list.size() >= first.size() && std::equal(first.begin(), first.end(), list.begin());
}

// entry.json may gain evidence and be withdrawn; nothing else in it changes.
std::string changed_entry(const std::string& before, const std::string& now) {
  const Json there = json_or_null(before), here = json_or_null(now);
  if (!there.is_object() || !here.is_object()) return "is no JSON object any more";
  for (const auto& [member, value] : there.items()) {
    const Json other = here.value(member, Json());
    if (member == "evidence" ? !begins_with(other, value) : other != value) return fmt::format("/{} changed", member);
  }
  return "";
}

void compare_with(const fs::path& board, const CheckOptions& options, Checked& checked) {
  const std::string& revision = options.against;
  const auto changes = git(
      board, {"diff", "--name-status", "--no-renames", "--relative", "--end-of-options", revision, "--", "entries"});
  if (!changes)
    throw InputError(
        fmt::format("--against {}: expected a revision of git that {} has, and its history", revision, board.string()));
  for (const char* file : maintainers_files) {
    const std::string before = git(board, {"show", fmt::format("{}:./{}", revision, file)}).value_or("");
    const bool there = fs::exists(fs::symlink_status(board / file));
    if (!options.maintainer && (there ? read_file(board / file, Links::refused) : "") != before)
      checked.problems.push_back(
          fmt::format("{}: changed since {}: it is the maintainers' (--maintainer)", file, revision));
  }
  std::istringstream lines(*changes);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t tab = line.find('\t');
    if (tab == std::string::npos || line[0] == 'A') continue;
    const std::string file = line.substr(tab + 1), name = fs::path(file).filename();
    const auto complain = [&](const std::string& what) {
      checked.problems.push_back(fmt::format("{}: {} since {}", file, what, revision));
    };
    if (line[0] == 'D') {
      complain("is gone (leaderboard withdraw keeps the record)");
      continue;
    }
    const auto before = git(board, {"show", fmt::format("{}:./{}", revision, file)});
    const std::string now = read_file(board / file);
    if (name == "cells.jsonl")
      complain("an outcome or a cell changed");
    else if (!before || (name == "verifications.jsonl" && now.rfind(*before, 0) != 0))
      complain("a verification changed");
    else if (const std::string what = name == "entry.json" ? changed_entry(*before, now) : ""; !what.empty())
      complain(what);
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

// Files of answers that no entry names: nobody would ever read them.
void expect_no_other_answers(const fs::path& board, const std::vector<Entry>& entries, Checked& checked) {
  std::set<fs::path> named;
  for (const Entry& entry : entries) named.insert(answers_file(entry.identity));
  std::error_code none_there;
  for (const auto& file : fs::directory_iterator(board / "answers", none_there)) {
    const fs::path kept = "answers" / file.path().filename();
    if (named.count(kept) == 0)
      checked.problems.push_back(fmt::format("{}: no entry is based on it; remove it", kept.string()));
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

void expect_current(const fs::path& board, const std::vector<Entry>& entries, const std::vector<fs::path>& documents,
                    Checked& checked) {
  try {
    for (const auto& [file, bytes] : made_files(board, entries, documents))
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

// A page may be as it was at the revision, or as this build writes it; whoever opens one runs its scripts. No other
// file lies beside the pages.
void expect_frames(const fs::path& board, const std::vector<Entry>& entries, const std::string& revision,
                   Checked& checked) {
  const std::map<fs::path, std::string> made = made_files(board, entries, {});
  for (const auto& item : fs::directory_iterator(board)) {
    const fs::path file = item.path(), name = file.filename();
    if (name == "entries" || name == "answers" || name == vouched_file || name == labels_file || name == tracks_file ||
        name.string()[0] == '.')
      continue;
    const auto before = git(board, {"show", fmt::format("{}:./{}", revision, name.string())});
    const auto ours = made.find(file);
    const auto complain = [&](const char* what) {
      checked.problems.push_back(fmt::format("{}: {}", name.string(), what));
    };
    if (ours == made.end() && !before) {
      complain("no file of a board");
    } else if (file.extension() == ".html" && ours != made.end()) {
      const std::string now = frame(read_file(file, Links::refused));
      if (now != frame(ours->second) && now != frame(before.value_or("")))
        complain("changed outside its tables; lgabench leaderboard build writes it");
    }
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
    for (const Json& line : entry.verifications) there.insert(entry.hash() + line_hash(line));
    if (!entry.withdrawn.is_null()) there.insert(entry.hash() + line_hash(entry.withdrawn));
  }
  for (const auto& [entry, lines] : vouched)
    for (const std::string& line : lines)
      if (there.count(entry + line) == 0)
        checked.problems.push_back(
            fmt::format("{}: /{}: no entry of this hash has the line {}", vouched_file, entry, line));
}

}  // namespace

Checked check(const fs::path& board, const CheckOptions& options) {
  Checked checked;
  std::vector<Entry> entries;
  try {
    const Vouched vouched = read_vouched(board);
    for (const fs::path& directory : entry_directories(board)) {
      ++checked.entries;
      try {
        entries.push_back(read_entry(board, directory, vouched));
        expect_answers(board, entries.back(), checked);
        if (options.installed) expect_installed(entries.back(), *options.installed, checked);
      } catch (const InputError& e) {
        checked.problems.emplace_back(e.what());
      }
    }
    expect_vouched(entries, vouched, checked);
    if (entries.size() == checked.entries) expect_no_other_answers(board, entries, checked);
  } catch (const InputError& e) {  // something else than directories, or vouched.json is not as it should be
    checked.problems.emplace_back(e.what());
  }
  expect_same_scenes(entries, checked);
  if (checked.problems.empty()) expect_current(board, entries, options.documents, checked);
  if (options.against.empty()) return checked;
  compare_with(board, options, checked);
  if (checked.problems.empty()) expect_frames(board, entries, options.against, checked);
  return checked;
}

}  // namespace lgabench::leaderboard
