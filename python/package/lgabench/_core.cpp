// The module lgabench._core: scenes of scenarios, perceived as in a run, one at a time or many on threads.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/core/resources.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/plugin/loader.hpp>

namespace nb = nanobind;
using namespace nb::literals;

namespace lgabench {
namespace {

using Doubles = nb::ndarray<nb::numpy, double>;
using Numbers = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
/// id, object type, texture, visible pixels.
using Rows = std::vector<std::tuple<int, std::string, std::string, int>>;

/// Numbers that a worker computes with, for one call: Python's own thread keeps its mode.
class WorkersArithmetic {
 public:
#if defined(__SSE2__)
  WorkersArithmetic() : before_(_mm_getcsr()) { flush_denormals(); }
  ~WorkersArithmetic() { _mm_setcsr(before_); }
  WorkersArithmetic(const WorkersArithmetic&) = delete;
  WorkersArithmetic& operator=(const WorkersArithmetic&) = delete;

 private:
  unsigned before_;
#endif
};

/// An array that owns its memory.
template <class T>
nb::ndarray<nb::numpy, T> array(std::vector<T> values, const std::vector<std::size_t>& shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return {kept->data(), shape.size(), shape.data(), owner};
}

std::size_t size(int n) { return static_cast<std::size_t>(n); }

/// Rows (id, object type, texture, pixels) with words as indices into the space; -1 where there is no instance.
void encode(const Observation& seen, const FeatureSpace& space, int rows, std::int16_t* to) {
  std::fill_n(to, 4 * rows, std::int16_t{-1});
  const auto index = [](const std::vector<std::string>& words, const std::string& word) {
    const auto found = std::find(words.begin(), words.end(), word);
    return static_cast<std::int16_t>(found == words.end() ? -1 : found - words.begin());
  };
  for (std::size_t i = 0; i < std::min(seen.instances.size(), size(rows)); ++i) {
    const Instance& one = seen.instances[i];
    to[4 * i] = one.id;
    to[4 * i + 1] = index(space.object_types, one.object_type);
    to[4 * i + 2] = index(space.textures, one.texture);
    to[4 * i + 3] = static_cast<std::int16_t>(std::min(one.pixels, 32767));
  }
}

/// One of a scenario's scenes: which one.
struct Which {
  std::string split, arm;
  std::uint64_t seed = 0;
  int index = 0;
  std::optional<std::uint64_t> own_scenes;  // of a training seed with test scenes of its own
};

/// A scenario's environment on an engine, with what a run does to a scene before a policy sees it.
class Player {
 public:
  Player(std::shared_ptr<const Scenario> scenario, const std::string& engine, std::string layout, bool shadows = false)
      : scenario_(std::move(scenario)),
        layout_(std::move(layout)),
        type_(scenario_->environment),
        environment_(made(*scenario_, engine)) {
    environment_->show_shadows(shadows);
  }

  /// Read once: files of plugins do not change while they are open.
  static const Catalogue& plugins() {
    static const Catalogue all = scan_plugins(plugin_directories());
    return all;
  }

  Observation reset(const Which& which) {
    const WorkersArithmetic arithmetic;
    const bool test = which.split == "test";
    Scene scene = sampled_scene(
        *scenario_, {layout_, which.split, test ? which.arm : "train", which.seed, {}, which.own_scenes}, which.index);
    Observation seen = environment_->reset(scene);
    perception_ = nullptr;
    if (test) {
      TestScene shown = in_its_arm(*scenario_, std::move(scene), which.own_scenes);
      if (shown.view != View()) seen = environment_->look(shown.view);
      perception_ = std::move(shown.perception);
      scene = std::move(shown.scene);
    }
    scene_ = std::move(scene);
    steps_ = 0;
    return perception_ ? perception_(seen, *scene_, 0) : seen;
  }
  StepResult step(const Action& action) {
    const WorkersArithmetic arithmetic;
    StepResult result = environment_->step(action);
    ++steps_;
    const bool goes_on = !result.terminated && !result.truncated;
    if (goes_on && perception_) result.observation = perception_(result.observation, *scene_, steps_);
    return result;
  }
  Action expert_action(std::optional<int> instance) {
    const WorkersArithmetic arithmetic;
    if (instance && (*instance < 1 || *instance > 255))
      throw InputError("expert_action: expected an instance's id, 1 to 255, got " + std::to_string(*instance));
    return instance ? environment_->expert_action_for(static_cast<std::uint8_t>(*instance))
                    : environment_->expert_action();
  }
  const Scene& scene() const {
    if (!scene_) throw Error("scene: expected a reset() before it");
    return *scene_;
  }
  const Scenario& scenario() const { return *scenario_; }
  const EnvironmentType& type() const { return *type_; }

 private:
  static std::unique_ptr<Environment> made(const Scenario& scenario, const std::string& engine) {
    const WorkersArithmetic arithmetic;  // opening a plugin changes the thread's mode
    return make_environment(scenario, load_engine(plugins().engine(engine, *scenario.environment)));
  }

  std::shared_ptr<const Scenario> scenario_;
  std::string layout_;
  const EnvironmentType* type_;
  std::unique_ptr<Environment> environment_;
  std::optional<Scene> scene_;
  Perception perception_;  // of the scene's arm; null: none errs
  int steps_ = 0;
};

Action numbers_of(const Numbers& action, const ActionSpace& space, bool may_stop) {
  if (may_stop && action.ndim() == 1 && action.shape(0) == 0) return {};
  if (action.ndim() != 1 || action.shape(0) != space.size())
    throw InputError("step: expected an action of " + std::to_string(space.size()) + " numbers");
  return {action.data(), action.data() + action.size()};
}

/// rgb, ids, [(id, object type, texture, pixels)], shadows or None, state, [(object type, texture)] of what was
/// brought, and the first table as numbers; nothing is copied.
nb::tuple arrays(const Player& player, Observation seen) {
  const auto rows = size(seen.size.rows), columns = size(seen.size.columns);
  const int most = most_instances_of(player.scenario());
  std::vector<std::int16_t> encoded(size(4 * most));
  encode(seen, player.scenario().space, most, encoded.data());
  Rows table;
  for (Instance& one : seen.instances)
    table.emplace_back(one.id, std::move(one.object_type), std::move(one.texture), one.pixels);
  const bool shaded = !seen.shadows.empty();
  const std::size_t numbers = seen.state.size();
  std::vector<std::pair<std::string, std::string>> brought;
  for (Named& one : seen.brought) brought.emplace_back(std::move(one.object_type), std::move(one.texture));
  return nb::make_tuple(array(std::move(seen.rgb), {rows, columns, 3}), array(std::move(seen.ids), {rows, columns}),
                        nb::cast(std::move(table)),
                        shaded ? nb::cast(array(std::move(seen.shadows), {rows, columns})) : nb::none(),
                        array(std::move(seen.state), {numbers}), nb::cast(std::move(brought)),
                        array(std::move(encoded), {size(most), 4}));
}

/// {part: value}
nb::dict parts(const std::vector<Gap>& gaps) {
  nb::dict all;
  for (const Gap& gap : gaps) all[gap.part.c_str()] = gap.value;
  return all;
}

/// One at a time: a second thread's call while one is under way is refused, as it would wait with Python's lock held.
class OneCall {
 public:
  OneCall(std::mutex& mutex, const char* what) : lock_(mutex, std::try_to_lock) {
    if (!lock_) throw Error(std::string(what) + ": another thread is using it; make one environment for each thread");
  }

 private:
  std::unique_lock<std::mutex> lock_;
};

class One {
 public:
  One(std::shared_ptr<const Scenario> scenario, const std::string& engine, std::string layout, bool shadows)
      : player_(std::move(scenario), engine, std::move(layout), shadows) {}

  nb::tuple reset(const std::string& split, const std::string& arm, std::uint64_t seed, int index,
                  std::optional<std::uint64_t> own_scenes) {
    const OneCall call(mutex_, "reset");
    Observation seen;
    {
      const nb::gil_scoped_release others_run;
      seen = player_.reset({split, arm, seed, index, own_scenes});
    }
    return arrays(player_, std::move(seen));
  }

  nb::tuple step(const Numbers& action) {
    const OneCall call(mutex_, "step");
    const Action numbers = numbers_of(action, player_.type().action_space(), player_.scenario().may_stop);
    StepResult result;
    {
      const nb::gil_scoped_release others_run;
      result = player_.step(numbers);
    }
    return nb::make_tuple(arrays(player_, std::move(result.observation)), result.is_success, result.failure,
                          !result.truncated, parts(result.gaps), result.terminated, result.truncated);
  }

  Doubles expert_action(std::optional<int> instance) {
    const OneCall call(mutex_, "expert_action");
    Action action = player_.expert_action(instance);
    const std::size_t n = action.size();
    return array(std::move(action), {n});
  }
  std::string scene_hash() const { return hex(player_.scene().hash()); }
  std::string utterance() const { return player_.scenario().commands[size(player_.scene().command)].utterance; }

 private:
  std::mutex mutex_;
  Player player_;
};

/// Several environments of one scenario, advanced together on threads that last a call.
class Pool {
 public:
  Pool(const std::shared_ptr<const Scenario>& scenario, const std::string& engine, const std::string& layout, int count,
       int threads)
      : threads_(std::clamp(threads, 1, std::max(count, 1))), pid_(::getpid()) {
    if (count < 1) throw InputError("Pool: expected one environment or more, got " + std::to_string(count));
    for (int i = 0; i < count; ++i) players_.push_back(std::make_unique<Player>(scenario, engine, layout));
  }

  /// Environment at[i] begins scene indices[i]. Batches are new, a row for each of `at`.
  nb::tuple reset(const std::vector<int>& at, const std::string& split, const std::vector<std::string>& arms,
                  const std::vector<std::uint64_t>& seeds, const std::vector<int>& indices) {
    const OneCall call(mutex_, "reset");
    expect_own_process();
    if (arms.size() != at.size() || seeds.size() != at.size() || indices.size() != at.size())
      throw InputError("Pool.reset: expected an arm, a seed and an index for each environment");
    Batch batch(*players_.front(), at.size());
    on_threads(at, [&](std::size_t row, Player& player) {
      batch.put(row, player, player.reset({split, arms[row], seeds[row], indices[row], {}}));
    });
    return batch.arrays();
  }

  /// -> batches, successes, failures, whether all came to rest, what success lacks, terminated, truncated; actions: a
  /// row for each of `at`; done: likewise, or empty.
  nb::tuple step(const std::vector<int>& at, const Numbers& actions, const std::vector<bool>& done) {
    const OneCall call(mutex_, "step");
    expect_own_process();
    const std::size_t n = players_.front()->type().action_space().size();
    if (actions.ndim() != 2 || actions.shape(0) != at.size() || actions.shape(1) != n)
      throw InputError("Pool.step: expected " + std::to_string(at.size()) + " actions of " + std::to_string(n) +
                       " numbers");
    Batch batch(*players_.front(), at.size());
    if (!done.empty() && done.size() != at.size()) throw InputError("Pool.step: expected a \"done\" for each action");
    std::vector<std::uint8_t> successes(at.size()), rests(at.size()), terminated(at.size()), truncated(at.size());
    std::vector<std::string> failures(at.size());
    std::vector<std::vector<Gap>> gaps(at.size());
    const double* const numbers = actions.data();
    on_threads(at, [&](std::size_t row, Player& player) {
      const bool is_done = !done.empty() && done[row];
      const StepResult result = player.step(is_done ? Action() : Action(numbers + row * n, numbers + (row + 1) * n));
      terminated[row] = result.terminated;
      truncated[row] = result.truncated;
      batch.put(row, player, result.observation);
      successes[row] = result.is_success;
      rests[row] = !result.truncated;
      failures[row] = result.failure;
      gaps[row] = result.gaps;
    });
    nb::list distances;
    for (const std::vector<Gap>& one : gaps) distances.append(parts(one));
    return nb::make_tuple(batch.arrays(), array(std::move(successes), {at.size()}), failures,
                          array(std::move(rests), {at.size()}), distances, array(std::move(terminated), {at.size()}),
                          array(std::move(truncated), {at.size()}));
  }

  Doubles expert_actions(const std::vector<int>& at) {
    const OneCall call(mutex_, "expert_actions");
    expect_own_process();
    const std::size_t n = players_.front()->type().action_space().size();
    std::vector<double> all(at.size() * n);
    on_threads(at, [&](std::size_t row, Player& player) {
      const Action action = player.expert_action(std::nullopt);
      if (action.empty()) std::fill_n(all.begin() + static_cast<std::ptrdiff_t>(row * n), n, std::nan(""));
      std::copy(action.begin(), action.end(), all.begin() + static_cast<std::ptrdiff_t>(row * n));
    });
    return array(std::move(all), {at.size(), n});
  }
  std::vector<std::string> utterances() const {
    std::vector<std::string> all;
    for (const auto& player : players_)
      all.push_back(player->scenario().commands[size(player->scene().command)].utterance);
    return all;
  }
  std::vector<std::string> scene_hashes() const {
    std::vector<std::string> all;
    for (const auto& player : players_) all.push_back(hex(player->scene().hash()));
    return all;
  }
  std::size_t count() const { return players_.size(); }

 private:
  struct Batch {
    Batch(const Player& player, std::size_t n)
        : rows(most_instances_of(player.scenario())),
          picture(player.type().picture_size()),
          count(n),
          rgb(n * picture.pixels() * 3),
          ids(n * picture.pixels()),
          instances(n * size(rows) * 4),
          numbers(state_of(player.scenario()).size()),
          state(n * numbers) {}
    void put(std::size_t row, const Player& player, const Observation& seen) {
      std::memcpy(rgb.data() + row * seen.rgb.size(), seen.rgb.data(), seen.rgb.size());
      std::memcpy(ids.data() + row * seen.ids.size(), seen.ids.data(), seen.ids.size());
      encode(seen, player.scenario().space, rows, instances.data() + row * size(rows) * 4);
      std::copy(seen.state.begin(), seen.state.end(), state.begin() + static_cast<std::ptrdiff_t>(row * numbers));
    }
    nb::tuple arrays() {
      const auto down = size(picture.rows), across = size(picture.columns);
      return nb::make_tuple(
          array(std::move(rgb), {count, down, across, 3}), array(std::move(ids), {count, down, across}),
          array(std::move(instances), {count, size(rows), 4}), array(std::move(state), {count, numbers}));
    }
    int rows;
    PictureSize picture;
    std::size_t count;
    std::vector<std::uint8_t> rgb, ids;
    std::vector<std::int16_t> instances;
    std::size_t numbers;  // of a state
    std::vector<double> state;
  };

  void expect_own_process() const {
    if (::getpid() != pid_)
      throw Error("Pool: made before this process was forked; make it in the process, or start that with \"spawn\"");
  }

  template <class Work>
  void on_threads(const std::vector<int>& at, const Work& work) {
    for (std::size_t i = 0; i < at.size(); ++i)
      if (at[i] < 0 || size(at[i]) >= players_.size() || std::count(at.begin(), at.end(), at[i]) > 1)
        throw InputError("Pool: expected numbers of environments, 0 to " + std::to_string(players_.size() - 1) +
                         ", each once");
    const nb::gil_scoped_release others_run;
    std::atomic<std::size_t> next{0};
    std::vector<std::exception_ptr> errors(at.size());
    const auto run = [&] {
      for (std::size_t row; (row = next++) < at.size();) try {
          work(row, *players_[size(at[row])]);
        } catch (...) {
          errors[row] = std::current_exception();
        }
    };
    std::vector<std::thread> helpers = start_helpers(size(threads_) - 1, run);
    run();
    for (std::thread& helper : helpers) helper.join();
    for (const std::exception_ptr& error : errors)
      if (error) std::rethrow_exception(error);
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Player>> players_;
  int threads_;
  pid_t pid_;
};

std::shared_ptr<Scenario> scenario_at(const std::optional<std::string>& id, const std::optional<std::string>& path) {
  if (id.has_value() == path.has_value()) throw InputError("Scenario: expected an id or path=FILE.json");
  return std::make_shared<Scenario>(id ? load_scenario(*id) : read_scenario(read_json(*path), *path));
}

std::vector<std::string> engine_ids() {
  std::vector<std::string> ids;
  for (const PluginInfo& plugin : Player::plugins().plugins)
    if (plugin.kind == "engine") ids.push_back(plugin.id);
  return ids;
}

}  // namespace
}  // namespace lgabench

NB_MODULE(_core, m) {
  using namespace lgabench;
  nb::exception<EngineError>(m, "EngineError", PyExc_RuntimeError).attr("__doc__") =
      "The physics engine failed: it cannot be loaded, or a world's state is invalid.";
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const InputError& e) {
      PyErr_SetString(PyExc_ValueError, e.what());
    } catch (const MethodError& e) {  // an action that is not executable
      PyErr_SetString(PyExc_ValueError, e.what());
    } catch (const PluginError& e) {
      PyErr_SetString(PyExc_ValueError, e.what());
    }
  });
  know_python_environments();
  let_environments_start();
  m.attr("version") = LGABENCH_VERSION;
  m.def("data_directory", [] { return data_directory().string(); });
  m.def("scenarios", &scenario_ids, "Ids of the shipped scenarios, and of those in directories that were added.");
  m.def("engines", &engine_ids, "Ids of the engines that are installed.");
  nb::class_<Scenario>(m, "Scenario")
      .def_ro("id", &Scenario::id)
      .def_ro("task", &Scenario::task)
      .def_prop_ro("environment", [](const Scenario& s) { return s.environment->id(); })
      .def_prop_ro("has_engine", [](const Scenario& s) { return s.environment->has_engine(); })
      .def_prop_ro("commands", &Scenario::utterances)
      .def_prop_ro("layouts", [](const Scenario& s) { return layouts_of(s); })
      .def_prop_ro("arms",
                   [](const Scenario& s) {
                     std::vector<std::string> arms;
                     for (const Arm& arm : s.tests) arms.push_back(arm.id);
                     return arms;
                   })
      .def_prop_ro("space_id", [](const Scenario& s) { return s.space.id; })
      .def_prop_ro("object_types", [](const Scenario& s) { return s.space.object_types; })
      .def_prop_ro("textures", [](const Scenario& s) { return s.space.textures; })
      .def_prop_ro("second",
                   [](const Scenario& s) {
                     return s.second ? std::optional(std::pair(s.second->id, s.second->phrase)) : std::nullopt;
                   })
      .def("truth_json",
           [](const Scenario& s, int i) { return canonical(distribution_json(s.commands.at(size(i)).truth)); })
      .def_prop_ro("picture_size",
                   [](const Scenario& s) {
                     const PictureSize size = s.environment->picture_size();
                     return std::pair(size.rows, size.columns);
                   })
      .def_prop_ro("most_instances", &most_instances_of)
      .def_prop_ro("most_steps", [](const Scenario& s) { return find_task(*s.environment, s.task).most_steps; })
      .def_ro("may_stop", &Scenario::may_stop)
      .def_prop_ro("state_json", [](const Scenario& s) { return canonical(to_json(state_of(s))); })
      .def_prop_ro("action_space_json", [](const Scenario& s) { return canonical(to_json(actions_of(s))); });
  m.def("scenario", &scenario_at, "id"_a.none(), "path"_a.none());
  nb::class_<One>(m, "Environment")
      .def(nb::init<std::shared_ptr<const Scenario>, const std::string&, std::string, bool>(), "scenario"_a, "engine"_a,
           "layout"_a, "shadows"_a = false)
      .def("reset", &One::reset, "split"_a, "arm"_a, "seed"_a, "index"_a, "own_scenes"_a.none())
      .def("step", &One::step, "action"_a)
      .def("expert_action", &One::expert_action, "instance"_a.none())
      .def_prop_ro("scene_hash", &One::scene_hash)
      .def_prop_ro("utterance", &One::utterance);
  m.def("usable_cores", &usable_cores);
  nb::class_<Pool>(m, "Pool")
      .def(nb::init<const std::shared_ptr<const Scenario>&, const std::string&, const std::string&, int, int>(),
           "scenario"_a, "engine"_a, "layout"_a, "count"_a, "threads"_a)
      .def("reset", &Pool::reset, "at"_a, "split"_a, "arms"_a, "seeds"_a, "indices"_a)
      .def("step", &Pool::step, "at"_a, "actions"_a, "done"_a)
      .def("expert_actions", &Pool::expert_actions, "at"_a)
      .def("__len__", &Pool::count)
      .def_prop_ro("utterances", &Pool::utterances)
      .def_prop_ro("scene_hashes", &Pool::scene_hashes);
}
