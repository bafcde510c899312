#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <utility>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/answering.hpp>
#include <lgabench/cell/bench.hpp>
#include <lgabench/cell/check.hpp>
#include <lgabench/cell/demonstrations.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/runs_below.hpp>
#include <lgabench/cell/steps.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/host/hosted_method.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

constexpr int demonstrations = 10;
constexpr std::uint64_t seed = Bench::seed;
constexpr const char* determinism =
    "draw all random numbers from services.seed; use no clock, address, uninitialised value or number of threads";

// What one use of the method, from loading to acting, gave: as text, bit for bit.
struct Use {
  std::string selections, training, actions;
};

// A policy as a run keeps it, and how it acted on the first bench.
struct Kept {
  std::optional<std::string> bytes;
  std::vector<Instruction> instructions;
  std::vector<std::string> actions;
};

// How many numbers of actions were outside of their bounds, and one of them in words.
struct Outside {
  int numbers = 0;
  std::string example;

  void note(const ActionSpace& space, const Action& action) {
    for (std::size_t i = 0; i < space.size(); ++i) {
      const ActionNumber& one = space.numbers[i];
      // Of a rotation the length does not matter.
      const auto turns = [i](const std::vector<std::size_t>& rotation) { return contains(rotation, i); };
      if (std::any_of(space.rotations.begin(), space.rotations.end(), turns)) continue;
      if (action[i] >= one.low && action[i] <= one.high) continue;
      if (numbers++ == 0)
        example = fmt::format("{} = {:g} {}, of {:g} to {:g}", one.name, action[i], one.unit, one.low, one.high);
    }
  }
};

// The numbers of the scene's actions as text, of several steps those of the whole episode. @throws MethodError where
// one cannot be carried out.
std::string action_text(const Actor& actor, const Bench& bench, const Sight& sight, Outside* outside = nullptr) {
  Environment& environment = *bench.environment;
  const ActionSpace& space = environment.action_space();
  const bool is_one = environment.most_steps() == 1;
  if (!is_one) environment.reset(sight.scene);
  Observation seen = sight.observation;
  std::string text;
  for (int step = 0;; ++step) {
    const Move move = actor.act(environment, sight.scene, seen, step);
    if (move.action.empty() && bench.scenario.may_stop) return text + "done";
    executable(space, move.action);
    if (outside) outside->note(space, move.action);
    for (const double value : as_stored(space, move.action)) text += fmt::format("{:a} ", value);
    if (is_one) return text;
    StepResult result = environment.step(move.action);
    if (result.terminated || result.truncated) return text;
    seen = std::move(result.observation);
  }
}

// In a process of its own, as where a kept policy is opened.
void judge_restored(const HostJob& job, const Kept& kept, const Bench& bench, CheckReport& report) {
  if (!kept.bytes) return report.ok("saved policy", "none: run --keep-policy leaves this method out");
  std::string fault;
  try {
    HostedMethod method(job);
    const std::unique_ptr<Policy> policy = method.restore(*kept.bytes);
    const Actor actor = policy_actor(*policy, kept.instructions, job.plugin.id);
    for (std::size_t i = 0; i < kept.actions.size(); ++i)
      if (action_text(actor, bench, bench.sights[i]) != kept.actions[i])
        throw MethodError("once restored, act() gives another action");
  } catch (const std::exception& e) {
    fault = e.what();
  }
  report.judge("saved policy", fault,
               fmt::format("{} bytes, from which another process acts alike", kept.bytes->size()),
               "saved() must hold all that act() depends on, and restore() must bring it back");
}

// The method runs in one process from first to last, confined as in a run.
class MethodCheck {
 public:
  MethodCheck(const HostJob& job, const CheckPhase& phase) : job_(job), phase_(phase), method_(job) {}

  /// None where the method did not come so far.
  const std::optional<Kept>& kept() const { return kept_; }

  CheckReport run(const std::vector<std::unique_ptr<Bench>>& benches) {
    report_.ok("environment", job_.environment);
    try {
      const Use first = use(benches, true);
      const long long between = heap_bytes();
      const Use second = use(benches, false);
      judge_repetition(first, second, heap_bytes() - between);
    } catch (const PluginError&) {
      throw;
    } catch (const EngineError&) {
      throw;
    } catch (const MethodGone&) {
      throw;
    } catch (const std::exception& e) {
      report_.problem(doing_, e.what() + undeclared_option(e.what()), "this call must succeed: a run makes it too");
    }
    if (is_library() && !method_.is_broken()) judge_process();  // broken: what broke it is the finding
    judge_processes();
    note_refused_calls();
    report_.ok("time", fmt::format("select {:.3f} s, learn {:.2f} s from {} demonstrations, act {:.2f} ms",
                                   seconds_["select"], seconds_["learn"], demonstrations, 1e3 * seconds_["act"]));
    return std::move(report_);
  }

 private:
  // A library can be looked at in its process. Python's has threads, files and a heap of the interpreter's.
  bool is_library() const { return job_.plugin.python.is_null(); }

  void begin(const std::string& what) { phase_(doing_ = what, report_); }

  // Says what comes, does it, notes how long it took.
  template <class Call>
  auto timed(const std::string& what, Call&& c) {
    begin(what);
    const auto start = std::chrono::steady_clock::now();
    auto result = c();
    seconds_[what] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
  }

  void judge_process() {
    begin("destroy policy and method");  // which a call that threw left there
    method_.drop_policy();
    method_.drop_method();
    judge_leftovers(report_, [this] { return method_.state(); });
    judge_arithmetic(report_, method_.state());
  }

  // What it started, and nobody waited for.
  void judge_processes() {
    const std::vector<std::string> left = left_behind([this] { return method_.processes(); });
    report_.judge("processes", left.empty() ? "" : fmt::format("left behind: {}", fmt::join(left, ", ")),
                  "none left behind", "wait for every process before the call that started it returns");
  }

  // What a lookup of an option that the descriptor lacks throws, in either language, does not say.
  std::string undeclared_option(const std::string& error) const {
    std::smatch found;
    static const std::regex lookup(R"((?:out_of_range\.403\] key |KeyError: )'([^']*)')");
    if (!std::regex_search(error, found, lookup) || job_.options.contains(found[1].str())) return "";
    std::vector<std::string> declared;
    for (const auto& option : job_.options.items()) declared.push_back(option.key());
    return fmt::format("; options declared: {}",
                       declared.empty() ? "none" : fmt::format("{}", fmt::join(declared, ", ")));
  }

  void note_refused_calls() {
    const std::vector<std::string> names = method_.refused_calls();
    if (names.empty())
      report_.ok("system calls", "none refused");
    else
      report_.note("system calls", fmt::format("refused: {}", fmt::join(names, ", ")),
                   "a method may make only the calls listed in docs/trust.md; handle the refusal, or avoid the call");
  }

  long long heap_bytes() const { return is_library() ? method_.state().heap_bytes : 0; }

  // One line of what the call throws; "" if nothing.
  std::string thrown(const std::function<void()>& c) {
    try {
      c();
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  }

  // The steps of a cell, but for the record.
  Use use(const std::vector<std::unique_ptr<Bench>>& benches, bool judged) {
    Use use;
    for (const auto& bench : benches) {
      const bool first = judged && bench == benches.front();
      Answering asked(bench->scenario, job_, demonstrations);
      Selected selected = select_all(bench->scenario, asked, "select");
      if (selected.needs.shadows) bench->look_again(selected.needs);
      if (first) judge_selection(selected, asked.model.asked, bench->scenario);
      for (const Instruction& instruction : selected.instructions)
        use.selections += canonical(distribution_json(instruction.selection)) + '\n';
      if (first) judge_other_commands(selected.needs, *bench);
      const std::vector<Scene> scenes = training_scenes(*bench, selected);
      if (scenes.empty()) {
        note_empty(*bench, judged);
        begin("destroy the method");
        method_.drop_method();
        continue;
      }
      if (!is_library() && job_.plugin.python.value("selects_alone", false)) {
        if (first)
          report_.ok("learn",
                     fmt::format("none: the method only selects, as --methods {}{} asks", selected_by, job_.plugin.id));
        begin("destroy the method");
        method_.drop_method();
        continue;
      }
      const auto policy = learn_from(*bench, asked, selected, scenes);
      if (first && job_.plugin.asks == "accept") judge_asking(selected);
      for (const Instruction& instruction : selected.instructions)
        use.selections += canonical(distribution_json(instruction.selection)) + '\n';
      if (first && asked.log.lines.empty())
        report_.note("training log", "learn() reported nothing", "call services.log.epoch() after each pass");
      use.training += asked.log.lines;
      begin("destroy the method");
      method_.drop_method();  // a policy may outlive it
      const Actor actor = policy_actor(*policy, selected.instructions, job_.plugin.id);
      std::vector<std::string> actions;
      for (const Sight& sight : bench->sights)
        actions.push_back(act(bench->is_seen(sight) ? "act" : "act on an unseen command", actor, *bench, sight));
      for (const std::string& action : actions) use.actions += action + '\n';
      if (judged) judge_policy(actor, *bench, actions, first);
      if (first) {
        begin("saved");
        kept_ = {policy->saved(), selected.instructions, actions};
      }
      if (first && selected.needs.targets == Needs::Targets::truth) judge_without_selection(*policy, *bench);
      begin("destroy the policy");
      method_.drop_policy();
    }
    return use;
  }

  Selected select_all(const Scenario& scenario, Answering& asked, const std::string& what) {
    return timed(what, [&] { return select(&method_, job_.plugin.id, scenario, asked.services); });
  }

  // What is to be demonstrated; nothing where a run would end the cell as abstraction_empty.
  std::vector<Scene> training_scenes(const Bench& bench, const Selected& selected) {
    begin("demonstrations that needs() asks for");
    if (selected.nothing_to_learn_from(bench.scenario)) return {};
    try {
      return sample(bench.scenario, bench.layout, selected, seed, demonstrations);
    } catch (const NothingToShow&) {
      return {};
    }
  }

  void note_empty(const Bench& bench, bool judged) {
    if (judged)
      report_.note("abstraction_empty",
                   fmt::format("select() returned nothing that can be shown for {}: a run ends this cell as "
                               "abstraction_empty, and learn() and act() were not tried on it",
                               bench.scenario.id),
                   "give options with which select() finds something here, or name another environment");
  }

  std::unique_ptr<Policy> learn_from(const Bench& bench, Answering& asked, Selected& selected,
                                     const std::vector<Scene>& scenes) {
    std::vector<Demonstration> shown = instructed(
        demonstrate(*bench.environment, scenes, selected.needs, bench.scenario.utterances()), scenes, selected);
    begin("revise");
    revise(method_, job_.plugin.id, bench.scenario, shown, scenes, asked.services, selected);
    return timed("learn", [&] { return learn(method_, job_.plugin.id, shown, asked.services, selected); });
  }

  std::string act(const std::string& what, const Actor& actor, const Bench& bench, const Sight& sight) {
    return timed(what, [&] { return action_text(actor, bench, sight, &outside_); });
  }

  void judge_selection(const Selected& selected, int asked, const Scenario& scenario) {
    const Selection& selection = selected.instructions.front().selection;
    const bool selects = selection.provenance != Provenance::none;
    std::string fault = thrown([&] { expect_usable(selection, scenario); });
    if (fault.empty() && !selects && selected.needs.targets == Needs::Targets::selected)
      fault = "needs() asks for scenes of the method's own Selection, and select() returns none";
    report_.judge("Selection", fault,
                  selects ? "names of the space, provenance " + to_string(selection.provenance)
                          : "selects nothing, as needs() says",
                  "take names from the FeatureSpace, or return {Needs::Targets::truth} from needs() and a Selection() "
                  "from select()");
    report_.ok("cost", asked > 0 ? fmt::format("{} questions asked", asked) : "services.lm was not asked");
  }

  // What a person was asked by the end of revise(). A method that may ask nothing shows nothing of how it asks.
  void judge_asking(const Selected& selected) {
    int shown = 0;
    for (const Instruction& instruction : selected.instructions) shown += instruction.selection.cost.human_queries;
    if (shown > 0)
      report_.ok("person", fmt::format("asked, at the price of {} objects shown", shown));
    else if (job_.options.value("questions", Json(1)) == 0)
      report_.note("person", "services.human was not asked: questions=0", "check it with --set questions=12 too");
    else
      report_.note("person", "services.human was not asked", "return true in needs().revise, and ask in revise()");
  }

  // Commands of other kinds than the first: nothing fits, and those that speak of a second set.
  void judge_other_commands(const Needs& needs, const Bench& bench) {
    Answering nobody(bench.scenario, job_, demonstrations, true);
    std::string fault = thrown([&] { select_all(bench.scenario, nobody, "select with every answer no"); });
    report_.judge("empty Selection", fault.empty() ? "" : "select() threw: " + fault,
                  "select() handles a language model that answers no to everything",
                  "return the empty Selection: the host counts such a cell as failed by the abstraction");
    for (const TaskInfo& task : find_environment(job_.environment).tasks())
      if (task.second) judge_second_set(needs, task);
  }

  void judge_second_set(const Needs& needs, const TaskInfo& task) {
    const Scenario scenario = load_scenario(task.example);
    Answering asked(scenario, job_, demonstrations);
    Selection both;
    const std::string fault =
        thrown([&] { both = select_all(scenario, asked, "select for " + task.id).instructions.front().selection; });
    const bool half = needs.targets == Needs::Targets::selected && !both.second;
    if (fault.empty() && half)
      report_.note(task.id,
                   fmt::format("the Selection says nothing of {}: cells of {} scenarios will fail", task.second->phrase,
                               task.id),
                   "set `second` where the command has one");
    else
      report_.judge(task.id, fault.empty() ? "" : "select() threw: " + fault,
                    fmt::format("select() handles a {} command", task.id),
                    "commands of every task are given to select()");
  }

  // A cell with nothing selected for a command that is only tested.
  void judge_without_selection(Policy& policy, const Bench& bench) {
    const std::vector<Instruction> nothing(bench.scenario.commands.size(), {bench.scenario.command(0).utterance, {}});
    const Actor actor = policy_actor(policy, nothing, job_.plugin.id);
    const std::string fault = thrown([&] { act("act with an empty Selection", actor, bench, bench.sights.front()); });
    report_.judge("act with an empty Selection", fault, "a finite action", "the host may give an empty Selection");
  }

  // Each action depends on its scene alone; commands that were not demonstrated; memory.
  void judge_policy(const Actor& actor, const Bench& bench, const std::vector<std::string>& actions, bool first) {
    if (!first) {  // the scenario that has commands which are only tested
      const auto unseen =
          std::count_if(bench.sights.begin(), bench.sights.end(), [&](const Sight& s) { return !bench.is_seen(s); });
      report_.ok("unseen commands", fmt::format("{} scenes with a command that was not demonstrated: acted", unseen));
      return;
    }
    const auto differs = [&](bool reversed) {
      for (std::size_t k = 0; k < bench.sights.size(); ++k) {
        const std::size_t i = reversed ? bench.sights.size() - 1 - k : k;
        if (act("act", actor, bench, bench.sights[i]) != actions[i]) return true;
      }
      return false;
    };
    const bool by_itself = differs(false);
    report_.judge("same scenes", by_itself ? "act() gave other actions when they came once more in the same order" : "",
                  "the same actions once more", determinism);
    if (!by_itself)
      report_.judge("order of scenes",
                    differs(true) ? "act() gave another action when scenes came in reverse order" : "",
                    "changes no action", "keep nothing from one episode to the next, or drop it in reset()");
    report_.ok("actions", fmt::format("finite, {} numbers each", bench.environment->action_space().size()));
    if (outside_.numbers > 0)
      report_.note("bounds of actions",
                   fmt::format("act() gave {} numbers outside of their bounds, the first: {}; a run carries out the "
                               "nearest bound",
                               outside_.numbers, outside_.example),
                   "keep actions within services.actions, or this is what the policy learned to do");

    if (!is_library()) return;
    constexpr int calls = 200, bearable = 256;  // bytes a call
    const auto act_all = [&](int n) {
      for (int i = 0; i < n / bench.environment->most_steps(); ++i)
        act("act", actor, bench, bench.sights[static_cast<std::size_t>(i) % bench.sights.size()]);
    };
    act_all(20);
    const long long before = heap_bytes();
    act_all(calls);
    const long long grown = (heap_bytes() - before) / calls;
    report_.judge("memory of act", grown > bearable ? fmt::format("grows by {} bytes a call", grown) : "",
                  fmt::format("does not grow over {} calls", calls), "act() must not keep observations");
  }

  void judge_repetition(const Use& first, const Use& second, long long grown) {
    const auto same = [&](const char* check, const std::string& a, const std::string& b) {
      report_.judge(fmt::format("same {}", check), a == b ? "" : "different the second time, with the same seed",
                    "twice in one process, bit for bit", determinism);
      report_.hashes[check] = sha256(a);
    };
    same("Selections", first.selections, second.selections);
    same("training", first.training, second.training);
    same("actions", first.actions, second.actions);
    if (!is_library()) return;
    report_.judge("memory of a use", grown > (1 << 20) ? fmt::format("{} KiB are not freed", grown / 1024) : "",
                  "given back", "the second use must end with as much memory as the first");
  }

  const HostJob& job_;
  const CheckPhase& phase_;
  std::string doing_;
  std::map<std::string, double> seconds_;  // of the last call of each kind
  CheckReport report_;
  std::optional<Kept> kept_;
  Outside outside_;
  HostedMethod method_;
};

// As its file says it: a scenario of errands takes long to load.
bool has_unseen_commands(const std::string& id) {
  const Json file = read_json(scenario_file(id));
  if (!file.is_object() || !file.contains("commands") || file.value("may_stop", Json(false)) == true) return false;
  const Json& commands = file["commands"];
  return std::any_of(commands.begin(), commands.end(),
                     [](const Json& one) { return one.is_object() && one.contains("seen") && one["seen"] == false; });
}

// The first scenario that tests commands which were not demonstrated, and in which no policy may stop; none where the
// environment ("": any) has none.
std::optional<Scenario> with_unseen_commands(const std::string& environment) {
  for (const std::string& id : scenario_ids()) {
    if (!has_unseen_commands(id)) continue;
    Scenario scenario = load_scenario(id);
    if (environment.empty() || scenario.environment->id() == environment) return scenario;
  }
  return std::nullopt;
}

// The example of the environment's first task, and a scenario with unseen commands. What a method is told of a task of
// several steps holds for that one alone.
std::vector<Scenario> played_in(std::string environment) {
  std::optional<Scenario> unseen = with_unseen_commands(environment);
  if (environment.empty()) environment = unseen ? unseen->environment->id() : environment_ids().front();
  const TaskInfo& task = find_environment(environment).tasks().front();
  std::vector<Scenario> all{load_scenario(task.example)};
  if (unseen && (task.most_steps == 1 || unseen->task == task.id)) all.push_back(*std::move(unseen));
  return all;
}

}  // namespace

CheckReport check_method(HostJob job, const std::optional<PluginInfo>& engine, const Json& scenario,
                         const CheckPhase& phase) {
  job.seed = seed;
  job.hidden = runs_below(job.plugin.file.parent_path());
  std::vector<std::unique_ptr<Bench>> benches;
  std::vector<Scenario> all =
      scenario.is_null() ? played_in(job.environment) : std::vector{read_scenario(scenario, "check: /scenario")};
  for (Scenario& played : all) benches.push_back(std::make_unique<Bench>(std::move(played), engine));
  const Scenario& first = benches.front()->scenario;
  job.environment = first.environment->id();
  if (find_task(*first.environment, first.task).most_steps > 1 || first.may_stop) {  // it is told of this task's state
    job.task = first.task;
    job.may_stop = first.may_stop;
  }
  phase("load", {});
  std::optional<Kept> kept;
  CheckReport report;
  {
    MethodCheck check(job, phase);
    report = check.run(benches);
    kept = check.kept();
  }  // a worker has one method's process at a time
  phase("restore", report);
  if (kept) judge_restored(job, *kept, *benches.front(), report);
  return report;
}

}  // namespace lgabench
