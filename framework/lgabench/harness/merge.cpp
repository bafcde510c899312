#include <lgabench/harness/merge.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/file_lock.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/plain_directory.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/answers.hpp>
#include <lgabench/harness/run_directory.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

// Lists among a run's settings that another part may add to.
constexpr std::array<std::string_view, 9> grid_lists{
    "methods", "scenarios", "layouts", "engines", "demonstrations", "seeds", "selection_errors", "names", "segments"};

// A run to read from, which nobody writes into meanwhile.
class RunPart {
 public:
  explicit RunPart(const fs::path& path) : path_(path), record_(read_run_record(path)), programs_(record_.programs()) {
    expect_plain_run(path);
    lock_ = Descriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (lock_.fd < 0) throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
    if (!try_lock(lock_.fd, Lock::shared, path))
      throw InputError(fmt::format("{}: a run is writing into it", path.string()));
  }

  const fs::path& path() const { return path_; }
  const RunRecord& record() const { return record_; }
  const Json& programs() const { return programs_; }
  fs::path cell(const std::string& key) const { return path_ / "cells" / key; }

 private:
  fs::path path_;
  RunRecord record_;
  Json programs_;
  Descriptor lock_;
};

[[noreturn]] void refuse(const RunPart& first, const RunPart& other, const std::string& what) {
  throw InputError(
      fmt::format("{} and {} are not parts of one run: {}", first.path().string(), other.path().string(), what));
}

// The programs that both name are the same; a part may lack another part's plugins.
void expect_same_programs(const RunPart& first, const RunPart& other) {
  const std::string &version = first.record().version, &other_version = other.record().version;
  if (!same_cells(version, other_version))
    refuse(first, other, fmt::format("one is of lgabench {}, one of {}", version, other_version));
  for (const auto& [program, hash] : first.programs().items())
    if (other.programs().value(program, hash) != hash) refuse(first, other, "different builds of " + program);
}

// Adds to a list of `all` what `more` has beyond it.
void unite(Json& all, const Json& more) {
  std::set<Json> there(all.begin(), all.end());
  for (const Json& item : more)
    if (there.insert(item).second) all.push_back(item);
}

bool asks_nobody(const Json& request) { return request.value("answers", Json()) == to_string(NoAnswers()); }

// What `all` is with the cells, plugins and settings of `more`: another method, seed or number of demonstrations, with
// nothing else in the settings changed.
void unite(RunRecord& all, const RunPart& first, const RunPart& part) {
  RunRecord more = part.record();
  if (all.cells == more.cells) return;
  const std::string differs = difference(all, more);
  // A run that makes no errors, and reads nothing, need not say so; rows that ask nobody go with any answers.
  for (auto [lacks, has] : {std::pair{&all.request, &more.request}, std::pair{&more.request, &all.request}}) {
    for (const auto& [member, none] : {std::pair{"selection_errors", Json::object()},
                                       {"names", Json(Reading::simulator)},
                                       {"segments", Json(Reading::simulator)}})
      if (has->contains(member) && !lacks->contains(member)) (*lacks)[member] = Json::array({none});
    if (asks_nobody(*lacks)) (*lacks)["answers"] = has->value("answers", Json());
  }
  for (const auto& [member, value] : more.request.items()) {
    const bool may_grow = std::count(grid_lists.begin(), grid_lists.end(), member) > 0;
    Json& there = all.request[member];
    if (may_grow && there.is_array() && value.is_array())
      unite(there, value);
    else if (member == "references" && there.is_boolean() && value.is_boolean())
      there = there.get<bool>() || value.get<bool>();
    else if (there != value)
      refuse(first, part, "other cells: " + differs);
  }
  const std::set<std::string> there(all.cells.begin(), all.cells.end());
  std::copy_if(more.cells.begin(), more.cells.end(), std::back_inserter(all.cells),
               [&](const std::string& cell) { return there.count(cell) == 0; });
  const Json known = all.programs();
  std::copy_if(more.plugins.begin(), more.plugins.end(), std::back_inserter(all.plugins),
               [&](const RunRecord::Plugin& plugin) { return !known.contains(plugin.kind + " " + plugin.id); });
  for (const auto& [row, options] : more.settings.items()) all.settings[row] = options;
}

// What status.json says of a cell that the run's own programs computed.
Json build_of(const RunPart& part, const Cell& cell) {
  Json build = part.record().build;
  if (!cell.needs_axes()) build.erase(perturbation_library);
  if (!cell.reading.needs_library()) build.erase(seeing_library);
  const auto plugin = [&](const std::string& kind, const std::string& id) {
    const auto found = part.programs().find(kind + " " + id);
    if (found != part.programs().end()) build[kind] = *found;
  };
  plugin("engine", cell.engine);
  if (!cell.method.is_reference()) plugin("method", cell.method.id);
  for (const std::string& name : named_in_build(cell))
    if (const auto found = part.programs().find(name); found != part.programs().end()) build[name] = *found;
  return build;
}

// A part's cell, by its files.
struct Candidate {
  fs::path directory;
  Cell cell;  // of a state that is complete or failed
  CellState state;
};

Candidate candidate(const RunPart& part, const std::string& key) {
  Candidate found{part.cell(key), {}, {}};
  if (!fs::exists(found.directory)) return found;
  try {
    found.cell = recorded_cell(found.directory);
    found.state = cell_state(found.directory, key, build_of(part, found.cell));
  } catch (const InputError& e) {
    found.state.why = e.what();
  }
  return found;
}

void expect_same_results(const fs::path& one, const fs::path& other) {
  for (const char* file : result_files)
    if (read_file(one / file) != read_file(other / file))
      throw InputError(
          fmt::format("{} and {}: different results of one cell: {} differs", one.string(), other.string(), file));
}

// The cell to take: a finished one, else a failed one, else none; `left_out`: the keys of those that are not as they
// were written.
std::optional<Candidate> best(const std::vector<RunPart>& parts, const std::string& key,
                              std::set<std::string>& left_out) {
  std::optional<Candidate> finished, failed;
  for (const RunPart& part : parts) {
    Candidate here = candidate(part, key);
    if (here.state.complete) {
      if (finished)
        expect_same_results(finished->directory, here.directory);
      else
        finished = std::move(here);
    } else if (here.state.failed) {
      if (!failed) failed = std::move(here);
    } else if (!here.state.why.empty()) {
      to_stderr("{}: {}; left out\n", here.directory.string(), here.state.why);
      left_out.insert(key);
    }
  }
  return finished ? finished : failed;
}

// Runs name their rows apart: two that a run has alone of their method have its id, whatever their options. `measured`:
// the cells before this one, by kind and title.
void expect_one_of_each(const Candidate& here, const Json& settings, std::map<std::string, fs::path>& measured) {
  const Cell& cell = here.cell;
  const auto [before, is_new] = measured.try_emplace(cell.method.kind + " " + cell.title(), here.directory);
  if (is_new) return;
  const Json one = to_json(recorded_cell(before->second)), other = to_json(cell);
  const auto differing = [](const Json& a, const Json& b) {
    std::vector<std::string> members;
    for (const auto& [member, value] : b.items())
      if (!a.is_object() || a.value(member, Json()) != value) members.push_back(member);
    return members;
  };
  const std::vector<std::string> options = differing(one["method"]["options"], cell.method.options);
  std::string say = fmt::format("{} and {} both are {}, and differ in {}", before->second.string(),
                                here.directory.string(), cell.title(), fmt::join(differing(one, other), ", "));
  if (!options.empty())
    say += fmt::format(
        " ({}): a run names the only row of a method by its id; give these rows to one run, --methods {}, "
        "whose names tell them apart",
        fmt::join(options, ", "), fmt::join(JsonReader(settings, "run.json: /request").at("methods").strings(), ","));
  throw InputError(say);
}

// What a method in Python is made of beside its file (interpreter, packages, modules) stands with its cells alone.
// `known`: of the cells before this one, by method, and where.
void expect_one_python(const Candidate& here, std::map<std::string, std::pair<Json, fs::path>>& known) {
  if (!here.state.build.contains("python")) return;
  const std::string& method = here.cell.method.id;
  const auto& [python, first] = known.try_emplace(method, here.state.build.at("python"), here.directory).first->second;
  if (python != here.state.build.at("python"))
    throw InputError(
        fmt::format("{} and {}: different builds of method {}: their interpreter, packages or modules differ",
                    first.string(), here.directory.string(), method));
}

// A feature space of one's own is a file, which may change between two runs. `known`: hashes of the cells before this
// one, by space, and where.
void expect_one_space(const Candidate& here, std::map<std::string, std::pair<Json, fs::path>>& known) {
  const Json space = here.cell.scenario->value("feature_space", Json()),
             hash = here.cell.data.value("feature_space", Json());
  const auto& [first_hash, first] = known.try_emplace(space.dump(), hash, here.directory).first->second;
  if (first_hash != hash)
    throw InputError(fmt::format("{} and {}: different files of the feature space {}", first.string(),
                                 here.directory.string(), space.dump()));
}

bool asks_live(const RunPart& part) {
  const Json answers = part.record().request.value("answers", Json());
  return answers.is_string() && std::holds_alternative<LiveAnswers>(read_answer_source(answers));
}

// The part that keeps every reply, where parts asked a model live, on one cassette; else the first that asks.
const RunPart& with_all_replies(const std::vector<RunPart>& parts) {
  const auto asking =
      std::find_if(parts.begin(), parts.end(), [](const RunPart& part) { return !asks_nobody(part.record().request); });
  const RunPart* all = asking == parts.end() ? &parts.front() : &*asking;
  if (!asks_live(*all)) return *all;
  const auto bytes = [](const RunPart& part) {
    const auto kept = kept_replies(part.path());
    return kept ? fs::file_size(kept->path) : 0;
  };
  for (const RunPart& part : parts)
    if (bytes(part) > bytes(*all)) all = &part;
  for (const RunPart& part : parts)
    if (bytes(part) > 0 && !holds_lines(kept_replies(all->path())->path, kept_replies(part.path())->path))
      throw InputError(fmt::format(
          "{} and {}: a language model was asked the same questions for two cassettes; fill one with lgabench "
          "select --suite, and give it to the parts as --answers cassette:FILE",
          all->path().string(), part.path().string()));
  return *all;
}

// The record of all parts' cells together, which has the first part's machine.
RunRecord merged_record(RunRecord all, const std::vector<RunPart>& parts, const Json& answers,
                        const std::string& command) {
  all.shard.reset();
  all.answers = answers;
  all.command = command;
  all.merged = Json::array();
  for (const RunPart& part : parts) {
    const RunRecord& one = part.record();
    all.merged.push_back({{"command", one.command}, {"machine", one.machine}, {"started", one.started}});
    all.started = std::min(all.started, one.started);
    if (one.confinement == unconfined_run) all.confinement = unconfined_run;
    if (!owe_same_bits(one.processor(), all.processor(), true))
      to_stderr("{}: computed on {}, {} on {}; the merged run may not be bit-identical to one machine's\n",
                part.path().string(), to_string(one.processor()), parts.front().path().string(),
                to_string(all.processor()));
  }
  return all;
}

// What a cell is documented to hold and nothing else.
void copy_cell(const fs::path& from, const fs::path& to) {
  const auto copy = [&](const std::string& name) {
    write_file(to / name, read_file(from / name, Links::refused), Sync::later);
  };
  const PlainDirectory files(from / "files");
  for (const char* name : cell_files)
    if (fs::exists(from / name)) copy(name);
  for (const char* name : {cell_file::shown, cell_file::policy, cell_file::perturbed})
    if (fs::exists(from / name)) copy(name);
  for (const std::string& name : files.kept_names())
    write_file(to / "files" / name, files.read_file(name), Sync::later);
  copy(cell_file::status);
}

}  // namespace

MergeOutcome merge_runs(const fs::path& out, const std::vector<fs::path>& runs, const std::string& command) {
  std::vector<RunPart> parts;
  for (const fs::path& run : runs) {
    std::error_code not_there;
    if (fs::equivalent(run, out, not_there))
      throw InputError(fmt::format("{}: both an input and OUT; choose another OUT", out.string()));
    parts.emplace_back(run);
    for (const RunPart& part : parts)
      expect_same_programs(part, parts.back());  // the first may lack what two others have
  }
  RunRecord all = parts.front().record();
  for (const RunPart& part : parts) unite(all, parts.front(), part);
  const bool of_several_runs = all.cells != parts.front().record().cells;
  std::set<std::string> left_out;
  std::map<std::string, fs::path> chosen, measured;
  std::map<std::string, std::pair<Json, fs::path>> pythons, spaces;
  for (const std::string& key : all.cells) {
    const std::optional<Candidate> from = best(parts, key, left_out);
    if (!from) continue;
    expect_one_python(*from, pythons);
    expect_one_space(*from, spaces);
    if (of_several_runs) expect_one_of_each(*from, all.request, measured);
    chosen[key] = from->directory;
  }

  const RunPart& replies = with_all_replies(parts);
  const RunRecord record = merged_record(std::move(all), parts, replies.record().answers, command);
  const bool unconfined = is_unconfined(out);  // cells of an earlier merge stay
  const RunDirectory directory(out, record, Existing::resume);
  directory.amend([&](RunRecord& run) {
    run.command = record.command;
    run.started = record.started;
    run.answers = record.answers;
    run.merged = record.merged;
    run.confinement = unconfined ? unconfined_run : record.confinement;
  });
  for (const RunPart& part : parts)
    if (!asks_live(part) || &part == &replies) keep_answers(kept_answers(part.path()), out);
  std::size_t copied = 0;
  auto last_line = std::chrono::steady_clock::now();
  for (const auto& [key, from] : chosen) {
    copy_cell(from, directory.scratch(key));
    ++copied;
    if (const auto now = std::chrono::steady_clock::now(); now - last_line > std::chrono::seconds(2)) {
      last_line = now;
      to_stderr("{} of {} cells copied\n", copied, chosen.size());
    }
  }
  sync_file_system(directory.path());  // before the first of them gets its name: a name stands for what is on the disk
  for (const auto& cell : chosen) directory.keep(cell.first);
  directory.sync();
  MergeOutcome outcome;
  for (const std::string& key : record.cells)
    if (const fs::path cell = directory.cell(key); has_status(cell))
      ++(read_cell_status(cell).failed ? outcome.failed : outcome.finished);
    else
      ++(left_out.count(key) ? outcome.left_out : outcome.missing);
  return outcome;
}

}  // namespace lgabench
