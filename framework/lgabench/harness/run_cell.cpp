#include <lgabench/harness/run_cell.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <lgabench/abstraction/quality.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/constant_action.hpp>
#include <lgabench/harness/demonstrations.hpp>
#include <lgabench/harness/environments.hpp>
#include <lgabench/harness/evaluator.hpp>
#include <lgabench/host/hosted_method.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

// Seconds of each phase; a phase ends when the next begins.
class Phases {
 public:
  explicit Phases(const PhaseReport& report) : report_(report) {}
  void begin(const std::string& phase) {
    end();
    phase_ = phase;
    start_ = Clock::now();
    report_(phase, 0);
  }
  void count(long long n) const { report_(phase_, n); }
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
  Json seconds_{{"select_s", 0.0}, {"sample_s", 0.0},   {"demonstrate_s", 0.0},
                {"learn_s", 0.0},  {"evaluate_s", 0.0}, {"total_s", 0.0}};
};

// training.jsonl as it grows.
class TrainingLines : public TrainingLog {
 public:
  explicit TrainingLines(const Phases& phases) : phases_(phases) {}
  void epoch(int epochs, long long steps, double loss) override {
    if (!std::isfinite(loss))
      throw MethodError(fmt::format("training diverged: the loss of epoch {} is {}", epochs, loss));
    lines += canonical({{"epoch", epochs}, {"steps", steps}, {"loss", loss}}) + '\n';
    phases_.count(epochs);
  }
  std::string lines;

 private:
  const Phases& phases_;
};

// The plugin's method in a process of its own, the constant action, or none for a row that learns nothing.
std::unique_ptr<Method> make_method(const CellJob& job) {
  if (job.method) {
    HostJob host{*job.method,
                 job.cell.method.options,
                 job.cell.training_seed,
                 job.scratch,
                 job.confined,
                 {job.directory.parent_path().parent_path(), job.cache, job.answers, job.scratch.parent_path()},
                 job.memory_bytes};
    if (!job.live.cassette.empty()) host.hidden.push_back(job.live.cassette);
    host.debugger = job.debugger;
    return std::make_unique<HostedMethod>(host);
  }
  if (job.cell.method.id == "constant_action") return std::make_unique<ConstantAction>();
  return nullptr;
}

DemonstrationCache demonstration_cache(const CellJob& job) {
  Json builds = job.build;
  for (const char* no_part_in_it : {"method", "python", "lgabench-method", "liblgabench_learning.so"})
    builds.erase(no_part_in_it);
  return {job.cache, builds, fmt::format("lgabench/{}-{}-v1", job.cell.environment, job.cell.engine)};
}

// A plugin may return anything; only names of the space can be shown and counted, only finite costs added up.
void expect_usable(const Scenario& scenario, const Selection& selection) {
  constexpr std::size_t longest = 2000;
  const auto& [queries, tokens, lm_seconds, human_seconds] = selection.cost;
  if (queries < 0 || tokens < 0 || !(lm_seconds >= 0) || !(human_seconds >= 0) ||
      !std::isfinite(lm_seconds + human_seconds))
    throw MethodError(
        fmt::format("selection: /cost: expected finite numbers, none below 0, got {} queries, {} tokens, "
                    "{} s of a model and {} s of people",
                    queries, tokens, lm_seconds, human_seconds));
  for (const std::string* words : {&selection.source, &selection.asked_as})
    if (words->size() > longest || one_line(*words) != *words)
      throw MethodError(fmt::format("selection: /source and /asked_as: expected a line of at most {} bytes", longest));
  try {
    const Json json = distribution_json(selection);
    read_distribution(JsonReader(json, "selection"), scenario.space, scenario.second);
  } catch (const InputError& e) {
    throw MethodError(e.what());
  }
}

std::vector<TestScene> test_scenes(const Scenario& scenario, const Cell& cell) {
  std::vector<TestScene> scenes;
  for (const Arm& arm : scenario.tests)
    for (int i = 0; i < cell.episodes; ++i)
      scenes.push_back({test_scene(scenario, cell.layout, arm.id, cell.scene_seed, i, cell.scenes_of_seed()),
                        {arm.label_noise, arm.missed_segment}});
  return scenes;
}

// What the first act() that failed threw, "" where none did.
std::string first_error(const std::vector<Episode>& episodes) {
  constexpr std::size_t longest = 2000;
  for (const Episode& episode : episodes)
    if (episode.failure == failure::method_error) return one_line(episode.error.substr(0, longest));
  return "";
}

// Writes the files and, last, status.json with their hashes: a directory without it is not a result. Only the process
// `self` does: a plugin may have forked another one that came here as well.
void record(const CellJob& job, pid_t self, const std::vector<std::pair<std::string, std::string>>& files,
            const std::string& error) {
  if (::getpid() != self) ::_exit(1);
  Json hashes = Json::object();
  for (const auto& [name, bytes] : files) {
    write_file(job.directory / name, bytes);
    hashes[name] = sha256(bytes);
  }
  sync_directory(job.directory);
  Json status{{"state", "ok"}, {"build", job.build}, {"files", hashes}};
  if (!error.empty()) status["method_error"] = error;
  write_file(job.directory / "status.json", canonical(status) + '\n');
  sync_directory(job.directory);
}

}  // namespace

void run_cell(const CellJob& job, const PhaseReport& report) {
  const pid_t self = ::getpid();
  const Cell& cell = job.cell;
  const Scenario scenario = read_scenario(cell.scenario, "cell: /scenario");
  if (data_hashes(scenario, cell.answers) != cell.data)
    throw InputError("cell: /data: the data directory changed since the run began");
  const std::string& id = cell.method.id;
  Phases phases(report);

  // 1 select: which features does each command make matter?
  phases.begin("select");
  const std::unique_ptr<Method> method = make_method(job);
  const Answers answers = answers_for(cell, scenario, job.answers, job.live);
  TrainingLines training(phases);
  Services services{*answers.lm, *answers.human, cell.method.options, cell.training_seed, training, answers.truth};
  Needs needs;
  std::vector<Instruction> instructions;
  if (method) needs = guarded(id, [&] { return method->needs(services.options); });
  for (std::size_t c = 0; c < scenario.commands.size(); ++c) {
    const Command command = scenario.command(static_cast<int>(c));
    Selection selection;
    if (method) selection = guarded(id, [&] { return method->select(command, scenario.space, services); });
    expect_usable(scenario, selection);
    instructions.push_back({command.utterance, std::move(selection)});
  }
  const bool on_selected = method && needs.targets == Needs::Targets::selected;
  const auto is_empty = [&](int c) {
    return on_selected && instructions[static_cast<std::size_t>(c)].selection.empty();
  };
  const std::vector<int> seen = scenario.commands_of("train");
  const bool abstraction_empty = std::any_of(seen.begin(), seen.end(), is_empty);  // nothing to show for a command
  const bool learns = method && !abstraction_empty;

  // 2 sample: what will be shown, with targets from the Selection or from the truth?
  phases.begin("sample");
  std::vector<Selection> selections;
  if (on_selected)
    for (const Instruction& instruction : instructions) selections.push_back(instruction.selection);
  std::vector<Scene> scenes;
  if (learns)
    for (int i = 0; i < scenario.training_scenes(cell.demonstrations); ++i)
      scenes.push_back(training_scene(scenario, cell.layout, selections, cell.training_seed, i));

  // 3 demonstrate: the oracle shows it.
  phases.begin("demonstrate");
  const auto environment = make_environment(scenario, load_engine(job.engine));
  std::vector<Demonstration> demonstrations = cached_demonstrations(
      demonstration_cache(job), *environment, scenes, needs, scenario.utterances(), [&](int n) { phases.count(n); });
  for (std::size_t i = 0; i < demonstrations.size(); ++i)
    demonstrations[i].instruction = instructions[static_cast<std::size_t>(scenes[i].command)];

  // 4 learn: from observations and labels to a policy.
  phases.begin("learn");
  std::unique_ptr<Policy> policy;
  if (learns) {
    const SelectionCost before = answers.lm->cost();
    policy = guarded(id, [&] { return method->learn(demonstrations, services); });
    instructions.front().selection.cost += answers.lm->cost() - before;  // nobody else's: it may ask of any command
    if (!policy) throw MethodError(fmt::format("plugin {}: learn returned no policy", id));
  }
  demonstrations.clear();

  // 5 evaluate: the same test scenes for everyone.
  phases.begin("evaluate");
  std::vector<TestScene> tests = test_scenes(scenario, cell);
  for (TestScene& test : tests) test.abstraction_empty = abstraction_empty || is_empty(test.scene.command);
  const Actor actor = policy              ? policy_actor(*policy, instructions, id)
                      : abstraction_empty ? Actor()
                                          : reference_actor(id);
  std::vector<Episode> episodes = evaluate(*environment, scenario.space, tests, actor, [&](int n) { phases.count(n); });
  // What the method shows of itself is taken here: from now on it may be told the truth.
  auto* const hosted = dynamic_cast<HostedMethod*>(method.get());
  const auto files = hosted ? hosted->files() : std::vector<std::pair<std::string, std::string>>();
  const auto selects = [](const Instruction& i) { return i.selection.provenance != Provenance::none; };
  if (std::all_of(instructions.begin(), instructions.end(), selects)) {  // else there is no abstraction to blame
    std::vector<Instruction> true_ones;
    for (const ScenarioCommand& command : scenario.commands) true_ones.push_back({command.utterance, command.truth});
    attribute_failures(*environment, scenario.space, tests, policy ? policy_actor(*policy, true_ones, id) : Actor(),
                       episodes);
  }

  if (hosted) guarded(id, [&] { hosted->end(); });

  // 6 record: no clock but in timing.json.
  std::string episode_lines;
  for (const Episode& episode : episodes) episode_lines += canonical(to_json(episode)) + '\n';
  Json commands = Json::array();
  for (std::size_t c = 0; c < instructions.size(); ++c)
    commands.push_back({{"utterance", instructions[c].utterance},
                        {"selection", to_json(instructions[c].selection)},
                        {"quality", quality(instructions[c].selection, scenario.commands[c].truth)}});
  for (const auto& [name, bytes] : files) write_file(job.directory / "files" / name, bytes);
  record(job, self,
         {{"cell.json", canonical(to_json(cell)) + '\n'},
          {"selection.json", canonical({{"commands", commands}}) + '\n'},
          {"training.jsonl", training.lines},
          {"episodes.jsonl", episode_lines},
          {"timing.json", canonical(phases.seconds()) + '\n'}},
         first_error(episodes));
}

}  // namespace lgabench
