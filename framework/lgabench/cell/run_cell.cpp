#include <lgabench/cell/run_cell.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include <lgabench/abstraction/quality.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/answers.hpp>
#include <lgabench/cell/constant_action.hpp>
#include <lgabench/cell/demonstrations.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/hosted_axes.hpp>
#include <lgabench/cell/perturbed.hpp>
#include <lgabench/cell/reference_actor.hpp>
#include <lgabench/cell/selected_by.hpp>
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
  return std::make_unique<HostedMethod>(host);
}

// The cell's method, or two of which one selects; the constant action, or none for a row that learns nothing.
std::unique_ptr<Method> make_method(const CellJob& job) {
  const auto own = [&job](const PluginInfo& plugin, const Json& options, const char* name) {
    fs::create_directory(job.scratch / name);
    return hosted(job, plugin, options, job.scratch / name);
  };
  if (job.method && job.acts) {
    return std::make_unique<SelectedBy>(own(*job.method, job.cell.method.options, "selects"),
                                        [&job, own] { return own(*job.acts, job.cell.method.acts->options, "acts"); });
  }
  // A plugin's axis has a directory of its own: what the one writes the other does not read.
  if (job.method && !job.axes.empty()) return own(*job.method, job.cell.method.options, "method");
  if (job.method) return hosted(job, *job.method, job.cell.method.options, job.scratch);
  if (job.cell.method.id == "constant_action") return std::make_unique<ConstantAction>();
  return nullptr;
}

DemonstrationCache demonstration_cache(const CellJob& job, const Scenario& scenario) {
  const std::vector<std::string> take_part{"engine", "lgabench-worker", "liblgabench_core.so",
                                           fmt::format("liblgabench_env_{}.so", job.cell.environment)};
  Json builds = Json::object();
  for (const std::string& name : take_part) builds[name] = JsonReader(job.build, "build").at(name).json();
  const std::string world = find_environment(job.cell.environment).world_of(scenario);
  return {job.cache, builds,
          fmt::format("lgabench/{}-{}-v1{}{}", job.cell.environment, job.cell.engine, world.empty() ? "" : "/", world)};
}

// What becomes of a cell.
enum class Course { trains, nothing_selected, reference };
Course course_of(const Method* method, const Selected& selected, const Scenario& scenario) {
  if (!method) return Course::reference;
  return selected.nothing_to_learn_from(scenario) ? Course::nothing_selected : Course::trains;
}

// What is shown. Where the layout can show nothing of what was selected, the abstraction is empty.
std::vector<Scene> training_scenes(const Scenario& scenario, const Cell& cell, const Selected& selected,
                                   Course& course) {
  if (course != Course::trains) return {};
  try {
    return sample(scenario, cell.layout, selected, cell.training_seed, scenario.training_scenes(cell.demonstrations));
  } catch (const NothingToShow&) {
    Selected truth;  // throws again where the scenario is at fault
    truth.needs.targets = Needs::Targets::truth;
    sample(scenario, cell.layout, truth, cell.training_seed, scenario.training_scenes(1));
    course = Course::nothing_selected;
    return {};
  }
}

// What a reference row looks at: training scenes, though nobody demonstrates in them.
DemonstratedScenes shown_to(const Cell& cell, const Scenario& scenario) {
  Selected truth;
  truth.needs.targets = Needs::Targets::truth;
  return {sample(scenario, cell.layout, truth, cell.training_seed, scenario.training_scenes(cell.demonstrations)),
          scenario.second ? scenario.second->id : Role(), actions_of(scenario)};
}

std::vector<TestScene> test_scenes(const Scenario& scenario, const Cell& cell, Course course,
                                   const Selected& selected) {
  std::vector<TestScene> scenes;
  for (const Arm& arm : scenario.tests) {
    const Perception perception = perception_of(scenario, arm, cell.scenes_of_seed());
    for (int i = 0; i < cell.episodes; ++i) {
      Scene scene = test_scene(scenario, cell.layout, arm.id, cell.scene_seed, i, cell.scenes_of_seed());
      const bool empty = course == Course::nothing_selected ||
                         selected.nothing_for(command_given(scene, scenario, cell.scenes_of_seed()));
      const View view = view_of(scenario, scene, cell.scenes_of_seed());
      scenes.push_back({std::move(scene), perception, empty, view});
    }
  }
  return scenes;
}

// Whether there is an abstraction that a failure can be attributed to.
bool selects(const Selected& selected) {
  return std::all_of(selected.instructions.begin(), selected.instructions.end(),
                     [](const Instruction& i) { return i.selection.provenance != Provenance::none; });
}

std::vector<Instruction> true_instructions(const Scenario& scenario) {
  std::vector<Instruction> all;
  for (const ScenarioCommand& command : scenario.commands) all.push_back({command.utterance, command.truth});
  return all;
}

// What the policy is told in a scene: with the errors of its arm's perturbation.
Instruction told_in(const Scene& scene, const Scenario& scenario, const Cell& cell,
                    const std::vector<Instruction>& instructions) {
  const int command = command_given(scene, scenario, cell.scenes_of_seed());
  Instruction told = instructions.at(static_cast<std::size_t>(command));
  const Arm& arm = scenario.arm(scene.arm);
  if (!arm.perturbation) return told;
  for (const PerturbationAxis* axis : axes_of(scenario, *arm.perturbation)) {
    if (!axis->selection_errors) continue;
    const double p = axis->selection_errors(arm.perturbation->level);
    told.selection = lgabench::with_errors(std::move(told.selection), scenario, command, SelectionErrors{p, p},
                                           perturbation_stream(axis->id, scene, cell.scenes_of_seed()),
                                           find_environment(scenario.environment).goal_type());
  }
  return told;
}

// Where an axis gives other commands: what each episode took, in the scene's own control as in every arm.
void note_takings(const Scenario& scenario, const Cell& cell, const std::vector<TestScene>& tests,
                  std::vector<Episode>& episodes) {
  const PerturbationAxis* const axis = instructing_axis(scenario);
  for (std::size_t i = 0; axis && i < episodes.size(); ++i) {
    const Scene& scene = tests.at(i).scene;
    const int other = axis->other(scene, scenario, perturbation_stream(axis->id, scene, cell.scenes_of_seed()));
    episodes[i].told = command_given(scene, scenario, cell.scenes_of_seed());
    episodes[i].took = "none";
    for (const SceneObject& object : scene.objects)
      if (object.instance_id == episodes[i].taken)
        episodes[i].took = object.role == role::target                                         ? "own"
                           : means(scenario.commands[static_cast<std::size_t>(other)], object) ? "other"
                                                                                               : "third";
  }
}

// Hash of what the policy's last act() read; "" where it does not tell.
std::string read_by(const Policy& policy, const std::string& id) {
  try {
    const Shown shown = guarded(id, [&policy] { return policy.shown(); });
    if (shown.empty()) return "";
    std::string all;
    for (const ShownPicture& one : shown.pictures)
      all += fmt::format("{} {} {}\n", one.name, one.note, sha256(std::string(one.rgb.begin(), one.rgb.end())));
    for (const auto& text : shown.texts) all += canonical(Json(text)) + '\n';
    return hex(hash64(all));
  } catch (const MethodError&) {
    return "";
  }
}

// Notes of each episode what the actor is given.
Actor noting(const Actor& actor, const Scenario& scenario, const Cell& cell, const Selected& selected, Policy* policy,
             std::vector<PerturbedEpisode>& all) {
  return [&, actor, policy](const Environment& environment, const Scene& scene, const Observation& seen) {
    const auto& perturbation = scenario.arm(scene.arm).perturbation;
    const Scene control =
        find_environment(scenario.environment)
            .sample(scenario, {cell.layout, "test", scene.arm, cell.scene_seed, {}, cell.scenes_of_seed()},
                    scene.index);
    const SceneObject* const target = scene.find(role::target);
    PerturbedEpisode one{scene.arm,
                         scene.index,
                         perturbation ? perturbation->axis : "",
                         perturbation ? perturbation->level : 0,
                         {},
                         "",
                         target ? target->scale : 1};
    const Instruction told = told_in(scene, scenario, cell, selected.instructions);
    const int command = command_given(scene, scenario, cell.scenes_of_seed());
    one.hashes = parts_of({scene, environment.bodies(), control}, seen,
                          policy ? &selected.instructions.at(static_cast<std::size_t>(command)) : nullptr,
                          policy ? &told : nullptr);
    all.push_back(one);
    const Move move = actor(environment, scene, seen);
    if (policy) all.back().read = read_by(*policy, cell.method.id);
    return move;
  };
}

std::string perturbed_text(const std::vector<PerturbedEpisode>& all) {
  std::string lines;
  for (const PerturbedEpisode& one : all) lines += canonical(to_json(one)) + '\n';
  return lines;
}

using Files = std::vector<std::pair<std::string, std::string>>;  // names and bytes

// What the first act() that failed threw, "" where none did.
std::string first_error(const std::vector<Episode>& episodes) {
  constexpr std::size_t longest = 2000;
  for (const Episode& episode : episodes)
    if (episode.failure == failure::method_error) return one_line(episode.error.substr(0, longest));
  return "";
}

// What was selected with the errors that the cell asks for: what is learned from and acted on.
Selected with_errors(Selected selected, const Scenario& scenario, const Cell& cell) {
  const std::string goal = find_environment(scenario.environment).goal_type();
  for (std::size_t c = 0; c < selected.instructions.size(); ++c) {
    Selection& selection = selected.instructions[c].selection;
    selection = lgabench::with_errors(std::move(selection), scenario, static_cast<int>(c), cell.selection_errors,
                                      cell.training_seed, goal);
  }
  return selected;
}

// `first`: what select() returned, from which the targets were drawn; `right`: what was selected in the end, without
// the cell's errors.
std::string selection_text(const Scenario& scenario, const Cell& cell, const Selected& selected,
                           const std::vector<Instruction>& first, const std::vector<Instruction>& right) {
  const Json shown = find_environment(scenario.environment)
                         .shown_members(scenario, {cell.layout, "train", "train", cell.training_seed});
  Json commands = Json::array();
  for (std::size_t c = 0; c < scenario.commands.size(); ++c) {
    const auto& [utterance, selection] = selected.instructions[c];
    commands.push_back({{"utterance", utterance},
                        {"selection", to_json(selection)},
                        {"quality", to_json(quality(selection, scenario.commands[c].truth))}});
    if (Json before = distribution_json(first[c].selection); before != distribution_json(right[c].selection))
      commands.back()["before_revision"] = std::move(before);
    if (!cell.selection_errors.none() && selection.provenance != Provenance::none)
      commands.back()["before_errors"] = distribution_json(right[c].selection);
    if (!shown.is_null()) commands.back()["shown"] = shown.at(c);
  }
  return canonical({{"commands", commands}}) + '\n';
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
  const std::string id = method.acts ? method.acts->id : method.id;
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
  if (data_hashes(scenario, cell.answers) != cell.data)
    throw InputError("cell: /data: the data directory changed since the run began");
  Phases phases(report);
  const auto count = [&phases](int n) { phases.count(n); };

  phases.begin("load");
  host_axes(scenario, job);
  const std::unique_ptr<Method> method = make_method(job);

  // 1 select: which features does each command make matter?
  phases.begin("select");
  const Answers answers = answers_for(job, scenario, server, [&phases](bool begins) { phases.in_line(begins); });
  TrainingLines training(count);
  Services services{*answers.lm, *answers.human,       cell.method.options, cell.training_seed,
                    training,    actions_of(scenario), answers.truth};
  Selected selected = select(method.get(), id, scenario, services);
  for (const Instruction& instruction : selected.instructions) expect_usable(instruction.selection, scenario);
  const std::vector<Instruction> first = selected.instructions;
  std::vector<Instruction> right = first;  // without the cell's errors, which are made in what is selected last
  if (!selected.needs.revise) selected = with_errors(std::move(selected), scenario, cell);
  Course course = course_of(method.get(), selected, scenario);

  // 2 sample: what will be shown, with targets from the Selection or from the truth?
  phases.begin("sample");
  const std::vector<Scene> scenes = training_scenes(scenario, cell, selected, course);

  // 3 demonstrate: the oracle shows it.
  phases.begin("demonstrate");
  const auto environment = make_environment(scenario, load_engine(job.engine));
  environment->show_shadows(selected.needs.shadows);
  auto demonstrations = instructed(cached_demonstrations(demonstration_cache(job, scenario), *environment, scenes,
                                                         selected.needs, scenario.utterances(), count),
                                   scenes, selected);
  if (cell.train_on) demonstrations = perceived(std::move(demonstrations), scenes, scenario, *cell.train_on);

  // 4 learn: from observations and labels to a policy.
  phases.begin("learn");
  std::unique_ptr<Policy> policy;
  if (course == Course::trains) {
    revise(*method, id, scenario, demonstrations, scenes, services, selected);
    if (selected.needs.revise) {
      right = selected.instructions;
      selected = with_errors(std::move(selected), scenario, cell);
      demonstrations = instructed(std::move(demonstrations), scenes, selected);
      course = course_of(method.get(), selected, scenario);
    }
  }
  if (course == Course::trains) {
    policy = learn(*method, id, demonstrations, services, selected);
  }
  demonstrations.clear();

  // 5 evaluate: the same test scenes for everyone.
  phases.begin("evaluate");
  const std::vector<TestScene> tests = test_scenes(scenario, cell, course, selected);
  const bool perturbs = cell.perturbs();
  const auto told = [&](const Scene& scene) { return told_in(scene, scenario, cell, selected.instructions); };
  const Actor actor = policy && perturbs            ? policy_actor(*policy, told, id)
                      : policy                      ? policy_actor(*policy, selected.instructions, id)
                      : course == Course::reference ? reference_actor(id, shown_to(cell, scenario))
                                                    : Actor();
  std::optional<Showing> showing;
  if (policy) showing.emplace(*policy, id);
  std::vector<PerturbedEpisode> perturbed;
  const Actor noted = perturbs && actor ? noting(actor, scenario, cell, selected, policy.get(), perturbed) : actor;
  std::vector<Episode> episodes = evaluate(*environment, tests, noted, [&](int n) {
    count(n);
    if (showing) showing->played(tests[static_cast<std::size_t>(n) - 1]);
  });
  expect_declared(perturbed, episodes, policy != nullptr, axes_in(scenario));
  note_takings(scenario, cell, tests, episodes);
  auto* const hosted = dynamic_cast<MethodInProcesses*>(method.get());
  const Files of_method = hosted ? hosted->files() : Files();  // from now on the method may be told the truth
  const std::string kept = policy_text(job, policy.get());
  const std::vector<Instruction> truth = true_instructions(scenario);
  const Actor with_truth = policy ? policy_actor(*policy, truth, id) : Actor();
  if (job.attributed && selects(selected)) attribute_failures(*environment, tests, actor, with_truth, episodes);
  if (hosted) guarded(id, [&] { hosted->end(); });

  // 6 record: no clock but in timing.json.
  Files files{{cell_file::configuration, canonical(to_json(cell)) + '\n'},
              {cell_file::selections, selection_text(scenario, cell, selected, first, right)},
              {cell_file::training, training.lines},
              {cell_file::episodes, episodes_text(episodes)},
              {cell_file::timing, canonical(phases.seconds()) + '\n'}};
  if (perturbs) files.emplace_back(cell_file::perturbed, perturbed_text(perturbed));
  record(job, self, files, of_method, showing ? showing->scenes() : std::vector<ShownScene>(), kept,
         first_error(episodes));
}

}  // namespace lgabench
