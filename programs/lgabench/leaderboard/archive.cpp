#include <lgabench/leaderboard/archive.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/filled.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {
namespace {

constexpr const char* name = "lgabench-leaderboard";

// When the newest entry was computed, as run.json says it: "2026-01-01T00:00:00Z".
std::string newest(const std::vector<Entry>& entries) {
  std::string last;
  for (const Entry& entry : entries)
    for (const Json& run : entry.evidence) last = std::max(last, run.at("started").get<std::string>());
  return last;
}

void copy_tree(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy(from, to, fs::copy_options::recursive, error);
  if (error) throw InputError(fmt::format("{}: cannot be copied: {}", from.string(), error.message()));
}

void pack(const fs::path& directory, const std::string& when, const fs::path& out) {
  const std::vector<std::string> words{"tar",
                                       "--create",
                                       "--file=" + out.string(),
                                       "--directory=" + directory.string(),
                                       "--use-compress-program=gzip -9n",
                                       "--format=gnu",
                                       "--sort=name",
                                       "--mtime=" + when,
                                       "--owner=0",
                                       "--group=0",
                                       "--numeric-owner",
                                       "--mode=u=rwX,go=rX",
                                       name};
  if (wait_for(start_process({words, environment_with({"LC_ALL=C", "TZ=UTC"})})) != 0)
    throw InputError(fmt::format("{}: cannot be packed: expected GNU tar and gzip", out.string()));
}

}  // namespace

void write_archive(const fs::path& board, const fs::path& out) {
  const std::vector<Entry> entries = read_entries(board);
  if (entries.empty()) throw InputError(fmt::format("{}: no entry to pack", board.string()));
  const std::string when = newest(entries);
  const Scratch scratch("archive");
  const fs::path root = scratch.path / name, data = data_directory();
  write_file(root / "README.md",
             filled(read_file(data / "archive/README.md"), {{"{{entries}}", std::to_string(entries.size())},
                                                            {"{{when}}", when.substr(0, when.find('T'))},
                                                            {"{{version}}", LGABENCH_VERSION}}));
  for (const char* file : {"CITATION.cff", "LICENSE"}) write_file(root / file, read_file(data / "archive" / file));
  copy_tree(data / "formats", root / "formats");
  copy_tree(board, root / "leaderboard");
  pack(scratch.path, when, scratch.path / "packed");
  write_file(out, read_file(scratch.path / "packed"));
}

}  // namespace lgabench::leaderboard
