// A run's directory: what is complete in it, and how a finished cell gets in. The only state of a run.
#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/cell.hpp>
#include <lgabench/record/cell_status.hpp>
#include <lgabench/record/run_record.hpp>

namespace lgabench {

/// SHA-256 of one of lgabench's own libraries.
std::string library_hash(const std::string& name);

/// SHA-256 of what computes a cell: the worker, the framework's libraries, "engine" and "method" (the plugins' files;
/// no "method" for a reference row); the library of perturbations where the cell needs its `axes`.
Json build_hashes(const std::optional<PluginInfo>& engine, const PluginInfo* method, bool axes);

/// What the files of the cell's environment, of its axes and of its perceiver are called there where they are plugins':
/// "environment reach", "perturbation fog", "perceiver mine".
std::vector<std::string> named_in_build(const Cell& cell);
/// Adds such a plugin and, of one in Python, what it was described with.
void add_named(Json& build, const PluginInfo& plugin);

/// The run of those settings, started last, in a directory beside `wanted` whose name differs from its in the hash
/// before `suffix` alone: another build's. "" if there is none.
fs::path earlier_run(const fs::path& wanted, const std::string& suffix, const Json& request);

/// Whether the run in that directory is an unconfined one, as are cells whose run.json is lost; false where there is
/// none. @throws InputError for a run.json that is none.
bool is_unconfined(const fs::path& run);

/// What to do with a directory that is not empty.
enum class Existing {
  same,    // go on with a run of the same cells and the same build; refuse any other
  resume,  // likewise, but cells of another build are computed again, and a run.json that is lost is written again
  fresh    // drop the run that is there; refuse a directory that holds none
};

/// Holds a lock on the directory as long as it lives. One thread.
class RunDirectory {
 public:
  /// Makes the directory or takes up the run in it: checks that it is a run of the same cells, removes what was left
  /// half-written, writes run.json (anew where a run of another build is resumed).
  /// @throws InputError, with nothing changed, if the directory holds something else or is in use.
  RunDirectory(const fs::path& path, const RunRecord& run, Existing existing);
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const fs::path& path() const { return path_; }

  /// Where the cell is, or will be. @throws InputError for what is no key: it could lead anywhere.
  fs::path cell(const std::string& key) const;
  CellState state(const std::string& key, const Json& build) const { return cell_state(cell(key), key, build); }

  /// A new empty directory for a worker to write into; a later start removes it unless kept.
  fs::path scratch(const std::string& key) const;
  /// Moves the scratch directory to where finished cells are, in place of an earlier attempt. Atomic (in place of an
  /// earlier attempt only where the file system can exchange two names).
  void keep(const std::string& key) const;
  /// Writes run.json again as `change` makes it, if that is another one.
  void amend(const std::function<void(RunRecord&)>& change) const;
  /// fsync of what was kept since.
  void sync() const;

 private:
  fs::path hidden(const std::string& key, const char* what) const;

  fs::path path_;
  int lock_ = -1;
};

}  // namespace lgabench
