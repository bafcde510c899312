#include <lgabench/harness/run_directory.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>

#include <lgabench/core/directories.hpp>
#include <lgabench/core/file_lock.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

void remove_or_throw(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) throw InputError(fmt::format("{}: cannot be removed: {}", path.string(), error.message()));
}

// Whether there is anything besides what a run that was killed before its run.json left behind.
bool has_content(const fs::path& directory) {
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(directory, none_there))
    if (!is_temporary(entry.path())) return true;
  return false;
}

// Whether cells lie there, by their names; of them one of `wanted`, unless that is empty.
bool holds_cells(const fs::path& directory, const std::vector<std::string>& wanted = {}) {
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(directory / "cells", none_there))
    if (const std::string name = entry.path().filename().string();
        wanted.empty() ? is_cell_key(name) : std::count(wanted.begin(), wanted.end(), name) > 0)
      return true;
  return false;
}

// What lies there is a run, or one that lost its run.json and is resumed.
void expect_taken_up(const fs::path& path, const RunRecord& run, Existing existing) {
  if (is_run(path) || (existing == Existing::resume && holds_cells(path, run.cells))) return;
  throw InputError(fmt::format(
      holds_cells(path) ? "{}: cells without their run.json; repeat the command that computed them, with --resume, "
                          "to write it"
                        : "{}: not empty and not a run (no run.json); nothing was written",
      path.string()));
}

}  // namespace

std::string library_hash(const std::string& name) {
  static std::map<std::string, std::string> hashes;
  std::string& hash = hashes[name];
  if (hash.empty()) hash = sha256_file(program_directory().parent_path() / "lib" / name);
  return hash;
}

Json build_hashes(const std::optional<PluginInfo>& engine, const PluginInfo* method, bool axes) {
  static const Json programs = [] {
    const fs::path bin = program_directory();
    Json hashes;
    for (const char* name : {"lgabench-worker", "lgabench-method"}) hashes[name] = sha256_file(bin / name);
    for (const char* name : {"liblgabench_core.so", "liblgabench_learning.so"})
      hashes[name] = sha256_file(bin.parent_path() / "lib" / name);
    return hashes;
  }();
  Json build = programs;
  if (axes) build[perturbation_library] = library_hash(perturbation_library);
  if (engine) build["engine"] = engine->sha256;
  if (method) build["method"] = method->sha256;
  if (method && !method->python.is_null()) build["python"] = canonical(method->python.at("versions"));
  return build;
}

std::vector<std::string> named_in_build(const Cell& cell) {
  std::vector<std::string> names;
  if (cell.has_plugin_environment()) names.push_back(cell.environment_in_build());
  for (const std::string& id : cell.plugin_axes()) names.push_back("perturbation " + id);
  if (const std::string id = cell.reading.plugin(); !id.empty()) names.push_back("perceiver " + id);
  return names;
}

void add_named(Json& build, const PluginInfo& plugin) {
  const std::string name = plugin.kind + " " + plugin.id;
  build[name] = plugin.sha256;
  if (plugin.python.is_null()) return;
  Json versions = build.contains("python") ? parse_json(build["python"].get<std::string>(), "build") : Json::object();
  versions[name] = plugin.python.at("versions");
  build["python"] = canonical(versions);
}

bool is_unconfined(const fs::path& run) {
  return is_run(run) ? read_run_record(run).confinement == unconfined_run : holds_cells(run);
}

fs::path earlier_run(const fs::path& wanted, const std::string& suffix, const Json& request) {
  constexpr std::size_t hash = 8;
  const std::string name = wanted.filename().string(), prefix = name.substr(0, name.size() - suffix.size() - hash);
  fs::path last;
  std::string last_started;
  std::error_code none_to_list;
  for (const auto& entry : fs::directory_iterator(wanted.parent_path(), none_to_list)) {
    const std::string other = entry.path().filename().string();
    if (other.size() != name.size() || other.compare(0, prefix.size(), prefix) != 0 ||
        other.compare(prefix.size() + hash, suffix.size(), suffix) != 0 || !is_run(entry.path()))
      continue;
    try {
      const RunRecord run = read_run_record(entry.path());
      if (run.request == request && (last.empty() || run.started > last_started)) {
        last = entry.path();
        last_started = run.started;
      }
    } catch (const InputError&) {  // no run of ours
    }
  }
  return last;
}

RunDirectory::RunDirectory(const fs::path& path, const RunRecord& run, Existing existing) : path_(path) {
  canonical(to_json(run));                                  // what is no UTF-8 is refused before anything is made
  if (existing != Existing::fresh) expect_plain_run(path);  // which removes a link, and never what it leads to
  const bool was_there = has_content(path);
  make_directories(path);
  lock_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  try {
    if (!try_lock(lock_, Lock::exclusive, path))
      throw InputError(fmt::format("{}: another run is writing into it", path.string()));
    RunRecord there = run;
    if (was_there) expect_taken_up(path, run, existing);
    if (was_there && existing == Existing::fresh) {
      for (const char* name : run_entries) remove_or_throw(path / name);
    } else if (is_run(path)) {
      there = read_run_record(path);
      if (!same_cells(there.version, run.version))
        throw InputError(
            fmt::format("{}: a run of lgabench {}, which {} cannot resume; choose another --out, or --fresh to drop it",
                        path.string(), there.version, run.version));
      if (there.cells != run.cells)
        throw InputError(fmt::format("{}: holds another run ({}); choose another --out, or --fresh to drop it",
                                     path.string(), difference(there, run)));
    }
    // What was half-written when a run was killed goes. run.json comes before all else: it makes the directory a run.
    remove_temporaries(path);
    for (const char* name : run_directories) remove_temporaries(path / name);
    if (!is_run(path) || (existing == Existing::resume && there.programs() != run.programs()))
      write_run_record(path, run);
    make_directories(path / "cells");
    for (const auto& entry : fs::directory_iterator(path / "cells"))
      if (entry.path().filename().string()[0] == '.') remove_or_throw(entry.path());
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

RunDirectory::~RunDirectory() { ::close(lock_); }

fs::path RunDirectory::hidden(const std::string& key, const char* what) const {
  return path_ / "cells" / fmt::format(".{}.{}{}", key, ::getpid(), what);
}

fs::path RunDirectory::scratch(const std::string& key) const {
  const fs::path directory = hidden(key, "");
  remove_or_throw(directory);
  make_directories(directory);
  return directory;
}

void RunDirectory::keep(const std::string& key) const {
  const fs::path made = hidden(key, ""), old = hidden(key, ".old"), there = cell(key);
  std::error_code error;
  // Exchanged: between two renames a kill would lose both.
  if (::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, there.c_str(), RENAME_EXCHANGE) != 0) {
    if (fs::exists(there)) fs::rename(there, old, error);  // a file system that cannot exchange
    if (!error) fs::rename(made, there, error);
  }
  if (error) throw InputError(fmt::format("{}: cannot be written: {}", there.string(), error.message()));
  remove_or_throw(old);
  remove_or_throw(made);
}

void RunDirectory::amend(const std::function<void(RunRecord&)>& change) const {
  RunRecord record = read_run_record(path_);
  const Json before = to_json(record);
  change(record);
  if (to_json(record) != before) write_run_record(path_, record);
}

void RunDirectory::sync() const { sync_directory(path_ / "cells"); }

fs::path RunDirectory::cell(const std::string& key) const {
  if (!is_cell_key(key)) throw InputError(fmt::format("{}: \"{}\" is no cell's key", path_.string(), key));
  return path_ / "cells" / key;
}

}  // namespace lgabench
