#include <lgabench/harness/run_directory.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <lgabench/core/hash.hpp>

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

// Which setting of the two runs differs first; data and versions may differ where no setting does.
std::string difference(const Json& there, const Json& wanted) {
  const Json before = there.value("request", Json::object()), now = wanted.at("request");
  for (const auto& item : now.items())
    if (before.value(item.key(), Json()) != item.value())
      return fmt::format("{} {} there, {} wanted", item.key(), canonical(before.value(item.key(), Json())),
                         canonical(item.value()));
  return "same settings, other data or versions";
}

}  // namespace

Json build_hashes(const PluginInfo& engine, const PluginInfo* method) {
  static const Json programs = [] {
    const fs::path bin = program_directory();
    Json hashes{{"lgabench-worker", sha256_file(bin / "lgabench-worker")}};
    for (const char* name : {"liblgabench_core.so", "liblgabench_tabletop.so", "liblgabench_learning.so"})
      hashes[name] = sha256_file(bin.parent_path() / "lib" / name);
    return hashes;
  }();
  Json build = programs;
  build["engine"] = engine.sha256;
  if (method) build["method"] = method->sha256;
  return build;
}

RunDirectory::RunDirectory(const fs::path& path, const Json& run, Existing existing) : path_(path) {
  std::error_code error;
  const bool was_there = fs::exists(path, error) && !fs::is_empty(path, error);
  make_directory(path);
  lock_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  try {
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0)
      throw InputError(fmt::format("{}: another run is writing into it", path.string()));
    const fs::path record = path / "run.json";
    if (was_there && !fs::exists(record))
      throw InputError(fmt::format("{}: not empty and not a run (no run.json); nothing was written", path.string()));
    if (was_there && existing == Existing::fresh) {
      for (const char* name : {"cells", "summary.json", "summary.csv", "report.md", "report.html", "figures", "run.json"})
        remove_tree(path / name);
    } else if (was_there) {
      const Json there = read_json(record);
      if (!there.is_object() || there.value("cells", Json()) != run.at("cells"))
        throw InputError(fmt::format("{}: holds another run ({}); choose another --out, or --fresh to drop it",
                                     path.string(), difference(there, run)));
    }
    make_directory(path / "cells");
    for (const auto& entry : fs::directory_iterator(path / "cells"))
      if (entry.path().filename().string()[0] == '.') remove_tree(entry.path());  // half-written when a run was killed
    if (!fs::exists(record)) write_file(record, run.dump(1) + '\n');
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

RunDirectory::~RunDirectory() { ::close(lock_); }

RunDirectory::State RunDirectory::state(const std::string& key, const Json& build) const {
  const fs::path cell = path_ / "cells" / key;
  State state;
  if (!fs::exists(cell / "status.json")) return state;
  try {
    const Json status = read_json(cell / "status.json");
    const JsonReader reader(status, (cell / "status.json").string());
    if (reader.at("state").string() != "ok") {
      state.why = "failed: " + reader.at("reason").string();
      return state;
    }
    for (const auto& file : reader.at("files").json().items())
      if (sha256_file(cell / file.key()) != file.value()) {
        state.why = fmt::format("{} does not have the bytes that were written", (cell / file.key()).string());
        return state;
      }
    const Json& there = reader.at("build").json();
    for (const auto& file : build.items())
      if (there.value(file.key(), Json()) != file.value()) {
        state.other_build = true;
        state.why = fmt::format("computed by another build ({} differs)", file.key());
        return state;
      }
    state.complete = true;
  } catch (const InputError& e) {
    state.why = e.what();
  }
  return state;
}

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
  const fs::path cell = path_ / "cells" / key, old = hidden(key, ".old");
  std::error_code error;
  if (fs::exists(cell)) fs::rename(cell, old, error);
  if (!error) fs::rename(hidden(key, ""), cell, error);
  if (error) throw InputError(fmt::format("{}: cannot be written: {}", cell.string(), error.message()));
  remove_tree(old);
  sync_directory(path_ / "cells");
}

}  // namespace lgabench
