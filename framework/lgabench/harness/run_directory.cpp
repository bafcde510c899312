#include <lgabench/harness/run_directory.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/run_layout.hpp>

namespace lgabench {
namespace {

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw InputError(fmt::format("{}: cannot be made: {}", path.string(), error.message()));
}

void remove_tree(const fs::path& path) {
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

bool other_programs(const Json& there, const Json& wanted) {
  const auto differs = [&](const char* member) { return there.value(member, Json()) != wanted.value(member, Json()); };
  return differs("build") || differs("plugins");
}

}  // namespace

Cell recorded_cell(const fs::path& directory) {
  const fs::path file = directory / "cell.json";
  return read_cell(read_json(file, Links::refused), file.string());
}

double recorded_seconds(const fs::path& directory) {
  const fs::path file = directory / "timing.json";
  const Json timing = read_json(file, Links::refused);
  return JsonReader(timing, file.string()).at("total_s").number();
}

std::string difference(const Json& there, const Json& wanted) {
  Json before = there.value("request", Json::object());
  const Json now = wanted.value("request", Json::object());
  if (!before.is_object()) before = Json::object();
  for (const auto& item : now.items())
    if (before.value(item.key(), Json()) != item.value())
      return fmt::format("{} {} there, {} wanted", item.key(), canonical(before.value(item.key(), Json())),
                         canonical(item.value()));
  return "same settings, other data or versions";
}

bool same_cells(const std::string& version, const std::string& other) {
  return version.substr(0, version.rfind('.')) == other.substr(0, other.rfind('.'));
}

CellState cell_state(const fs::path& cell, const std::string& key, const Json& build) {
  CellState state;
  std::error_code not_there;
  if (!fs::exists(cell, not_there)) return state;
  const auto not_its_own = [&](const fs::path& file) {
    state.why = fmt::format("{} does not have the bytes that were written", file.string());
    return state;
  };
  try {
    expect_plain_entries(cell);
    const Json status = read_json(cell / "status.json", Links::refused);
    const JsonReader reader(status, (cell / "status.json").string());
    if (reader.at("state").string() != "ok") {
      state.failed = true;
      state.why = "failed: " + reader.at("reason").string();
      return state;
    }
    for (const char* name : result_files) reader.at("files").at(name).string();
    reader.at("files").at("timing.json").string();
    if (const fs::path changed = changed_file(cell, reader); !changed.empty()) return not_its_own(changed);
    if (sha256(canonical(read_json(cell / "cell.json"))).substr(0, key.size()) != key)
      return not_its_own(cell / "cell.json");
    const Json& there = reader.at("build").json();
    for (const auto& file : build.items())
      if (there.value(file.key(), Json()) != file.value()) {
        state.other_build = true;
        state.why = fmt::format("computed by another build ({} differs)", file.key());
        return state;
      }
    state.build = there;
    state.complete = true;
  } catch (const InputError& e) {
    state.why = e.what();
  } catch (const Json::exception& e) {  // a member of another type
    state.why = fmt::format("{}: {}", (cell / "status.json").string(), e.what());
  }
  return state;
}

Json build_hashes(const PluginInfo& engine, const PluginInfo* method) {
  static const Json programs = [] {
    const fs::path bin = program_directory();
    Json hashes;
    for (const char* name : {"lgabench-worker", "lgabench-method"}) hashes[name] = sha256_file(bin / name);
    std::vector<std::string> libraries{"liblgabench_core.so", "liblgabench_learning.so"};
    for (const std::string& id : environment_ids()) libraries.push_back(fmt::format("liblgabench_env_{}.so", id));
    for (const std::string& name : libraries) hashes[name] = sha256_file(bin.parent_path() / "lib" / name);
    return hashes;
  }();
  Json build = programs;
  build["engine"] = engine.sha256;
  if (method) build["method"] = method->sha256;
  if (method && !method->python.is_null()) build["python"] = canonical(method->python.at("versions"));
  return build;
}

bool is_unconfined(const fs::path& run) {
  const fs::path record = run / "run.json";
  if (!fs::exists(record)) return false;
  const Json json = read_json(record, Links::refused);
  return json.is_object() && json.value("confinement", Json()) == unconfined_run;
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
        other.compare(prefix.size() + hash, suffix.size(), suffix) != 0 || !fs::exists(entry.path() / "run.json"))
      continue;
    try {
      const Json run = read_json(entry.path() / "run.json", Links::refused);
      const std::string started = run.at("started");
      if (run.at("request") == request && (last.empty() || started > last_started))
        last = entry.path(), last_started = started;
    } catch (const std::exception&) {  // no run of ours
    }
  }
  return last;
}

RunDirectory::RunDirectory(const fs::path& path, const Json& run, Existing existing) : path_(path) {
  canonical(run);                                           // what is no UTF-8 is refused before anything is made
  if (existing != Existing::fresh) expect_plain_run(path);  // which removes a link, and never what it leads to
  const bool was_there = has_content(path);
  make_directory(path);
  lock_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  try {
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0)
      throw InputError(fmt::format("{}: another run is writing into it", path.string()));
    const fs::path record = path / "run.json";
    Json there = run;
    if (was_there && !fs::exists(record))
      throw InputError(fmt::format("{}: not empty and not a run (no run.json); nothing was written", path.string()));
    if (was_there && existing == Existing::fresh) {
      for (const char* name : {"cells", "answers", "summary.json", "summary.csv", "claims.json", "report.md",
                               "report.html", "figures", "tables", "episodes.csv", "run.json"})
        remove_tree(path / name);
    } else if (was_there) {
      there = read_json(record, Links::refused);
      const auto version = [](const Json& json) {
        const Json said = json.is_object() ? json.value("version", Json()) : Json();
        return said.is_string() ? said.get<std::string>() : std::string();
      };
      if (!same_cells(version(there), version(run)))
        throw InputError(fmt::format(
            "{}: a run of lgabench {}, whose cells {} cannot go on with; choose another --out, or --fresh to "
            "drop it",
            path.string(), version(there), version(run)));
      if (!there.is_object() || there.value("cells", Json()) != run.at("cells"))
        throw InputError(fmt::format("{}: holds another run ({}); choose another --out, or --fresh to drop it",
                                     path.string(), difference(there, run)));
    }
    // What was half-written when a run was killed goes. run.json comes before all else: it makes the directory a run.
    for (const fs::path& directory : {path, path / "answers", path / "figures", path / "tables"})
      remove_temporaries(directory);
    if (!fs::exists(record) || (existing == Existing::resume && other_programs(there, run)))
      write_file(record, run.dump(1) + '\n');
    make_directory(path / "cells");
    for (const auto& entry : fs::directory_iterator(path / "cells"))
      if (entry.path().filename().string()[0] == '.') remove_tree(entry.path());
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
  remove_tree(directory);
  make_directory(directory);
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
  remove_tree(old);
  remove_tree(made);
}

void RunDirectory::amend(const std::string& member, const Json& value) const {
  Json record = read_json(path_ / "run.json", Links::refused);
  if (record.value(member, Json()) == value) return;
  record[member] = value;
  write_file(path_ / "run.json", record.dump(1) + '\n');
}

void RunDirectory::sync() const { sync_directory(path_ / "cells"); }

fs::path RunDirectory::cell(const std::string& key) const {
  if (!is_cell_key(key)) throw InputError(fmt::format("{}: \"{}\" is no cell's key", path_.string(), key));
  return path_ / "cells" / key;
}

}  // namespace lgabench
