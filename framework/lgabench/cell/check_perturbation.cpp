#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <map>
#include <utility>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/check.hpp>
#include <lgabench/cell/hosted_axes.hpp>
#include <lgabench/cell/perturbed.hpp>
#include <lgabench/cell/runs_below.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/meaning.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/host/hosted_perturbation.hpp>

namespace lgabench {
namespace {

constexpr int scenes_a_level = 20;
constexpr std::uint64_t check_seed = 7;

struct SeenScene {
  Scene scene;
  Observation observation;
};

std::string perceived_bytes(const Observation& seen) {
  std::string text(seen.ids.begin(), seen.ids.end());
  text.append(seen.rgb.begin(), seen.rgb.end());
  for (const Instance& one : seen.instances) text += fmt::format("{} {} {}\n", one.id, one.object_type, one.texture);
  return hex(hash64(text));
}

bool same_names(const Observation& a, const Observation& b) {
  return std::equal(a.instances.begin(), a.instances.end(), b.instances.begin(), b.instances.end(),
                    [](const Instance& one, const Instance& other) {
                      return one.id == other.id && one.object_type == other.object_type && one.texture == other.texture;
                    });
}

bool part_differs(EpisodePart part, const Observation& a, const Observation& b) {
  if (part == EpisodePart::rgb) return a.rgb != b.rgb;
  if (part == EpisodePart::ids) return a.ids != b.ids;
  return !same_names(a, b);
}

// Of a channel of a pixel, of 255.
double mean_change(const Observation& a, const Observation& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

std::vector<SeenScene> scenes_of(const EnvironmentType& environment, const Scenario& scenario) {
  const std::string layout = environment.tasks().front().layouts.front();
  std::vector<SeenScene> scenes;
  for (int i = 0; i < scenes_a_level; ++i) {
    Scene scene = test_scene(scenario, layout, scenario.tests.front().id, check_seed, i);
    Observation seen = environment.draw(scene);
    scenes.push_back({std::move(scene), std::move(seen)});
  }
  return scenes;
}

// What the plugin's process holds and was refused, and how long a picture took.
void judge_process(HostedPerturbation& process, bool is_library, CheckReport& report) {
  if (is_library) {
    process.drop();
    judge_leftovers(report, [&process] { return process.state(); });
    judge_arithmetic(report, process.state());
  }
  const std::vector<std::string> refused = process.refused_calls();
  if (!refused.empty())
    report.note("system calls", fmt::format("refused: {}", fmt::join(refused, ", ")),
                "a plugin may make only the calls listed in docs/trust.md; handle the refusal, or avoid the call");
}

// One axis in one environment.
class AxisCheck {
 public:
  AxisCheck(const HostJob& job, const PerturbationAxis& axis, CheckReport& report)
      : axis_(axis),
        environment_(find_environment(job.environment)),
        scenario_(load_scenario(environment_.tasks().front().example)),
        report_(report),
        in_(", " + job.environment),
        is_library_(job.plugin.python.is_null()),
        process_(job),
        scenes_(scenes_of(environment_, scenario_)) {}

  /// Returns a hash of all that was perceived.
  std::string run(const CheckPhase& phase) {
    std::string all;
    for (int level = 1; level <= axis_.most(); ++level) {
      const std::string doing = fmt::format("level {}{}", level, in_);
      phase(doing, report_);
      try {
        all += judge_level(level);
      } catch (const MethodError& e) {
        report_.problem(doing, e.what(), "this call must succeed: a run makes it too");
      }
    }
    judge_sizes();
    judge_process(process_, is_library_, report_);
    report_.ok("time" + in_, fmt::format("{:.1f} ms a picture", 1e3 * seconds_ / calls_));
    return sha256(all);
  }

 private:
  Observation perceive(const SeenScene& one, int level) {
    const auto start = std::chrono::steady_clock::now();
    Observation perceived = process_.perceive(one.observation, level, perturbation_stream(axis_.id, one.scene, {}));
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++calls_;
    expect_perceived(perceived, scenario_.space);
    return perceived;
  }

  std::string judge_level(int level) {
    std::array<int, parts> changed{};
    std::vector<std::string> bytes;
    double change = 0;
    for (const SeenScene& one : scenes_) {
      const Observation perceived = perceive(one, level);
      for (const EpisodePart part : {EpisodePart::rgb, EpisodePart::ids, EpisodePart::instances})
        changed[static_cast<std::size_t>(part)] += part_differs(part, one.observation, perceived);
      change += mean_change(one.observation, perceived) / scenes_a_level;
      bytes.push_back(perceived_bytes(perceived));
    }
    changes_.push_back(change);
    std::vector<std::string> faults;
    for (const EpisodePart part : {EpisodePart::rgb, EpisodePart::ids, EpisodePart::instances}) {
      const int n = changed[static_cast<std::size_t>(part)];
      const char* name = part_names[static_cast<std::size_t>(part)];
      const bool must = std::count(axis_.changes.begin(), axis_.changes.end(), part) > 0;
      if (n > 0 && !axis_.touches(part)) faults.push_back(fmt::format("{} changes and is not declared", name));
      if (must && n < fewest_changed * scenes_a_level)
        faults.push_back(fmt::format("{} is declared and changes in only {} of {} scenes", name, n, scenes_a_level));
    }
    for (std::size_t i = scenes_.size(); i-- > 0;)
      if (perceived_bytes(perceive(scenes_[i], level)) != bytes[i]) {
        faults.emplace_back("a scene seen again, in another order, gives another picture");
        break;
      }
    report_.judge(fmt::format("level {}{}", level, in_), fmt::format("{}", fmt::join(faults, "; ")),
                  "changes what it declares, bit-identical when repeated",
                  "declare in \"changes\" what differs in at least 95 % of scenes, in \"may_change\" what differs in "
                  "some; draw all that is random from the stream, and keep nothing from one call to the next");
    return fmt::format("{}\n", fmt::join(bytes, "\n"));
  }

  // What a level does to the colours: where levels have an order, a higher one should do more.
  void judge_sizes() {
    std::vector<std::string> words;
    for (const double change : changes_) words.push_back(fmt::format("{:.1f}", change));
    const std::string detail = fmt::format("mean change of a colour, of 255: {}", fmt::join(words, ", "));
    if (axis_.named || !axis_.touches(EpisodePart::rgb) || std::is_sorted(changes_.begin(), changes_.end()))
      report_.ok("sizes" + in_, detail);
    else
      report_.note("sizes" + in_, detail,
                   "a higher level should change more; declare levels without an order \"named\"");
  }

  const PerturbationAxis& axis_;
  const EnvironmentType& environment_;
  const Scenario scenario_;
  CheckReport& report_;
  const std::string in_;
  const bool is_library_;
  HostedPerturbation process_;
  const std::vector<SeenScene> scenes_;
  std::vector<double> changes_;  // by level
  double seconds_ = 0;
  int calls_ = 0;
};

// `check` of each environment to check in: its job, its part of the report's hashes.
template <class Check>
CheckReport in_environments(HostJob job, const CheckPhase& phase, Check check) {
  CheckReport report;
  job.hidden = runs_below(job.plugin.file.parent_path());
  const std::vector<std::string> environments =
      job.environment.empty() ? environment_ids() : std::vector{job.environment};
  const fs::path scratch = job.scratch;
  for (const std::string& environment : environments) {
    job.environment = environment;
    job.scratch = scratch / environment;
    fs::create_directory(job.scratch);
    phase("load", report);
    report.hashes["perceived, " + environment] = check(job, report);
  }
  return report;
}

// How many of the objects have their names right, and how many at best where all have one name: such a perceiver has
// read nothing. A place has the same names in every scene, and is none of these.
struct NamesFound {
  int right = 0;
  std::map<std::pair<std::string, std::string>, int> objects{};

  void add(const Instance& truth, const Observation& seen) {
    if (is_place(truth.object_type)) return;
    ++objects[{truth.object_type, truth.texture}];
    for (const Instance& said : seen.instances)
      if (said.id == truth.id) right += said.object_type == truth.object_type && said.texture == truth.texture;
  }
  int by_one_name() const {
    int most = 0;
    for (const auto& one : objects) most = std::max(most, one.second);
    return most;
  }
  int all() const {
    int sum = 0;
    for (const auto& one : objects) sum += one.second;
    return sum;
  }
};

// A perceiver in one environment: returns a hash of all that was read.
std::string read_scenes(const HostJob& job, const CheckPhase& phase, CheckReport& report) {
  const EnvironmentType& environment = find_environment(job.environment);
  const Scenario scenario = load_scenario(environment.tasks().front().example);
  const std::string doing = "read, " + job.environment;
  phase(doing, report);
  HostedPerturbation process(job);
  std::vector<std::string> bytes;
  std::vector<SeenScene> scenes = scenes_of(environment, scenario);
  int calls = 0;
  NamesFound named;
  double seconds = 0;
  const auto read = [&](const SeenScene& one) {
    const auto start = std::chrono::steady_clock::now();
    Observation seen = process.read(one.observation, scenario.space);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++calls;
    expect_perceived(seen, scenario.space);
    return seen;
  };
  try {
    for (const SeenScene& one : scenes) {
      const Observation seen = read(one);
      bytes.push_back(perceived_bytes(seen));
      for (const Instance& truth : one.observation.instances) named.add(truth, seen);
    }
    bool same = true;
    for (std::size_t i = scenes.size(); same && i-- > 0;) same = perceived_bytes(read(scenes[i])) == bytes[i];
    report.judge(doing, same ? "" : "a picture seen again, in another order, has other names",
                 "the same picture has the same names again",
                 "use no random numbers, and keep nothing from one call to the next");
    const std::string found = fmt::format("{} of {} objects as the simulator names them", named.right, named.all());
    if (named.right > named.by_one_name())
      report.ok("names, " + job.environment, found);
    else
      report.note("names, " + job.environment,
                  fmt::format("{}; one name for all would be right for {}", found, named.by_one_name()),
                  "a run with it measures its errors alone; return each segment of ids under its own number, with a "
                  "type and a texture of the space");
  } catch (const MethodError& e) {
    report.problem(doing, e.what(), "this call must succeed: a run makes it too");
  }
  judge_process(process, job.plugin.python.is_null(), report);
  report.ok("time, " + job.environment, fmt::format("{:.1f} ms a picture", 1e3 * seconds / std::max(calls, 1)));
  return sha256(fmt::format("{}", fmt::join(bytes, "\n")));
}

}  // namespace

CheckReport check_perturbation(HostJob job, const CheckPhase& phase) {
  const PerturbationAxis axis = read_axis(job.plugin.id, JsonReader(job.plugin.axis, job.plugin.file.string()));
  return in_environments(std::move(job), phase, [&](const HostJob& one, CheckReport& report) {
    return AxisCheck(one, axis, report).run(phase);
  });
}

CheckReport check_perceiver(HostJob job, const CheckPhase& phase) {
  return in_environments(std::move(job), phase,
                         [&](const HostJob& one, CheckReport& report) { return read_scenes(one, phase, report); });
}

}  // namespace lgabench
