#include <lgabench/harness/merge.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>
#include <string_view>

#include <lgabench/core/run_layout.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/answers.hpp>
#include <lgabench/harness/run_directory.hpp>

namespace lgabench {
namespace {

// Lists among a run's settings that another part may add to.
constexpr std::array<std::string_view, 6> grid_lists{"methods", "scenarios",      "layouts",
                                                     "engines", "demonstrations", "seeds"};

// A run to read from, which nobody writes into meanwhile.
class Part {
 public:
  explicit Part(const fs::path& path) : path_(path), json_(read_json(path / "run.json", Links::refused)) {
    const JsonReader reader(json_, (path / "run.json").string());
    read_cell_keys(reader);
    expect_plain_run(path);
    reader.at("command").string();
    reader.at("version").string();
    reader.at("started").string();
    reader.at("machine").at("processor").string();
    for (const JsonReader& plugin : reader.at("plugins").elements())
      programs_[plugin.at("kind").string() + " " + plugin.at("id").string()] = plugin.at("sha256").string();
    if (!reader.at("build").json().is_object()) reader.at("build").fail("an object");
    for (const auto& file : reader.at("build").json().items()) programs_[file.key()] = file.value();
    lock_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0 || ::flock(lock_, LOCK_SH | LOCK_NB) != 0) {
      ::close(lock_);
      throw InputError(fmt::format("{}: a run is writing into it", path.string()));
    }
  }
  ~Part() {
    if (lock_ >= 0) ::close(lock_);
  }
  Part(Part&& other) noexcept
      : path_(std::move(other.path_)),
        json_(std::move(other.json_)),
        programs_(std::move(other.programs_)),
        lock_(std::exchange(other.lock_, -1)) {}
  Part& operator=(Part&&) = delete;

  const fs::path& path() const { return path_; }
  const Json& json() const { return json_; }
  const std::map<std::string, Json>& programs() const { return programs_; }
  fs::path cell(const std::string& key) const { return path_ / "cells" / key; }

 private:
  fs::path path_;
  Json json_;
  std::map<std::string, Json> programs_;  // file, or kind and id of a plugin -> sha256
  int lock_ = -1;
};

[[noreturn]] void refuse(const Part& first, const Part& other, const std::string& what) {
  throw InputError(
      fmt::format("{} and {} are not parts of one run: {}", first.path().string(), other.path().string(), what));
}

// The programs that both name are the same; a part may lack another part's plugins.
void expect_same_programs(const Part& first, const Part& other) {
  const std::string version = first.json().at("version"), other_version = other.json().at("version");
  if (!same_cells(version, other_version))
    refuse(first, other, fmt::format("one is of lgabench {}, one of {}", version, other_version));
  for (const auto& [program, hash] : first.programs())
    if (const auto there = other.programs().find(program); there != other.programs().end() && there->second != hash)
      refuse(first, other, "other builds of " + program);
}

// Adds to a list of `all` what `more` has beyond it.
void unite(Json& all, const Json& more) {
  std::set<Json> there(all.begin(), all.end());
  for (const Json& item : more)
    if (there.insert(item).second) all.push_back(item);
}

// What `all` is with the cells, plugins and settings of `more`: another method, seed or number of demonstrations, with
// nothing else in the settings changed.
Json united(Json all, const Part& first, const Part& more) {
  if (all.at("cells") == more.json().at("cells")) return all;
  const Json request = more.json().value("request", Json::object());
  const std::string differs = difference(all, more.json());
  if (!all.value("request", Json()).is_object() || !request.is_object()) refuse(first, more, "other cells: " + differs);
  for (const auto& [member, value] : request.items()) {
    const bool may_grow = std::count(grid_lists.begin(), grid_lists.end(), member) > 0;
    Json& there = all["request"][member];
    if (may_grow && there.is_array() && value.is_array())
      unite(there, value);
    else if (member == "references" && there.is_boolean() && value.is_boolean())
      there = there.get<bool>() || value.get<bool>();
    else if (there != value)
      refuse(first, more, "other cells: " + differs);
  }
  unite(all["cells"], more.json().at("cells"));
  unite(all["plugins"], more.json().at("plugins"));
  const Json settings = more.json().value("settings", Json::object());
  for (const auto& [row, options] : settings.items()) all["settings"][row] = options;
  return all;
}

// What status.json says of a cell that the run's own programs computed.
Json build_of(const Part& part, const std::string& key) {
  const fs::path file = part.cell(key) / "cell.json";
  const Json json = read_json(file, Links::refused);
  const Cell cell = read_cell(json, file.string());
  Json build = part.json().at("build");
  const auto plugin = [&](const std::string& kind, const std::string& id) {
    const auto found = part.programs().find(kind + " " + id);
    if (found != part.programs().end()) build[kind] = found->second;
  };
  plugin("engine", cell.engine);
  if (!cell.method.is_reference()) plugin("method", cell.method.id);
  return build;
}

CellState state_of(const Part& part, const std::string& key) {
  const fs::path cell = part.cell(key);
  if (!fs::exists(cell)) return {};
  try {
    return cell_state(cell, key, build_of(part, key));
  } catch (const InputError& e) {
    CellState damaged;
    damaged.why = e.what();
    return damaged;
  }
}

void expect_same_results(const fs::path& one, const fs::path& other) {
  for (const char* file : result_files)
    if (read_file(one / file) != read_file(other / file))
      throw InputError(
          fmt::format("{} and {}: other results of one cell: {} differs", one.string(), other.string(), file));
}

// The cell's directory to take: a finished one, else a failed one, else none.
fs::path best(const std::vector<Part>& parts, const std::string& key, MergeOutcome& outcome) {
  fs::path finished, failed;
  for (const Part& part : parts) {
    const CellState state = state_of(part, key);
    if (state.complete) {
      if (!finished.empty()) expect_same_results(finished, part.cell(key));
      if (finished.empty()) finished = part.cell(key);
    } else if (state.failed) {
      if (failed.empty()) failed = part.cell(key);
    } else if (!state.why.empty()) {
      to_stderr("{}: {}; left out\n", part.cell(key).string(), state.why);
    }
  }
  if (!finished.empty()) {
    ++outcome.finished;
    return finished;
  }
  if (failed.empty())
    ++outcome.missing;
  else
    ++outcome.failed;
  return failed;
}

// Runs name their rows apart: two that a run has alone of their method have its id, whatever their options.
void expect_one_of_each(const std::map<std::string, fs::path>& chosen, const Json& settings) {
  const auto read = [](const fs::path& directory) {
    const fs::path file = directory / "cell.json";
    return read_cell(read_json(file, Links::refused), file.string());
  };
  std::map<std::string, fs::path> measured;  // by kind and title
  for (const auto& item : chosen) {
    const Cell cell = read(item.second);
    const auto [before, is_new] = measured.try_emplace(cell.method.kind + " " + cell.title(), item.second);
    if (is_new) continue;
    const Json there = to_json(read(before->second)), here = to_json(cell);
    const auto differing = [](const Json& a, const Json& b) {
      std::vector<std::string> members;
      for (const auto& [member, value] : b.items())
        if (!a.is_object() || a.value(member, Json()) != value) members.push_back(member);
      return members;
    };
    const std::vector<std::string> options = differing(there["method"]["options"], cell.method.options);
    std::string say = fmt::format("{} and {} both are {}, and differ in {}", before->second.string(),
                                  item.second.string(), cell.title(), fmt::join(differing(there, here), ", "));
    if (!options.empty())
      say += fmt::format(
          " ({}): a row that a run has alone of its method is named by the method; give these rows to one run, "
          "--methods {}, whose names tell them apart",
          fmt::join(options, ", "), fmt::join(JsonReader(settings, "run.json: /request").at("methods").strings(), ","));
    throw InputError(say);
  }
}

// What a method in Python is made of beside its file (interpreter, packages, modules) stands with its cells alone.
void expect_one_python(const std::map<std::string, fs::path>& chosen) {
  std::map<std::string, std::pair<std::string, fs::path>> known;  // by method: what, and where
  for (const auto& item : chosen) {
    const fs::path file = item.second / "status.json", cell_file = item.second / "cell.json";
    const Json status = read_json(file, Links::refused);
    const JsonReader reader(status, file.string());
    if (reader.at("state").string() != "ok" || !reader.at("build").has("python")) continue;
    const std::string python = reader.at("build").at("python").string();
    const Cell cell = read_cell(read_json(cell_file, Links::refused), cell_file.string());
    const auto [first, is_new] = known.try_emplace(cell.method.id, python, item.second);
    if (!is_new && first->second.first != python)
      throw InputError(
          fmt::format("{} and {}: other builds of method {}: their interpreter, packages or modules differ",
                      first->second.second.string(), item.second.string(), cell.method.id));
  }
}

bool asks_live(const Part& part) {
  const Json request = part.json().value("request", Json::object());
  return request.is_object() && request.contains("answers") && request["answers"].is_string() &&
         is_live(request["answers"].get<std::string>());
}

// The part that keeps every reply, where parts asked a model live, on one cassette; else the first.
const Part& with_all_replies(const std::vector<Part>& parts) {
  const Part* all = &parts.front();
  if (!asks_live(*all)) return *all;
  const auto bytes = [](const Part& part) {
    const auto kept = kept_replies(part.path());
    return kept ? fs::file_size(kept->path) : 0;
  };
  for (const Part& part : parts)
    if (bytes(part) > bytes(*all)) all = &part;
  for (const Part& part : parts)
    if (bytes(part) > 0 && !holds_lines(kept_replies(all->path())->path, kept_replies(part.path())->path))
      throw InputError(fmt::format(
          "{} and {}: a language model was asked the same twice, on two cassettes; fill one with lgabench select "
          "--suite, and give it to the parts as --answers cassette:FILE",
          all->path().string(), part.path().string()));
  return *all;
}

Json merged_json(Json json, const std::vector<Part>& parts, const Json& answers, const std::string& command) {
  Json merged = Json::array();
  json.erase("shard");
  if (!answers.is_null()) json["answers"] = answers;
  for (const Part& part : parts) {
    Json own = Json::object();
    for (const char* member : {"command", "machine", "started"}) own[member] = part.json().at(member);
    json["started"] = std::min(json["started"], own["started"]);
    if (is_unconfined(part.path())) json["confinement"] = unconfined_run;
    merged.push_back(own);
    const Json &processor = own["machine"]["processor"], &first = json["machine"]["processor"];
    if (processor != first)
      to_stderr("{}: computed on {}, {} on {}: its bits may differ from one machine's\n", part.path().string(),
                processor.get<std::string>(), parts.front().path().string(), first.get<std::string>());
  }
  json["command"] = command;
  json["merged"] = merged;
  return json;
}

// What a cell is documented to hold and nothing else.
void copy_cell(const fs::path& from, const fs::path& to) {
  const auto copy = [&](const std::string& name) {
    write_file(to / name, read_file(from / name, Links::refused), Sync::later);
  };
  for (const std::string& name : cell_files)
    if (fs::exists(from / name)) copy(name);
  for (const std::string& name : artefact_names(from / "files")) copy("files/" + name);
  copy("status.json");
}

}  // namespace

MergeOutcome merge_runs(const fs::path& out, const std::vector<fs::path>& runs, const std::string& command) {
  std::vector<Part> parts;
  for (const fs::path& run : runs) {
    std::error_code not_there;
    if (fs::equivalent(run, out, not_there))
      throw InputError(fmt::format("{}: both to be read and to be written; expected another OUT", out.string()));
    parts.emplace_back(run);
    for (const Part& part : parts) expect_same_programs(part, parts.back());  // the first may lack what two others have
  }
  Json all = parts.front().json();
  for (const Part& part : parts) all = united(std::move(all), parts.front(), part);
  MergeOutcome outcome;
  std::map<std::string, fs::path> chosen;
  for (const std::string& key : all.at("cells").get<std::vector<std::string>>())
    if (const fs::path from = best(parts, key, outcome); !from.empty()) chosen[key] = from;
  expect_one_python(chosen);
  if (all.at("cells") != parts.front().json().at("cells")) expect_one_of_each(chosen, all.at("request"));

  const Part& replies = with_all_replies(parts);
  const Json answers = replies.json().value("answers", Json());
  const Json record = merged_json(std::move(all), parts, answers, command);
  const bool unconfined = is_unconfined(out);  // cells of an earlier merge stay
  const RunDirectory directory(out, record, Existing::resume);
  for (const char* member : {"command", "started", "answers", "merged", "confinement"})
    directory.amend(member, record.value(member, Json()));
  if (unconfined) directory.amend("confinement", unconfined_run);
  for (const Part& part : parts)
    if (!asks_live(part) || &part == &replies) keep_answers(kept_answers(part.path()), out);
  std::size_t copied = 0;
  auto told = std::chrono::steady_clock::now();
  for (const auto& [key, from] : chosen) {
    copy_cell(from, directory.scratch(key));
    ++copied;
    if (const auto now = std::chrono::steady_clock::now(); now - told > std::chrono::seconds(2)) {
      told = now;
      to_stderr("{} of {} cells copied\n", copied, chosen.size());
    }
  }
  sync_file_system(directory.path());  // before the first of them gets its name: a name stands for what is on the disk
  for (const auto& cell : chosen) directory.keep(cell.first);
  directory.sync();
  return outcome;
}

}  // namespace lgabench
