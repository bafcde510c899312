// An environment of its own, whose episodes have several steps: a point is steered to the disc that the command means.
// It needs no engine. An action is a displacement, so that a policy must know where the point is: Observation::state
// says it, and no instance does. The task reach_blind is the same without the state.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench::reach2d {
namespace {

constexpr PictureSize picture{64, 128};
constexpr double half_down = .5, half_across = 1;  // of the plane, in metres
constexpr double radius = .12, apart = .35;        // of a disc; between the middles of two
constexpr int discs = 4, most_moves = 20;
constexpr double gain = .3;  // of what is left the oracle goes so much in a step
constexpr const char *disc = "round", *layout = "plane";
constexpr const char *not_reached = "not_reached", *wrong_disc = "wrong_disc";
constexpr const char* blind = "reach_blind";

struct Colour {
  const char* texture;
  std::array<std::uint8_t, 3> rgb;
};
constexpr std::array<Colour, 6> colours{{{"red", {200, 40, 40}},
                                         {"green", {40, 160, 60}},
                                         {"blue", {50, 80, 200}},
                                         {"yellow", {220, 200, 50}},
                                         {"purple", {140, 60, 160}},
                                         {"orange", {230, 130, 30}}}};

Vec2 pixel(Vec2 at) {  // x down, y across
  return {(at.x + half_down) / (2 * half_down) * picture.rows,
          (at.y + half_across) / (2 * half_across) * picture.columns};
}

const ActionSpace& displacements() {
  static const ActionSpace space{{{"down", "m", -2 * gain * half_down, 2 * gain * half_down},
                                  {"across", "m", -2 * gain * half_across, 2 * gain * half_across}},
                                 {},
                                 {}};
  return space;
}

class Plane final : public Environment {
 public:
  explicit Plane(bool has_state) : has_state_(has_state) {}

  const ActionSpace& action_space() const override { return displacements(); }

  Observation reset(const Scene& scene) override {
    scene_ = scene;
    at_ = {scene.parameters.at("down"), scene.parameters.at("across")};
    steps_ = 0;
    return observe();
  }

  StepResult step(const Action& action) override {
    const Action by = action.empty() ? Action{0, 0} : executable(displacements(), action);  // empty: it gives up
    at_ = {std::clamp(at_.x + by[0], -half_down, half_down), std::clamp(at_.y + by[1], -half_across, half_across)};
    ++steps_;
    StepResult result;
    result.failure = steps_ == most_moves || action.empty() ? not_reached : failure::goes_on;
    for (const SceneObject& o : scene_.objects) {
      if (norm(o.position_m - at_) > radius) continue;
      result.taken = o.instance_id;
      result.failure = o.role == role::target ? failure::none : wrong_disc;
    }
    result.is_success = result.failure == failure::none;
    result.terminated = result.failure != failure::goes_on;
    result.observation = observe();
    return result;
  }

  Observation observe() override {
    Observation seen{
        picture, std::vector<std::uint8_t>(3 * picture.pixels(), 90), std::vector<std::uint8_t>(picture.pixels()), {}};
    for (const SceneObject& o : scene_.objects) {
      const auto* const colour =
          std::find_if(colours.begin(), colours.end(), [&](const Colour& one) { return o.texture == one.texture; });
      if (colour == colours.end()) throw InputError(fmt::format("scene: texture \"{}\": none of a disc's", o.texture));
      int pixels = 0;
      draw(seen, o.position_m, radius, colour->rgb, [&](std::size_t i) { seen.ids[i] = o.instance_id, ++pixels; });
      seen.instances.push_back({o.instance_id, o.object_type, o.texture, pixels});
    }
    draw(seen, at_, .04, {255, 255, 255}, [](std::size_t) {});
    if (has_state_) seen.state = {at_.x, at_.y};
    return seen;
  }

  Action expert_action() const override {
    const SceneObject* const target = scene_.find(role::target);
    if (!target) throw InputError("scene: expected an object with the role target");
    return expert_action_for(target->instance_id);
  }

  Action expert_action_for(std::uint8_t id) const override {
    for (const SceneObject& o : scene_.objects)
      if (o.instance_id == id) return {gain * (o.position_m.x - at_.x), gain * (o.position_m.y - at_.y)};
    throw InputError(fmt::format("scene: expected an object with id {}", id));
  }

 private:
  template <class Also>
  static void draw(Observation& seen, Vec2 middle, double of_radius, const std::array<std::uint8_t, 3>& rgb,
                   const Also& also) {
    for (int row = 0; row < picture.rows; ++row)
      for (int column = 0; column < picture.columns; ++column) {
        const Vec2 centre = pixel(middle), away{row + .5 - centre.x, column + .5 - centre.y};
        if (norm(away) > of_radius / (2 * half_down) * picture.rows) continue;
        const auto i = static_cast<std::size_t>(row * picture.columns + column);
        std::copy(rgb.begin(), rgb.end(), seen.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
        also(i);
      }
  }

  const bool has_state_;
  Scene scene_;
  Vec2 at_;
  int steps_ = 0;
};

// Whether a point that goes straight from one place to the other keeps away from a disc in the middle.
bool passes(Vec2 from, Vec2 to, Vec2 middle) {
  const Vec2 way = to - from, aside = middle - from;
  const double along = std::clamp((way.x * aside.x + way.y * aside.y) / (way.x * way.x + way.y * way.y), 0., 1.);
  return norm(aside - along * way) > 1.2 * radius;
}

class Reach2dType final : public EnvironmentType {
 public:
  const std::string& id() const override { return id_; }
  const std::vector<TaskInfo>& tasks() const override { return tasks_; }
  const std::vector<std::string>& spaces() const override { return spaces_; }
  const std::vector<std::string>& failures() const override { return failures_; }
  const ActionSpace& action_space() const override { return displacements(); }
  const std::vector<StateNumber>& state_of(const TaskInfo& task) const override {
    return task.id == blind ? EnvironmentType::state_of(task) : state_;
  }
  PictureSize picture_size() const override { return picture; }
  int most_instances(const TaskInfo&) const override { return discs; }
  Vec2 in_picture(Vec3 point_m) const override {
    const Vec2 at = pixel({point_m.x, point_m.y});
    return {at.y, at.x};
  }
  std::vector<std::string> scenario_members(const TaskInfo&) const override { return {}; }
  std::vector<std::string> scene_members(const TaskInfo&) const override { return {}; }
  std::shared_ptr<const SceneContent> read_content(const Scenario&, const JsonReader&, const JsonReader*,
                                                   bool) const override {
    return std::make_shared<SceneContent>();
  }

  // Discs lie anywhere; from where the point begins, the straight way to each is free of the others.
  Scene sample(const Scenario& scenario, const SceneRequest& request, int index) const override {
    if (request.layout != layout) throw InputError(fmt::format("layout \"{}\": expected {}", request.layout, layout));
    const std::vector<int> commands = scenario.commands_of(request.arm);
    Scene scene;
    scene.scenario = scenario.id;
    scene.arm = request.arm;
    scene.layout = request.layout;
    scene.split = request.split;
    scene.task = scenario.task;
    scene.seed = request.seed;
    scene.index = index;
    scene.command = commands[static_cast<std::size_t>(index) % commands.size()];
    const auto command = static_cast<std::size_t>(scene.command);
    const Meaning& truth = scenario.commands[command].truth.target;
    const bool asks = request.arm == "train" && scenario.as_method_asks && !request.selections.empty();
    const Meaning& shown = asks ? request.selections[command].target : truth;
    RandomStream random(fmt::format("reach2d/{}/{}/{}{}/{}", scenario.id, request.split, request.seed,
                                    own_stream(request.training_seed), index));
    std::vector<const char*> meant, others;
    for (const Colour& one : colours) {
      if (shown.belongs(disc, one.texture)) meant.push_back(one.texture);
      if (!truth.belongs(disc, one.texture)) others.push_back(one.texture);
    }
    if (meant.empty())
      throw NothingToShow(fmt::format("scenario \"{}\": expected a disc's colour among what is meant", scenario.id));
    const char* const target = meant[random.below(static_cast<std::uint32_t>(meant.size()))];
    others.erase(std::remove(others.begin(), others.end(), target), others.end());
    const std::vector<int> order = random.permutation(static_cast<int>(others.size())), ids = random.permutation(discs);
    for (int i = 0; i < std::min<int>(discs, 1 + static_cast<int>(others.size())); ++i) {
      SceneObject o;
      o.object_type = disc;
      o.texture = i == 0 ? target : others[static_cast<std::size_t>(order[static_cast<std::size_t>(i) - 1])];
      o.role = i == 0 ? role::target : role::distractor;
      o.instance_id = static_cast<std::uint8_t>(1 + ids[static_cast<std::size_t>(i)]);
      scene.objects.push_back(o);
    }
    Vec2 start;
    do {
      for (SceneObject& o : scene.objects) o.position_m = anywhere(random);
      start = anywhere(random);
    } while (!is_free(start, scene.objects));
    scene.parameters = {{"down", start.x}, {"across", start.y}};
    std::sort(scene.objects.begin(), scene.objects.end(),
              [](const SceneObject& a, const SceneObject& b) { return a.instance_id < b.instance_id; });
    return scene;
  }

  Observation draw(const Scene& scene, const View&) const override { return Plane(true).reset(scene); }
  std::unique_ptr<Environment> make(std::unique_ptr<PhysicsWorld>, const Scenario& scenario) const override {
    return std::make_unique<Plane>(scenario.task != blind);
  }

 private:
  static Vec2 anywhere(RandomStream& random) {
    const double down = random.uniform(radius - half_down, half_down - radius);
    return {down, random.uniform(radius - half_across, half_across - radius)};
  }

  static bool is_free(Vec2 start, const std::vector<SceneObject>& objects) {
    for (const SceneObject& a : objects) {
      if (norm(a.position_m - start) < apart) return false;
      for (const SceneObject& b : objects)
        if (&a != &b && (norm(a.position_m - b.position_m) < apart || !passes(start, a.position_m, b.position_m)))
          return false;
    }
    return true;
  }

  std::string id_ = "reach2d";
  std::vector<TaskInfo> tasks_{{"reach", {layout}, std::nullopt, {}, "reach_red", most_moves},
                               {blind, {layout}, std::nullopt, {}, "reach_red_blind", most_moves}};
  std::vector<std::string> spaces_{"tabletop"}, failures_{not_reached, wrong_disc};
  std::vector<StateNumber> state_{{"down", "m", -half_down, half_down}, {"across", "m", -half_across, half_across}};
};

}  // namespace
}  // namespace lgabench::reach2d

const lgabench::EnvironmentType* lgabench_environment() {
  static const lgabench::reach2d::Reach2dType type;
  return &type;
}
