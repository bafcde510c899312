#include <lgabench/host/python_environment.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <new>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/sampling.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/host/host_session.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/plugin/simple_environment.hpp>

namespace lgabench {
namespace {

bool may_start = false;  // see let_environments_start()

// All that its class says of itself.
struct Declared {
  EnvironmentDescription about;
  std::vector<std::string> without_state, scenario_members, scene_members;  // the first: tasks
  bool network = false;
  double memory_gib = 4, time_limit_s = 120;
};

TaskInfo read_task(const JsonReader& reader, Declared& declared) {
  constexpr int longest = 100000;
  reader.only({"id", "layouts", "example", "most_steps", "failures", "has_state"});
  TaskInfo task;
  task.id = reader.at("id").string();
  task.layouts = reader.at("layouts").strings();
  if (task.layouts.empty()) reader.at("layouts").fail("at least one");
  task.example = reader.at("example").string();
  if (reader.has("most_steps")) task.most_steps = static_cast<int>(reader.at("most_steps").integer(1, longest));
  if (reader.has("failures")) task.failures = reader.at("failures").strings();
  if (reader.has("has_state") && !reader.at("has_state").boolean()) declared.without_state.push_back(task.id);
  return task;
}

std::vector<ActionNumber> read_bounded(const JsonReader& list) {
  for (const JsonReader& one : list.elements())
    if (!one.json().is_object()) one.fail("(name, unit, low, high)");
  std::vector<ActionNumber> numbers = read_numbers(list);
  for (const ActionNumber& one : numbers)
    if (!(one.low < one.high)) list.fail(fmt::format("bounds of {} that grow", one.name));
  return numbers;
}

double read_positive(const JsonReader& reader) {
  if (!(reader.number() > 0)) reader.fail("a number above 0");
  return reader.number();
}

Declared read_declared(const PluginInfo& plugin) {
  constexpr int longest = 1 << 14, most_things = 255;
  const JsonReader reader(plugin.python.at("environment"), plugin.file.string());
  Declared declared;
  EnvironmentDescription& about = declared.about;
  about.id = plugin.id;
  for (const JsonReader& task : reader.at("tasks").elements()) about.tasks.push_back(read_task(task, declared));
  if (about.tasks.empty()) reader.at("tasks").fail("at least one");
  about.failures = reader.at("failures").strings();
  about.spaces = {reader.at("space").string()};
  about.actions.numbers = read_bounded(reader.at("actions"));
  const Json space{{"numbers", lgabench::to_json(about.actions.numbers)},
                   {"rotations", reader.at("rotations").json()},
                   {"places", reader.at("places").json()}};
  about.actions = read_action_space(JsonReader(space, plugin.file.string()));
  about.state = read_bounded(reader.at("state"));
  const std::vector<JsonReader> picture = reader.at("picture").elements();
  if (picture.size() != 2) reader.at("picture").fail("rows and columns");
  about.picture = {static_cast<int>(picture[0].integer(1, longest)), static_cast<int>(picture[1].integer(1, longest))};
  if (3 * about.picture.pixels() > most_payload_bytes)
    reader.at("picture").fail(fmt::format("at most {} pixels", most_payload_bytes / 3));
  for (const JsonReader& one : reader.at("things").elements()) {
    if (!one.json().is_object()) one.fail("(object type, texture)");
    about.things.push_back({one.at("object_type").string(), one.at("texture").string()});
  }
  about.most_things = static_cast<int>(reader.at("most_instances").integer(1, most_things));
  declared.scenario_members = reader.at("scenario_members").strings();
  declared.scene_members = reader.at("scene_members").strings();
  declared.network = reader.at("network").boolean();
  declared.memory_gib = read_positive(reader.at("memory_gib"));
  declared.time_limit_s = read_positive(reader.at("time_limit_s"));
  return declared;
}

// The class in its process. What it does amiss, dying and hanging included, is an EngineError that names the scene.
class Simulator {
 public:
  Simulator(const PluginInfo& plugin, const Declared& declared, const std::string& task)
      : plugin_(plugin), declared_(declared), scratch_("environment") {
    if (!may_start)
      throw InputError(
          fmt::format("environment {}: it is in Python and starts no process here, only in cells and in "
                      "check-plugin, check-scenario, demos, render and replay",
                      plugin.id));
    HostJob job{plugin, plugin.id, Json::object(), 0, scratch_.path, false};
    job.memory_bytes = static_cast<long long>(declared.memory_gib * (1 << 30));
    job.reply_limit_s = declared.time_limit_s;
    job.trusted = true;
    job.offline = !declared.network;
    job.task = task;
    guarded("its start", [&] { session_ = std::make_unique<HostSession>(job); });
  }

  /// `where`: what is asked and of which scene, for errors. `ids`: gets the frame that comes before, if not null.
  Frame ask(const std::string& where, const Json& request, const char* reply, std::optional<Frame>* ids = nullptr) {
    const auto takes_ids = [ids](const Frame& frame, Channel&) {
      if (!ids || frame.type() != "ids" || *ids) return false;
      *ids = Frame{frame.header, frame.payload};
      return true;
    };
    return guarded(where, [&] { return session_->call(request, reply, takes_ids); });
  }

  /// Returns what a reply holds.
  template <class Call>
  auto read(const std::string& where, Call&& call) -> decltype(call()) {
    return guarded(where, [&] { return session_->read(call); });
  }

  Observation picture(const std::string& where, const Json& request, const char* reply, Frame* whole = nullptr) {
    std::optional<Frame> ids;
    Frame frame = ask(where, request, reply, &ids);
    Observation seen = read(where, [&] {
      if (!ids) throw InputError(fmt::format("\"{}\", expected \"ids\" before it", reply));
      Observation all = host::read_perceived(*ids, frame, session_->layout().picture);
      host::read_beside_pictures(JsonReader(frame.header, reply), session_->layout(), all);
      return all;
    });
    if (whole) *whole = std::move(frame);
    return seen;
  }

 private:
  template <class Call>
  auto guarded(const std::string& where, Call&& call) -> decltype(call()) {
    const auto fault = [&](const std::string& what) {
      return EngineError(fmt::format("environment {}: {}: {}", plugin_.id, where, what));
    };
    try {
      return call();
    } catch (const std::bad_alloc&) {
      throw fault(fmt::format("out of memory: it may take {:g} GiB (its memory_gib), and not more than --memory",
                              declared_.memory_gib));
    } catch (const MethodGone& e) {
      throw fault(e.what());
    } catch (const MethodError& e) {
      throw fault(e.what());
    } catch (const PluginError& e) {
      throw PluginError(fmt::format("environment {}: {}", plugin_.id, e.what()));
    }
  }

  const PluginInfo& plugin_;
  const Declared& declared_;
  const Scratch scratch_;
  std::unique_ptr<HostSession> session_;
};

std::string scene_text(const Scene& scene) { return fmt::format("scene {} of {}", scene.index, scene.arm); }

Json reset_request(const Scene& scene) { return {{"type", "reset"}, {"scene", to_json(scene)}}; }

// One scene at a time, in a process of its own.
class PythonWorld : public Environment {
 public:
  PythonWorld(const PluginInfo& plugin, const Declared& declared, const std::string& task)
      : space_(declared.about.actions), simulator_(std::make_unique<Simulator>(plugin, declared, task)) {}

  const ActionSpace& action_space() const override { return space_; }

  Observation reset(const Scene& scene) override {
    scene_ = scene_text(scene);
    steps_ = 0;
    return seen_ = simulator_->picture(at("reset()"), reset_request(scene), "seen");
  }

  StepResult step(const Action& action) override {
    const Json carried = action.empty() ? Json() : Json(executable(space_, action));
    ++steps_;
    const std::string where = at("step()");
    Frame frame;
    StepResult result;
    result.observation = simulator_->picture(where, {{"type", "step"}, {"action", carried}}, "stepped", &frame);
    simulator_->read(where, [&] {
      const JsonReader reader(frame.header, "stepped");
      result.terminated = reader.at("terminated").boolean();
      result.truncated = reader.at("truncated").boolean();
      result.is_success = reader.at("success").boolean();
      result.failure = reader.at("failure").string();
      result.taken = static_cast<std::uint8_t>(reader.at("taken").integer(0, 255));
    });
    seen_ = result.observation;
    return result;
  }

  Observation observe() override { return seen_; }
  Action expert_action() const override { return expert(nullptr); }
  Action expert_action_for(std::uint8_t instance_id) const override { return expert(instance_id); }

 private:
  std::string at(const char* call) const {
    return steps_ == 0 ? fmt::format("{}: {}", scene_, call) : fmt::format("{}, step {}: {}", scene_, steps_, call);
  }

  Action expert(const Json& instance) const {
    const std::string where = at("expert_action()");
    const Frame frame = simulator_->ask(where, {{"type", "expert"}, {"instance", instance}}, "action");
    return simulator_->read(where, [&] {
      Action action;
      const JsonReader reader = JsonReader(frame.header, "action").at("action");
      if (reader.json().is_null()) return action;
      for (const JsonReader& number : reader.elements()) action.push_back(number.number());
      if (action.size() != space_.size()) reader.fail(fmt::format("{} numbers", space_.size()));
      return action;
    });
  }

  const ActionSpace& space_;
  std::unique_ptr<Simulator> simulator_;
  std::string scene_ = "no scene";
  int steps_ = 0;
  Observation seen_;
};

class PythonEnvironment : public SimpleEnvironment {
 public:
  explicit PythonEnvironment(PluginInfo plugin) : PythonEnvironment(plugin, read_declared(plugin)) {}

  const std::vector<StateNumber>& state_of(const TaskInfo& task) const override {
    return contains(declared_.without_state, task.id) ? EnvironmentType::state_of(task)
                                                      : SimpleEnvironment::state_of(task);
  }
  std::vector<std::string> scenario_members(const TaskInfo& /*task*/) const override {
    return declared_.scenario_members;
  }
  std::vector<std::string> scene_members(const TaskInfo& /*task*/) const override { return declared_.scene_members; }
  std::shared_ptr<const SceneContent> read_content(const Scenario& scenario, const JsonReader& file,
                                                   const JsonReader* /*scenes*/, bool /*training*/) const override {
    expect_sets(scenario, file);
    return std::make_shared<SceneContent>();  // the class reads its members itself
  }

  Scene sample(const Scenario& scenario, const SceneRequest& request, int index) const override {
    const Things things = things_for(scenario, request, index);
    Scene scene = without_objects(scenario, request, index);
    const auto pairs = [](const std::vector<Named>& all) {
      Json json = Json::array();
      for (const Named& one : all) json.push_back({one.object_type, one.texture});
      return json;
    };
    const Json asked{{"type", "sample"},
                     {"scenario", scenario.json},
                     {"stream", stream_name(scenario.id, request, index) + id()},
                     {"request",
                      {{"task", scenario.task},
                       {"layout", request.layout},
                       {"split", request.split},
                       {"arm", request.arm},
                       {"seed", request.seed},
                       {"index", index},
                       {"command", scene.command},
                       {"meant", pairs(things.meant)},
                       {"others", pairs(things.others)}}}};
    const std::string where = scene_text(scene) + ": sample()";
    const std::lock_guard lock(mutex_);
    Simulator& simulator = aside(scenario.task);
    const Frame frame = simulator.ask(where, asked, "scene");
    simulator.read(where, [&] { read_objects(JsonReader(frame.header, "scene"), scene); });
    expect_allowed(scene, scenario, things);
    return scene;
  }

  Observation draw(const Scene& scene, const View& /*view*/) const override {
    const std::lock_guard lock(mutex_);
    return aside(scene.task).picture(scene_text(scene) + ": reset()", reset_request(scene), "seen");
  }

 protected:
  void place(Scene& /*scene*/, RandomStream /*random*/) const override {}  // sample() asks the class
  std::unique_ptr<Environment> make(const std::string& task) const override {
    return std::make_unique<PythonWorld>(plugin_, declared_, task);
  }

 private:
  PythonEnvironment(PluginInfo plugin, Declared declared)
      : SimpleEnvironment(declared.about), plugin_(std::move(plugin)), declared_(std::move(declared)) {}

  // What samples and draws, beside the processes that play: an episode that is under way is left alone.
  Simulator& aside(const std::string& task) const {
    if (!aside_ || aside_task_ != task) {
      aside_.reset();
      aside_ = std::make_unique<Simulator>(plugin_, declared_, task);
      aside_task_ = task;
    }
    return *aside_;
  }

  static void read_objects(const JsonReader& reader, Scene& scene) {
    for (const JsonReader& one : reader.at("objects").elements()) {
      SceneObject object;
      object.object_type = one.at("object_type").string();
      object.texture = one.at("texture").string();
      object.role = one.at("role").string();
      const std::vector<JsonReader> place = one.at("position_m").elements();
      if (place.size() != 2) one.at("position_m").fail("two numbers");
      object.position_m = {place[0].number(), place[1].number()};
      object.yaw_rad = one.at("yaw_rad").number();
      object.instance_id = static_cast<std::uint8_t>(one.at("instance_id").integer(0, 255));
      scene.objects.push_back(object);
    }
    if (reader.has("own")) scene.own = reader.at("own").json();
  }

  // A scene whose target the command does not mean would make every policy wrong without a word.
  void expect_allowed(const Scene& scene, const Scenario& scenario, const Things& things) const {
    const auto fail = [&](const std::string& what) {
      throw EngineError(fmt::format("environment {}: {}: sample(): {}", id(), scene_text(scene), what));
    };
    const std::size_t count = scene.objects.size(), most = static_cast<std::size_t>(declared_.about.most_things);
    if (count > most) fail(fmt::format("{} things, expected at most {} (most_instances)", count, most));
    for (std::size_t i = 0; i < count; ++i) {
      const SceneObject& one = scene.objects[i];
      if (one.instance_id != i + 1)
        fail(fmt::format("instance ids: expected 1 to {}, or none, got {}", count, one.instance_id));
      if (!contains(scenario.space.object_types, one.object_type) || !contains(scenario.space.textures, one.texture))
        fail(fmt::format("\"{} {}\" is no name of the space {}", one.texture, one.object_type, scenario.space.id));
      if (one.role != role::target && one.role != role::distractor)
        fail(fmt::format("role \"{}\", expected target or distractor", one.role));
      if (one.role == role::target && !contains(things.meant, Named{one.object_type, one.texture}))
        fail(fmt::format("the target is {} {}, which is not among request.meant", one.texture, one.object_type));
    }
    if (!scene.find(role::target)) fail("no thing has the role \"target\"");
  }

  const PluginInfo plugin_;
  const Declared declared_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<Simulator> aside_;
  mutable std::string aside_task_;
};

}  // namespace

void expect_environment(const PluginInfo& plugin) { read_declared(plugin); }

void let_environments_start() { may_start = true; }

std::string usual_python() {
  const char* const named = std::getenv("LGABENCH_PYTHON");
  return named && *named ? named : "python3";
}

void know_python_environments() {
  make_python_environments([](const PluginInfo& plugin) { return new PythonEnvironment(plugin); });
  look_for_environments([](const std::string& id) {
    return plugins_at({}, usual_python()).refusals_of(id) +
           "; others are found with --plugin-path or $LGABENCH_PLUGIN_PATH";
  });
}

}  // namespace lgabench
