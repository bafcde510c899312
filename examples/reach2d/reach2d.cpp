// An environment of its own, whose episodes have several steps: a point is steered to the disc that the command means.
// An action is a displacement, so that a policy must know where the point is: Observation::state says it, and no
// instance does. The task reach_blind is the same without the state.
#include <algorithm>
#include <array>
#include <cmath>

#include <lgabench/plugin/simple_environment.hpp>

namespace {

using namespace lgabench;

constexpr PictureSize picture{64, 128};
constexpr double half_down = .5, half_across = 1;  // of the plane, in metres
constexpr double radius = .12, apart = .35;        // of a disc; between the middles of two
constexpr int discs = 4, most_moves = 20;
constexpr double gain = .3;  // of what is left the oracle goes so much in a step
constexpr const char *not_reached = "not_reached", *wrong_disc = "wrong_disc", *blind = "reach_blind";

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

EnvironmentDescription about() {
  EnvironmentDescription about;
  about.id = "reach2d";
  about.tasks = {{"reach", {"plane"}, std::nullopt, {}, "reach2d_red", most_moves},
                 {blind, {"plane"}, std::nullopt, {}, "reach2d_blind", most_moves}};
  about.failures = {not_reached, wrong_disc};
  about.spaces = {"tabletop"};
  about.actions.numbers = {{"down", "m", -2 * gain * half_down, 2 * gain * half_down},
                           {"across", "m", -2 * gain * half_across, 2 * gain * half_across}};
  about.state = {{"down", "m", -half_down, half_down}, {"across", "m", -half_across, half_across}};
  about.picture = picture;
  for (const Colour& colour : colours) about.things.push_back({"round", colour.texture});
  about.most_things = discs;
  return about;
}

Vec2 pixel(Vec2 at) {  // x down, y across
  return {(at.x + half_down) / (2 * half_down) * picture.rows,
          (at.y + half_across) / (2 * half_across) * picture.columns};
}

class Plane : public Environment {
 public:
  Plane(const ActionSpace& space, bool has_state) : space_(space), has_state_(has_state) {}

  const ActionSpace& action_space() const override { return space_; }

  Observation reset(const Scene& scene) override {
    scene_ = scene;
    at_ = {scene.parameters.at("down"), scene.parameters.at("across")};
    steps_ = 0;
    return observe();
  }

  StepResult step(const Action& action) override {
    const Action by = action.empty() ? Action{0, 0} : executable(space_, action);  // empty: it gives up
    at_ = {std::clamp(at_.x + by[0], -half_down, half_down), std::clamp(at_.y + by[1], -half_across, half_across)};
    StepResult result;
    result.failure = ++steps_ == most_moves || action.empty() ? not_reached : failure::goes_on;
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
      const int pixels = draw(seen, o.position_m, radius, colour->rgb, o.instance_id);
      seen.instances.push_back({o.instance_id, o.object_type, o.texture, pixels});
    }
    draw(seen, at_, .04, {255, 255, 255}, 0);
    if (has_state_) seen.state = {at_.x, at_.y};
    return seen;
  }

  Action expert_action() const override { return expert_action_for(scene_.find(role::target)->instance_id); }

  Action expert_action_for(std::uint8_t id) const override {
    const auto& all = scene_.objects;
    const auto found = std::find_if(all.begin(), all.end(), [id](const SceneObject& o) { return o.instance_id == id; });
    if (found == all.end()) throw InputError("reach2d: no disc has that id");
    return {gain * (found->position_m.x - at_.x), gain * (found->position_m.y - at_.y)};
  }

 private:
  // A disc in picture and, unless its id is 0, ids. Returns its pixels.
  static int draw(Observation& seen, Vec2 middle, double of_radius, const std::array<std::uint8_t, 3>& rgb,
                  std::uint8_t id) {
    int pixels = 0;
    for (int row = 0; row < picture.rows; ++row)
      for (int column = 0; column < picture.columns; ++column) {
        const Vec2 away = Vec2{row + .5, column + .5} - pixel(middle);
        if (norm(away) > of_radius / (2 * half_down) * picture.rows) continue;
        const auto i = static_cast<std::size_t>(row * picture.columns + column);
        std::copy(rgb.begin(), rgb.end(), seen.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
        if (id != 0) seen.ids[i] = id;
        ++pixels;
      }
    return pixels;
  }

  const ActionSpace& space_;
  const bool has_state_;
  Scene scene_;
  Vec2 at_;
  int steps_ = 0;
};

class Reach2d : public SimpleEnvironment {
 public:
  Reach2d() : SimpleEnvironment(about()) {}

  const std::vector<StateNumber>& state_of(const TaskInfo& task) const override {
    return task.id == blind ? EnvironmentType::state_of(task) : SimpleEnvironment::state_of(task);
  }

 protected:
  // Discs lie anywhere; from where the point begins, the straight way to each is free of the others.
  void place(Scene& scene, RandomStream random) const override {
    Vec2 start;
    do {
      for (SceneObject& o : scene.objects) o.position_m = anywhere(random);
      start = anywhere(random);
    } while (!is_free(start, scene.objects));
    scene.parameters = {{"down", start.x}, {"across", start.y}};
  }

  std::unique_ptr<Environment> make(const std::string& task) const override {
    return std::make_unique<Plane>(action_space(), task != blind);
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

  // Whether a point that goes straight from one place to the other keeps away from a disc.
  static bool passes(Vec2 from, Vec2 to, Vec2 disc) {
    const Vec2 way = to - from, aside = disc - from;
    const double along = std::clamp((way.x * aside.x + way.y * aside.y) / (way.x * way.x + way.y * way.y), 0., 1.);
    return norm(aside - along * way) > 1.2 * radius;
  }
};

}  // namespace

LGABENCH_ENVIRONMENT("reach2d", "0.1", "A point that is steered to the disc that the command means", Reach2d)
