#include <lgabench/cell/run_cell.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/answers.hpp>
#include <lgabench/cell/demonstrations.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/hosted_axes.hpp>
#include <lgabench/cell/instructing.hpp>
#include <lgabench/cell/perturbed.hpp>
#include <lgabench/cell/reference_actor.hpp>
#include <lgabench/cell/selected_by.hpp>
#include <lgabench/cell/selecting.hpp>
#include <lgabench/cell/showing.hpp>
#include <lgabench/cell/steps.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/hosted_method.hpp>
#include <lgabench/plugin/guarded.hpp>
#include <lgabench/record/cell_status.hpp>
#include <lgabench/record/kept_policy.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

// Seconds of each phase; a phase ends when the next begins.
class Phases {
 public:
  explicit Phases(const PhaseReport& report) : report_(report) {
    for (const std::string& phase : cell_phases) seconds_[phase + "_s"] = 0.0;
  }
  void begin(const std::string& phase) {
    end();
    phase_ = phase;
    start_ = Clock::now();
    report_(phase, 0);
  }
  void count(long long n) const { report_(phase_, n); }
  void in_line(bool begins) const { report_(begins ? in_line_phase : phase_, 0); }
  Json seconds() {
    end();
    return seconds_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  void end() {
    if (phase_.empty()) return;
    const double s = std::chrono::duration<double>(Clock::now() - start_).count();
    seconds_[phase_ + "_s"] = s;
    seconds_["total_s"] = seconds_["total_s"].get<double>() + s;
    phase_.clear();
  }

  const PhaseReport& report_;
  std::string phase_;
  Clock::time_point start_;
  Json seconds_{{"total_s", 0.0}};
};

// A plugin's method in a process of its own.
std::unique_ptr<HostedMethod> hosted(const CellJob& job, const PluginInfo& plugin, const Json& options,
                                     const fs::path& scratch) {
  HostJob host = host_job(job, plugin, options, scratch);
  host.debugger = job.debugger;
  host.task = job.cell.scenario->at("task").get<std::string>();
  host.may_stop = job.cell.scenario->value("may_stop", false);
  return std::make_unique<HostedMethod>(host);
}

// The cell's method; none for a row that learns nothing.
struct CellMethod {
  std::unique_ptr<Method> method;
  MethodInProcesses* processes = nullptr;  // the same object; null: no plugin's
};

// The plugin's, or two of which one selects; a reference row's, or none.
CellMethod make_method(const CellJob& job) {
  const auto in_directory = [&job](const PluginInfo& plugin, const Json& options, const char* name) {
    fs::create_directory(job.scratch / name);
    return hosted(job, plugin, options, job.scratch / name);
  };
  if (!job.method) return {reference_method(job.cell.method.id)};
  const Json& options = job.cell.method.options;
  std::unique_ptr<MethodInProcesses> method;
  if (job.acts)
    method = std::make_unique<SelectedBy>(in_directory(*job.method, options, "selects"), [&job, in_directory] {
      return in_directory(*job.acts, job.cell.method.acts->options, "acts");
    });
  else if (!job.axes.empty() || job.perceiver)  // each has a directory of its own: none reads what another writes
    method = in_directory(*job.method, options, "method");
  else
    method = hosted(job, *job.method, options, job.scratch);
  MethodInProcesses* const processes = method.get();
  return {std::move(method), processes};
}

DemonstrationCache demonstration_cache(const CellJob& job, const Scenario& scenario) {
  std::vector<std::string> take_part{"lgabench-worker", "liblgabench_core.so", job.cell.environment_in_build()};
  if (job.engine) take_part.emplace_back("engine");
  Json builds = Json::object();
  for (const std::string& name : take_part) builds[name] = JsonReader(job.build, "build").at(name).json();
  if (job.environment && !job.environment->python.is_null())
    builds["versions"] = job.environment->python.at("versions");
  const std::string world = scenario.environment->world_of(scenario);
  return {job.cache, builds,
          fmt::format("lgabench/{}-{}-v1{}{}", job.cell.environment, job.cell.engine, world.empty() ? "" : "/", world)};
}

// What is shown; none where the layout can show nothing of what was selected: the abstraction is empty.
std::vector<Scene> training_scenes(const Scenario& scenario, const Cell& cell, const Selected& selected) {
  try {
    return sample(scenario, cell.layout, selected, cell.training_seed, scenario.training_scenes(cell.demonstrations));
  } catch (const NothingToShow&) {
    Selected truth;  // throws again where the scenario is at fault
    truth.needs.targets = Needs::Targets::truth;
    sample(scenario, cell.layout, truth, cell.training_seed, scenario.training_scenes(1));
    return {};
  }
}

// What the method is given of demonstrations: seen through an axis and with names read, where the cell asks for that.
std::vector<Demonstration> as_given(std::vector<Demonstration> demonstrations, const std::vector<Scene>& scenes,
                                    const Scenario& scenario, const Cell& cell, const ReadPicture& reading) {
  if (cell.train_on) demonstrations = perceived(std::move(demonstrations), scenes, scenario, *cell.train_on);
  if (!reading) return demonstrations;
  for (std::size_t i = 0; i < demonstrations.size(); ++i)
    for_each_step(demonstrations[i], [&](Step& step) { step.observation = reading(step.observation, scenes.at(i)); });
  return demonstrations;
}

// What a reference row looks at: training scenes, though nobody demonstrates in them.
DemonstratedScenes shown_to(const Cell& cell, const Scenario& scenario) {
  Selected truth;
  truth.needs.targets = Needs::Targets::truth;
  return {sample(scenario, cell.layout, truth, cell.training_seed, scenario.training_scenes(cell.demonstrations)),
          scenario.second ? scenario.second->id : Role(), actions_of(scenario)};
}

// `empty`: of every scene, since nothing was learned.
std::vector<TestScene> test_scenes(const Scenario& scenario, const Cell& cell, bool empty, const Selected& selected) {
  std::vector<TestScene> scenes;
  for (const std::string& id : played_arms(scenario.json)) {
    for (int i = 0; i < cell.episodes; ++i) {
      const auto seed = cell.scenes_of_seed();
      TestScene test = in_its_arm(scenario, test_scene(scenario, cell.layout, id, cell.scene_seed, i, seed), seed);
      test.abstraction_empty = empty || selected.nothing_for(command_given(test.scene, scenario, seed));
      scenes.push_back(std::move(test));
    }
  }
  return scenes;
}

// Who is at fault for an action.
const std::string& acting_id(const Competitor& method) { return method.acts ? method.acts->id : method.id; }

// Who plays the test scenes: the policy, told what was selected, or a reference row; nobody where a method learned
// nothing, as then no scene is played. All arguments outlive it.
Actor actor_of(Policy* policy, const Method* method, const Scenario& scenario, const Cell& cell,
               const Selected& selected) {
  if (!policy) return method ? Actor() : reference_actor(cell.method.id, shown_to(cell, scenario));
  const auto told = [&](const Scene& scene) { return instruction_in(scene, scenario, cell, selected.instructions); };
  return policy_actor(*policy, told, acting_id(cell.method));
}

std::vector<Instruction> true_instructions(const Scenario& scenario) {
  std::vector<Instruction> all;
  for (const ScenarioCommand& command : scenario.commands) all.push_back({command.utterance, command.truth});
  return all;
}

using Files = std::vector<std::pair<std::string, std::string>>;  // names and bytes

// What the first act() that failed threw, "" where none did.
std::string first_error(const std::vector<Episode>& episodes) {
  constexpr std::size_t longest = 2000;
  for (const Episode& episode : episodes)
    if (episode.failure == failure::method_error) return one_line(episode.error.substr(0, longest));
  return "";
}

std::string episodes_text(const std::vector<Episode>& episodes) {
  std::string lines;
  for (const Episode& episode : episodes) lines += canonical(to_json(episode)) + '\n';
  return lines;
}

// What is kept of the policy: the file's text; "" where it is not to be, or cannot be, which the log says.
std::string policy_text(const CellJob& job, const Policy* policy) {
  if (!job.keeps_policy || !policy) return "";
  const Competitor& method = job.cell.method;
  const std::string& id = acting_id(method);
  std::string why = "the method cannot save it";
  try {
    if (const auto saved = guarded(id, [policy] { return policy->saved(); }))
      return to_text(KeptPolicy{id, method.acts ? method.acts->version : method.version, *saved});
  } catch (const MethodGone&) {
    throw;
  } catch (const Error& e) {
    why = one_line(e.what());
  }
  to_stdout("{} is not kept: {}\n", cell_file::policy, why);
  return "";
}

// Writes the files and, last, status.json with their hashes: a directory without it is not a result. Only the process
// `self` does: a plugin may have forked another one that came here as well.
void record(const CellJob& job, pid_t self, const Files& files, const Files& of_method,
            const std::vector<ShownScene>& shown, const std::string& policy, const std::string& error) {
  if (::getpid() != self) ::_exit(1);
  for (const auto& [name, bytes] : of_method) write_file(job.directory / "files" / name, bytes);
  if (!shown.empty()) write_file(job.directory / cell_file::shown, to_text(shown));
  if (!policy.empty()) write_file(job.directory / cell_file::policy, policy);
  CellStatus status;
  for (const auto& [name, bytes] : files) {
    write_file(job.directory / name, bytes);
    status.files[name] = sha256(bytes);
  }
  sync_directory(job.directory);
  status.build = job.build;
  status.method_error = error;
  write_cell_status(job.directory, status);
  sync_directory(job.directory);
}

}  // namespace

void run_cell(const CellJob& job, ChatClient* server, const PhaseReport& report) {
  const pid_t self = ::getpid();
  const Cell& cell = job.cell;
  const std::string& id = cell.method.id;
  const Scenario scenario = read_scenario(*cell.scenario, "cell: /scenario");
  if (data_hashes(scenario, cell.answers, cell.reading) != cell.data)
    throw InputError("cell: /data: the data directory changed since the run began");
  Phases phases(report);
  const auto count = [&phases](int n) { phases.count(n); };

  phases.begin("load");
  host_axes(scenario, job);
  const auto [method, processes] = make_method(job);
  const ReadPicture reading = method ? reading_in(scenario, job) : nullptr;

  // 1 select: which features does each command make matter?
  phases.begin("select");
  const Answers answers = answers_for(job, scenario, server, [&phases](bool begins) { phases.in_line(begins); });
  TrainingLines training(count);
  Services services{*answers.lm, *answers.human,       cell.method.options, cell.training_seed,
                    training,    actions_of(scenario), answers.truth};
  services.state = state_of(scenario);
  services.may_stop = scenario.may_stop;
  Selecting selecting(method.get(), scenario, cell, services);
  const Selected& selected = selecting.current();

  // 2 sample: what will be shown, with targets from the Selection or from the truth?
  phases.begin("sample");
  std::vector<Scene> scenes;
  if (method && !selecting.nothing_to_learn_from()) scenes = training_scenes(scenario, cell, selected);
  // Without demonstrations a method that needs none has its questions, and the words.
  const bool shows = !scenes.empty() || (method && cell.demonstrations == 0 && !selecting.nothing_to_learn_from());

  // 3 demonstrate: the oracle shows it.
  phases.begin("demonstrate");
  const auto environment = make_environment(scenario, load_engine(job.engine));
  if (selected.needs.shadows && cell.reading.segments != Reading::simulator)
    throw MethodError("needs() asks for shadows, which only the simulator's segmentation has");
  environment->show_shadows(selected.needs.shadows);
  auto demonstrations = instructed(cached_demonstrations(demonstration_cache(job, scenario), *environment, scenes,
                                                         selected.needs, scenario.utterances(), count),
                                   scenes, selected);
  demonstrations = as_given(std::move(demonstrations), scenes, scenario, cell, reading);

  // 4 learn: from observations and labels to a policy.
  phases.begin("learn");
  std::unique_ptr<Policy> policy;
  if (shows) selecting.revise(*method, demonstrations, scenes, services);
  if (shows && !selecting.nothing_to_learn_from()) policy = selecting.learn(*method, demonstrations, services);
  demonstrations.clear();

  // 5 evaluate: the same test scenes for everyone.
  phases.begin("evaluate");
  const std::vector<TestScene> tests = test_scenes(scenario, cell, method && !policy, selected);
  PerturbedLines perturbed(scenario, cell, selected.instructions, policy.get());
  Actor actor = actor_of(policy.get(), method.get(), scenario, cell, selected);
  actor.reads = reading;
  if (cell.perturbs()) actor.recorder = &perturbed;
  std::optional<Showing> showing;
  if (policy) showing.emplace(*policy, acting_id(cell.method));
  std::vector<Episode> episodes = evaluate(*environment, tests, actor, [&](int n) {
    count(n);
    if (showing) showing->played(tests[static_cast<std::size_t>(n) - 1]);
  });
  expect_declared(perturbed.episodes(), episodes, policy != nullptr, scenario);
  note_takings(scenario, cell, tests, episodes);
  const Files of_method = processes ? processes->files() : Files();  // from now on the method may be told the truth
  const std::string kept = policy_text(job, policy.get());
  if (job.attributed && selecting.is_attributable())
    attribute_failures(*environment, tests, actor, true_instructions(scenario), episodes);
  if (processes) guarded(id, [processes = processes] { processes->end(); });

  // 6 record: no clock but in timing.json.
  Files files{{cell_file::configuration, canonical(to_json(cell)) + '\n'},
              {cell_file::selections, selecting.text()},
              {cell_file::training, training.lines},
              {cell_file::episodes, episodes_text(episodes)},
              {cell_file::timing, canonical(phases.seconds()) + '\n'}};
  if (cell.perturbs()) files.emplace_back(cell_file::perturbed, perturbed.text());
  record(job, self, files, of_method, showing ? showing->scenes() : std::vector<ShownScene>(), kept,
         first_error(episodes));
}

}  // namespace lgabench
