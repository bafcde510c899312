// lgabench bench METHOD: how long a method of one's own takes, beside a shipped one.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <future>
#include <memory>
#include <optional>
#include <thread>

#include <lgabench/cell/method_times.hpp>
#include <lgabench/cli/commands.hpp>
#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/host/reach.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::cli {
namespace {

struct BenchArguments {
  std::string method, beside = "lga", scenario = "heart", engine, python = usual_python();
  std::vector<std::string> settings;
  std::vector<fs::path> plugin_path;
  int demonstrations = 10, repetitions = 9;
  double timeout_s = 600, memory_gib = 0;
  bool json = false;
};

// Ends this process, and with it the method's, where a use takes longer than it may.
class Watch {
 public:
  Watch(const std::string& who, double seconds) {
    thread_ = start_thread([over = over_.get_future(), who, seconds] {
      if (over.wait_for(std::chrono::duration<double>(seconds)) != std::future_status::timeout) return;
      to_stderr("lgabench: {}: its use took longer than {:g} s (--timeout): nothing was measured\n", who, seconds);
      ::_exit(cells_failed);
    });
  }
  ~Watch() {
    over_.set_value();
    thread_.join();
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  std::promise<void> over_;
  std::thread thread_;
};

// A method, and what was measured of it.
struct Measured {
  PluginInfo plugin;
  Json options;
  std::string name;               // as the tables have it
  std::vector<MethodTimes> uses;  // one a repetition
};

constexpr std::array<const char*, 5> phases{"start", "select", "learn", "act", "save"};

PluginInfo plugin_of(const std::string& word, const Catalogue& catalogue, const std::string& python) {
  const bool is_python = is_python_method(word), is_library = fs::path(word).extension() == ".so";
  if (is_python || is_library)
    if (const std::string missing = missing_plugin(word); !missing.empty()) throw InputError(missing);
  const PluginInfo plugin = is_python    ? describe_python(word, python)
                            : is_library ? read_plugin(word)
                                         : catalogue.find("method", word);
  if (is_library) warn_of_home(fs::absolute(plugin.file).parent_path());
  if (plugin.kind != "method")
    throw InputError(fmt::format("{}: expected a method, got a plugin of kind {}", word, plugin.kind));
  return plugin;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

// Of the phase, wall or processor time of each use; none where a use has no such phase.
std::vector<double> seconds_of(const Measured& measured, const std::string& phase, double MethodTimes::Phase::*which) {
  std::vector<double> all;
  for (const MethodTimes& use : measured.uses)
    for (const MethodTimes::Phase& one : use.phases)
      if (one.name == phase) all.push_back(one.*which);
  return all;
}

std::string ms(double seconds) { return fmt::format("{:.{}f} ms", 1e3 * seconds, seconds < .1 ? 2 : 0); }

std::string mib(double bytes) { return fmt::format("{:.1f} MiB", bytes / (1 << 20)); }

void print_row(const std::string& what, const std::string& mine, const std::string& other, const std::string& ratio) {
  to_stdout("{:<8}{:>16}{:>16}  {}\n", what, mine, other, ratio);
}

void print_bytes(const std::string& what, double mine, double other) {
  const auto text = [](double bytes) { return bytes > 0 ? mib(bytes) : std::string("none"); };
  print_row(what, text(mine), text(other), mine > 0 && other > 0 ? fmt::format("{:.2f}", mine / other) : "");
}

void print(const std::array<Measured, 2>& both, const BenchArguments& a, const Scenario& scenario) {
  to_stdout("{}, {} demonstration{} of each command; medians of {} uses each, in turns\n\n", scenario.id,
            a.demonstrations, a.demonstrations == 1 ? "" : "s", a.repetitions);
  print_row("", both[0].name, both[1].name, "ratio, and of single pairs");
  for (const char* phase : phases) {
    const auto mine = seconds_of(both[0], phase, &MethodTimes::Phase::wall_s),
               other = seconds_of(both[1], phase, &MethodTimes::Phase::wall_s);
    std::string ratio;
    if (!mine.empty() && mine.size() == other.size()) {
      std::vector<double> pairs;
      for (std::size_t i = 0; i < mine.size(); ++i) pairs.push_back(mine[i] / other[i]);
      const auto [low, high] = std::minmax_element(pairs.begin(), pairs.end());
      ratio = fmt::format("{:.2f}, {:.2f} to {:.2f}", median(mine) / median(other), *low, *high);
    }
    print_row(phase, mine.empty() ? "none" : ms(median(mine)), other.empty() ? "none" : ms(median(other)), ratio);
  }
  const auto most = [](const Measured& measured) {
    long long bytes = 0;
    for (const MethodTimes& use : measured.uses) bytes = std::max(bytes, use.peak_bytes);
    return static_cast<double>(bytes);
  };
  print_bytes("memory", most(both[0]), most(both[1]));
  const auto saved = [](const Measured& measured) { return static_cast<double>(measured.uses.front().saved_bytes); };
  print_bytes("policy", saved(both[0]), saved(both[1]));
}

// As Google Benchmark writes it, so that its compare.py reads it.
Json benchmark_json(const std::array<Measured, 2>& both, const BenchArguments& a, const Scenario& scenario) {
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  Json all = {{"context",
               {{"date", fmt::format("{:%Y-%m-%dT%H:%M:%S+00:00}", fmt::gmtime(std::time(nullptr)))},
                {"host_name", host},
                {"executable", "lgabench bench"},
                {"num_cpus", usable_cores()},
                {"lgabench", LGABENCH_VERSION},
                {"scenario", scenario.id},
                {"demonstrations", a.demonstrations},
                {"library_build_type", "release"}}},
              {"benchmarks", Json::array()}};
  for (const char* phase : phases)
    for (const Measured& measured : both) {
      const auto wall = seconds_of(measured, phase, &MethodTimes::Phase::wall_s),
                 cpu = seconds_of(measured, phase, &MethodTimes::Phase::cpu_s);
      if (wall.empty()) continue;
      const std::string name = fmt::format("{}/{}", phase, measured.name);
      const auto add = [&](const Json& kind, const std::string& called, double wall_s, double cpu_s) {
        Json one = {{"name", called},  {"run_name", name},          {"repetitions", wall.size()}, {"threads", 1},
                    {"iterations", 1}, {"real_time", 1e3 * wall_s}, {"cpu_time", 1e3 * cpu_s},    {"time_unit", "ms"}};
        one.update(kind);
        all["benchmarks"].push_back(std::move(one));
      };
      for (std::size_t i = 0; i < wall.size(); ++i)
        add({{"run_type", "iteration"},
             {"repetition_index", i},
             {"max_bytes_used", measured.uses[i].peak_bytes},
             {"saved_bytes", measured.uses[i].saved_bytes}},
            name, wall[i], cpu[i]);
      add({{"run_type", "aggregate"}, {"aggregate_name", "median"}, {"aggregate_unit", "time"}}, name + "_median",
          median(wall), median(cpu));
    }
  return all;
}

void bench(const BenchArguments& a) {
  const Catalogue catalogue = plugins_at(a.plugin_path, a.python);
  std::array<Measured, 2> both;
  both[0].plugin = plugin_of(a.method, catalogue, a.python);
  both[1].plugin = plugin_of(a.beside, catalogue, a.python);
  both[0].options = options_set(both[0].plugin, a.settings);
  both[1].options = options_set(both[1].plugin, {});
  for (std::size_t i = 0; i < both.size(); ++i) {
    const bool same = both[0].plugin.id == both[1].plugin.id;
    both[i].name = both[i].plugin.id + (same ? i == 0 ? " (1)" : " (2)" : "");
  }
  const Scenario scenario = load_scenario(a.scenario);
  const EnvironmentType& type = *scenario.environment;
  const std::string engine = a.engine.empty() ? default_engine(catalogue, type) : a.engine;
  Bench played(scenario, catalogue.engine(engine, type));
  const Descriptor out{::dup(1)};
  if (out.fd < 0) throw Refused("standard output");
  ::dup2(2, 1);  // what the methods print
  CountedProgress progress("uses measured:", 2 * a.repetitions);
  progress.say(fmt::format("measuring {} and {}, each {} times", both[0].name, both[1].name, a.repetitions));
  for (int k = 0; k < a.repetitions; ++k)
    for (std::size_t turn = 0; turn < both.size(); ++turn) {
      Measured& measured = both[(turn + static_cast<std::size_t>(k)) % both.size()];  // neither is always the first
      const Scratch scratch("bench");
      HostJob job{measured.plugin, type.id(), measured.options, 0, scratch.path};
      job.memory_bytes = static_cast<long long>(plugin_memory_gib(a.memory_gib) * (1 << 30));
      const Watch watch(measured.name, a.timeout_s);
      measured.uses.push_back(time_of_use(job, played, a.demonstrations));
      progress.tell_next();
    }
  progress.end();
  flush_stdout();
  ::dup2(out.fd, 1);
  if (a.json)
    to_stdout("{}\n", benchmark_json(both, a, scenario).dump(1));
  else
    print(both, a, scenario);
}

}  // namespace

void add_bench(CLI::App& app, int&) {
  auto a = std::make_shared<BenchArguments>();
  Verb verb(app, "bench", worker_summary("bench"));
  verb.option("method METHOD", a->method, "Its library, FILE.so, a class in Python, FILE.py:CLASS, or a method's id",
              required);
  verb.option("--beside METHOD", a->beside, "What it is compared with, likewise", with_default);
  verb.option("--set OPTION=VALUE", a->settings, "An option of METHOD, not of the other one; can be repeated",
              repeatable);
  verb.option("--scenario SCENARIO", a->scenario, "A scenario, by id", with_default);
  verb.option("--demos N", a->demonstrations, "Demonstrations of each command", CLI::Range(1, 1000), with_default);
  verb.option("--repetitions N", a->repetitions, "Uses of each method", CLI::Range(1, 1000), with_default);
  verb.option("--engine ENGINE", a->engine, "An engine, by plugin id (default: the one that suites use)");
  add_plugin_limits(verb, a->timeout_s, a->memory_gib, "each use");
  verb.option("--json", a->json, "Print what Google Benchmark would write, for its compare.py");
  add_plugin_path(verb, a->plugin_path, any_plugin);
  add_python(verb, a->python);
  add_scenario_path(verb);
  verb->footer(
      "Each use has a fresh, confined process, as a cell has. start: until its libraries are loaded; select: all "
      "commands; act: the mean call. Only ratios mean something, on an idle machine.\n"
      "Example: lgabench bench build/my_method.so --demos 20");
  verb->callback([a] { bench(*a); });
}

}  // namespace lgabench::cli
