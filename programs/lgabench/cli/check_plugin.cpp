// lgabench check-plugin FILE.so: what is wrong with a plugin, and what to do about it, before a run shows it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string_view>

#include <lgabench/abstraction/reading.hpp>
#include <lgabench/cli/findings.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/colour.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/harness/worker_pool.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/host/reach.hpp>
#include <lgabench/job/check_report.hpp>

namespace lgabench::cli {
namespace {

struct CheckPluginArguments {
  std::string file, python = usual_python(), environment, scenario;
  std::vector<std::string> settings;
  double timeout_s = 600, memory_gib = 0;
  bool json = false;
};

// What is told while the first process works: each finding once, and where it stays for long.
class Watching {
 public:
  Watching(CheckReport& report, fs::path found, const CheckPluginArguments& a)
      : report_(report), found_(std::move(found)), a_(a) {}
  std::size_t printed() const { return printed_; }
  void phase(const std::string& name) {
    phase_ = name;
    began_ = Clock::now();
    is_told_ = false;
  }
  void tick() {
    const double seconds = std::chrono::duration<double>(Clock::now() - began_).count();
    if (!is_told_ && !phase_.empty() && seconds > long_s) {
      to_stderr("still in {} after {:.0f} s; it is stopped after {} s (--timeout)\n", phase_, seconds, a_.timeout_s);
      is_told_ = true;
    }
    if (!a_.json) print_new();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double long_s = 20;

  void print_new() {
    CheckReport all = report_;
    if (fs::exists(found_)) {
      const CheckReport found = read_check_report(read_json(found_), found_.string());
      all.findings.insert(all.findings.end(), found.findings.begin(), found.findings.end());
    }
    for (; printed_ < all.findings.size(); ++printed_) print(all.findings[printed_]);
    std::fflush(stdout);
  }

  CheckReport& report_;  // what was found before
  const fs::path found_;
  const CheckPluginArguments& a_;
  std::string phase_;
  Clock::time_point began_ = Clock::now();
  bool is_told_ = false;
  std::size_t printed_ = 0;
};

// How it was compiled, where that may change results.
void note_compilation(const PluginInfo& plugin, CheckReport& report) {
  if (plugin.fingerprint.find(";arithmetic=fast") == std::string::npos) return;
  report.note("compilation", "built with -ffast-math (or -Ofast): another compiler or processor may give other results",
              "build it without: results are then the same wherever the same numbers are computed");
}

void judge_id(const PluginInfo& plugin, const Catalogue& catalogue, CheckReport& report) {
  for (const PluginInfo& other : catalogue.plugins)
    if (other.kind == plugin.kind && other.id == plugin.id && other.sha256 != plugin.sha256)
      report.problem("id", fmt::format("{} is also the id of {}", plugin.id, other.file.string()),
                     "take another id: of two plugins with one id, the later is refused");
}

// Whether lgabench itself has another thing of that name.
void judge_name(const PluginInfo& plugin, CheckReport& report) {
  const std::vector<std::string> shipped = perturbation_ids({});
  if (plugin.kind == "perturbation" && contains(shipped, plugin.id))
    report.problem("id", fmt::format("{} is an axis of lgabench's own", plugin.id),
                   "take another: it would be refused");
  const std::vector<std::string>& readers = names_read();
  if (plugin.kind == "perceiver" && (plugin.id == Reading::simulator || contains(readers, plugin.id)))
    report.problem("id", fmt::format("{} is a word of --names", plugin.id), "take another: it would never be asked");
}

// A process that uses the plugin: what it found, and how it ended.
struct CheckProcess {
  fs::path report, log;
  CheckJob job;
  WorkerEnd end;

  bool reported() const { return fs::exists(report); }
  bool ended_well() const { return end.exit_code == 0 && end.signal == 0 && reported(); }
  CheckReport found() const {
    return reported() ? read_check_report(read_json(report), report.string()) : CheckReport();
  }
};

std::array<CheckProcess, 2> two_processes(const PluginInfo& plugin, const std::optional<PluginInfo>& engine,
                                          const CheckPluginArguments& a, const PoolOptions& pool,
                                          const fs::path& scratch) {
  CheckJob job;
  job.engine = engine;
  if (plugin.kind == "method") job.method = plugin;
  if (plugin.kind == "perturbation" || plugin.kind == "perceiver") job.perturbation = plugin;
  if (plugin.kind == "environment") job.checked_environment = plugin;
  job.options = options_set(plugin, a.settings);
  job.limits = worker_limits(pool);
  job.environment = a.environment;
  if (!a.scenario.empty()) job.scenario = load_scenario(a.scenario).json;
  std::array<CheckProcess, 2> both;
  for (std::size_t i = 0; i < both.size(); ++i) {
    both[i] = {scratch / (i == 0 ? "first.json" : "second.json"), scratch / fmt::format("log{}.txt", i), job, {}};
    both[i].job.scratch = scratch / fmt::format("method{}", i);
    both[i].job.perturb = i == 0 ? 0 : 165;
    both[i].job.report = both[i].report;
  }
  return both;
}

void report_end(const CheckProcess& process, double timeout_s, CheckReport& report) {
  const bool said_why = process.end.complaint && process.end.complaint->signal == 0;
  auto tail = log_tail(process.log);
  if (process.end.complaint && !tail.empty()) tail.pop_back();  // the worker's own line, which says the same
  report.problem("process", why_it_ended(process.end, timeout_s).reason,
                 said_why || tail.empty() ? "" : fmt::format("it printed: {}", fmt::join(tail, "\n")));
}

void judge_agreement(const CheckReport& first, const CheckReport& second, CheckReport& report) {
  if (second.hashes.empty()) return;
  std::vector<std::string> differing;
  for (const auto& [what, hash] : first.hashes.items())
    if (second.hashes.value(what, Json()) != hash) differing.push_back(what);
  report.judge("two processes", differing.empty() ? "" : fmt::format("disagree on: {}", fmt::join(differing, ", ")),
               "agree bit for bit",
               "look for values that were never set, addresses that are compared, a clock, a shared file");
}

// What the plugin is checked on. @throws InputError for an engine in an environment that has none.
std::optional<PluginInfo> engine_for(const PluginInfo& plugin, const Catalogue& catalogue,
                                     const std::string& environment) {
  const std::string played = plugin.kind == "environment" ? plugin.id
                             : environment.empty()        ? environment_ids().front()
                                                          : environment;
  if (plugin.kind == "environment") add_environment(plugin);
  const EnvironmentType& type = find_environment(played);
  if (plugin.kind == "engine" && type.has_engine()) return plugin;
  return catalogue.engine(plugin.kind == "engine" ? plugin.id : default_engine(catalogue, type), type);
}

// Two processes use the plugin: their findings, and whether they agree. Returns how many findings are printed already.
std::size_t check(const PluginInfo& plugin, const Catalogue& catalogue, const CheckPluginArguments& a,
                  CheckReport& report) {
  report.ok("descriptor", fmt::format("fits lgabench {}", LGABENCH_VERSION));
  judge_id(plugin, catalogue, report);
  note_compilation(plugin, report);
  judge_name(plugin, report);

  const Scratch scratch("check");
  const PoolOptions pool{1, a.timeout_s, plugin_memory_gib(a.memory_gib)};
  const std::optional<PluginInfo> engine = engine_for(plugin, catalogue, a.environment);
  std::array<CheckProcess, 2> both = two_processes(plugin, engine, a, pool, scratch.path);
  Watching watching(report, both[0].report, a);
  const auto use = [&](CheckProcess& process) {
    fs::create_directory(process.job.scratch);
    const PoolEvents events{[](std::size_t) {},
                            [&](std::size_t, const std::string& phase, long long) { watching.phase(phase); },
                            [&](std::size_t, const WorkerEnd& end) { process.end = end; }, [&] { watching.tick(); }};
    const auto task = [&process](std::size_t) { return WorkerTask{to_json(process.job), process.log, "check-job"}; };
    if (!run_workers(1, task, pool, events)) throw InputError("interrupted");
  };
  use(both[0]);
  const bool ended_well = both[0].ended_well();
  if (ended_well) {
    if (!a.json) to_stderr("the same once more in a second process\n");
    use(both[1]);
  }

  const CheckReport first = both[0].found();
  report.findings.insert(report.findings.end(), first.findings.begin(), first.findings.end());
  if (!ended_well) {
    report_end(both[0], a.timeout_s, report);
    return watching.printed();
  }
  const CheckReport second = both[1].found();
  if (!both[1].ended_well()) report_end(both[1], a.timeout_s, report);
  judge_agreement(first, second, report);
  return watching.printed();
}

int check_plugin(CheckPluginArguments a) {
  if (const std::string missing = missing_plugin(a.file); !missing.empty()) throw InputError(missing);
  if (!a.environment.empty()) find_environment(a.environment);
  if (!a.scenario.empty()) a.environment = load_scenario(a.scenario).environment->id();
  CheckReport report;
  PluginInfo plugin;
  std::size_t printed = 0;
  try {
    if (is_python_method(a.file)) {
      plugin = describe_python(a.file, a.python);
    } else {
      plugin = read_plugin(a.file);
      warn_of_home(fs::absolute(plugin.file).parent_path());
    }
    if (!a.json)
      to_stdout("{} {}, {} {}\n", plugin.id, plugin.version, plugin.kind.front() == 'e' ? "an" : "a", plugin.kind);
    if (!a.scenario.empty() && plugin.kind != "method")
      throw InputError("--scenario: expected a method's file beside it");
    printed = check(plugin, scan_plugins(plugin_directories()), a, report);
  } catch (const PluginError& e) {
    const bool in_options = std::string_view(e.what()).find(": options: ") != std::string_view::npos;
    report.problem("descriptor", e.what(),
                   is_python_method(a.file) ? "see docs/add-a-method.md, or docs/simulators.md for an environment"
                   : in_options             ? "correct the options that LGABENCH_METHOD, or the like, is given"
                                            : "build it with lgabench_add_plugin() from this very lgabench's package, "
                                              "and no definition that changes the standard library");
  }
  const bool good = !has_problem(report);
  if (a.json) {
    Json json = to_json(report);
    json["file"] = a.file;
    json["plugin"] =
        plugin.id.empty() ? Json() : Json{{"kind", plugin.kind}, {"id", plugin.id}, {"version", plugin.version}};
    json["good"] = good;
    to_stdout("{}\n", canonical(json));
  } else {
    print(report, printed);
  }
  return good ? ok : regression;
}

}  // namespace

void add_check_plugin(CLI::App& app, int& exit) {
  auto a = std::make_shared<CheckPluginArguments>();
  Verb verb(app, "check-plugin", "Check a plugin for mistakes, and say how to fix them");
  verb.option("file FILE", a->file,
              "The plugin's library, FILE.so, or a method, perturbation, perceiver or environment in Python, "
              "FILE.py:CLASS",
              required);
  verb.option("--python PROGRAM", a->python, "The interpreter for a plugin in Python", with_default);
  verb.option("--set OPTION=VALUE", a->settings, "An option of the plugin; can be repeated", repeatable);
  verb.option("--environment ID", a->environment, "The environment to check the plugin in");
  verb.option("--scenario SCENARIO", a->scenario,
              "A scenario, by id, that a method is checked on alone: one of several steps, such as errands_fruit")
      ->excludes("--environment");
  add_scenario_path(verb);
  add_plugin_limits(verb, a->timeout_s, a->memory_gib, "each of the two processes");
  verb.option("--json", a->json, "Print one JSON object");
  verb->footer(
      "Two fresh processes use the plugin as cells do, with the same seed. Exit 1 if there is a problem.\nWithout "
      "--environment, an engine, a perturbation or a perceiver is checked in every environment, and a method in the "
      "first that has "
      "a scenario with a "
      "command that is tested but never demonstrated.\nExample: lgabench check-plugin build/my_method.so");
  verb->callback([a, &exit] { exit = check_plugin(*a); });
}

}  // namespace lgabench::cli
