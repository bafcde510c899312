#include <mobile/mobile.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include <common/changed.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/suggest.hpp>
#include <mobile/content.hpp>
#include <mobile/drive.hpp>
#include <mobile/fetch.hpp>
#include <mobile/judge.hpp>
#include <mobile/perception.hpp>
#include <mobile/plan.hpp>
#include <mobile/receivers.hpp>
#include <mobile/renderer.hpp>
#include <mobile/sampler.hpp>
#include <mobile/tables.hpp>

namespace lgabench::mobile {
namespace {

const std::array<Task, 2>& fixed_tasks() {
  static const std::array<Task, 2> all{Task{"bring", tray, {-.3, .95}, pi / 2},
                                       Task{"throw_away", bin, {-.45, -.8}, -pi / 2}};
  return all;
}

Task fetch_task(const Scene& scene) {
  const SceneObject* goal = scene.find(receiver);
  if (!goal || !is_receiver(goal->object_type)) throw InputError("scene: expected a receiver with the role receiver");
  Task task{fetch, vessel_of(goal->object_type, goal->position_m), before(goal->position_m), 0};
  for (const SceneObject& o : scene.objects)
    if (o.role != receiver && is_receiver(o.object_type)) task.wrong.push_back(vessel_of(o.object_type, o.position_m));
  return task;
}

class Mobile final : public Environment {
 public:
  Mobile(std::unique_ptr<PhysicsWorld> world, bool fetches, const std::vector<BodyVariant>& variants)
      : world_(std::move(world)), renderer_(front_camera()) {
    std::vector<BodyModel> models;
    for (const Furniture& thing : furniture()) models.push_back(thing.body);
    for (std::size_t i = 0; fetches && i < receiver_types().size(); ++i) {
      receivers_[receiver_types()[i]] = static_cast<int>(models.size());
      models.push_back(model_of(receiver_types()[i]).body);
    }
    for (const BodyVariant& variant : variants)
      for (const auto& [type, textures] : natural_textures()) {
        models_[{type, variant.scale, variant.friction, variant.mass}] = static_cast<int>(models.size());
        models.push_back(varied(standing_model(type, variant.scale).body, variant));
      }
    world_->load(models, first_ + (fetches ? most_fetch_objects : most_objects));
  }

  const ActionSpace& action_space() const override { return plans(); }

  Observation reset(const Scene& scene) override {
    std::vector<VisibleObject> objects = visible_objects(scene);
    std::vector<BodyPlacement> placements;
    placements.reserve(first_ + objects.size());
    for (int i = 0; i < first_; ++i) placements.push_back({i, {}});
    for (const VisibleObject& object : objects) placements.push_back({model_index(scene, object), object.pose});
    task_ = task_of(scene);
    world_->reset(placements);
    scene_ = scene;
    objects_ = std::move(objects);
    before_ = poses();
    seen_by_ = &renderer_;
    return observe();
  }

  // Of another renderer: plans are carried out by what the usual camera shows.
  Observation look(const View& view) override {
    if (!in_view_) in_view_ = std::make_unique<Renderer>(front_camera());
    in_view_->look(view);
    seen_by_ = in_view_.get();
    return observe();
  }

  StepResult step(const Action& action) override {
    const Plan plan = executable(plans(), action);
    StepResult result;
    result.terminated = true;
    brought_.reset();
    result.failure = ended_ = carry_out(plan, result);
    result.is_success = result.failure == failure::none;
    result.observation = observe();
    return result;
  }

  Rejudged judged_again(const JudgeLimits& limits) const override {
    const std::vector<Pose> now = poses();
    return {brought_ ? judge(scene_, task_, before_, now, *brought_, limits) : ended_, off_m(scene_, task_, now)};
  }

  std::vector<EngineBody> bodies() const override {
    std::vector<EngineBody> all;
    for (int i = 0; i < static_cast<int>(scene_.objects.size()); ++i)
      all.push_back({world_->pose(first_ + i), world_->physics(first_ + i)});
    return all;
  }

  void show_shadows(bool on) override { shadows_ = on; }

  Observation observe() override {
    find_objects();
    return seen_by_->render(objects_, shadows_);
  }

  Action expert_action() const override {
    const SceneObject* target = scene_.find(role::target);
    if (!target) throw InputError("scene: expected an object with the role target");
    return expert_action_for(target->instance_id);
  }

  // Its visible pixel that is nearest to where its grasp point is seen.
  Action expert_action_for(std::uint8_t instance_id) const override {
    const auto found = std::find_if(objects_.begin(), objects_.end(),
                                    [&](const VisibleObject& o) { return o.instance_id == instance_id; });
    if (found == objects_.end()) throw InputError(fmt::format("scene: expected an object with id {}", instance_id));
    const std::size_t index = static_cast<std::size_t>(found - objects_.begin());
    const ObjectModel& model = model_of(found->object_type, found->scale);
    const Pose now = world_->pose(first_ + static_cast<int>(index));
    const Vec3 grasp = now.position_m + rotated(Vec3{model.grasp_m.x, model.grasp_m.y, model.height_m}, now.rotation);
    const Camera& camera = seen_by_->camera();
    const Vec2 at = camera.depth(grasp) > 0 ? camera.at(grasp) : Vec2{};
    find_objects();
    const std::vector<std::uint8_t> ids = seen_by_->ids(objects_);
    double least = std::numeric_limits<double>::infinity();
    Vec2 nearest = at;
    for (int row = 0; row < camera.size.rows; ++row)
      for (int column = 0; column < camera.size.columns; ++column) {
        if (ids[static_cast<unsigned>(row * camera.size.columns + column)] != instance_id) continue;
        const Vec2 pixel{row + 0., column + 0.};
        const double away = norm(pixel - at);
        if (away >= least) continue;
        least = away;
        nearest = pixel;
      }
    Plan plan;
    plan.u = std::clamp((nearest.y + .5) / camera.size.columns, 0., 1.);
    plan.v = std::clamp((nearest.x + .5) / camera.size.rows, 0., 1.);
    plan.waypoint_m = task_.waypoint_m;
    plan.cosine = std::cos(task_.heading_rad);
    plan.sine = std::sin(task_.heading_rad);
    plan.drop_m = task_.goal.centre;
    return plan;
  }

 private:
  static constexpr int first_ = 4;  // of the objects among the bodies: after the furniture

  int model_index(const Scene& scene, const VisibleObject& object) const {
    if (const auto found = receivers_.find(object.object_type); found != receivers_.end()) return found->second;
    const auto found = models_.find({object.object_type, object.scale, scene.friction, scene.mass});
    if (found != models_.end()) return found->second;
    throw InputError(
        fmt::format("scene {} {}: object type \"{}\" of size {:g}, friction {:g}, mass {:g} is not one "
                    "that this environment shows",
                    scene.scenario, scene.index, object.object_type, object.scale, scene.friction, scene.mass));
  }

  std::vector<Pose> poses() const {
    std::vector<Pose> all;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) all.push_back(world_->pose(first_ + static_cast<int>(i)));
    return all;
  }

  void find_objects() const {
    const std::vector<Pose> now = poses();
    for (std::size_t i = 0; i < now.size(); ++i) objects_[i].pose = now[i];
  }

  // What the carried object is let go above.
  Vessel under(Vec2 drop_m) const {
    if (task_.id != fetch || task_.goal.outer().contains(drop_m)) return task_.goal;
    for (const Vessel& other : task_.wrong)
      if (other.outer().contains(drop_m)) return other;
    return {drop_m, 0, table_top_m, table_top_m, table_top_m};
  }

  // What the ray through the plan's place in the last picture meets first.
  Surface aimed_at(const Plan& plan) const {
    const PictureSize size = front_camera().size;
    return renderer_.surface(std::min(static_cast<int>(plan.v * size.rows), size.rows - 1),
                             std::min(static_cast<int>(plan.u * size.columns), size.columns - 1));
  }

  // From the plan's place in the last picture to the nearest that shows a target; the picture's diagonal where none
  // does.
  double aim_px(const Plan& plan, const std::vector<std::uint8_t>& ids) const {
    const PictureSize size = front_camera().size;
    std::array<bool, 256> is_target{};
    for (const SceneObject& o : scene_.objects) is_target[o.instance_id] = o.role == role::target;
    const double row = std::min(std::floor(plan.v * size.rows), size.rows - 1.);
    const double column = std::min(std::floor(plan.u * size.columns), size.columns - 1.);
    double least = std::hypot(size.rows, size.columns);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (is_target[ids[i]]) {
        const int at = static_cast<int>(i), down = at / size.columns, right = at % size.columns;
        least = std::min(least, std::hypot(down - row, right - column));
      }
    return least;
  }

  bool cannot_drive(const Plan& plan) const {
    return blocked(plan.waypoint_m) || !within_reach(plan) || meets_person(plan.waypoint_m, plan.drop_m);
  }

  // A plan that cannot succeed ends where that shows: nothing moves.
  Failure carry_out(const Plan& plan, StepResult& result) {
    find_objects();
    const double aim = aim_px(plan, renderer_.ids(objects_));
    const Surface surface = aimed_at(plan);
    result.gaps = {{"reach_px", aim},
                   {"pick", aim == 0 ? 0. : 1.},
                   {"drive", cannot_drive(plan) ? 1. : 0.},
                   {"place_m", task_.goal.outer().away(plan.drop_m)},
                   {"others_m", 0}};
    if (surface.kind == Surface::Kind::furniture) return failure::wrong_object;
    if (surface.kind != Surface::Kind::object) return failure::missed_object;
    const auto& objects = scene_.objects;
    const auto taken = static_cast<std::size_t>(
        std::find_if(objects.begin(), objects.end(),
                     [&](const SceneObject& o) { return o.instance_id == surface.instance_id; }) -
        objects.begin());
    if (objects[taken].role != role::target) return failure::wrong_object;
    if (blocked(plan.waypoint_m)) return failure::blocked_way;
    if (!within_reach(plan)) return failure::out_of_reach;
    if (meets_person(plan.waypoint_m, plan.drop_m)) return failure::blocked_way;

    std::vector<bool> fixed(first_, true);
    for (const SceneObject& o : objects) fixed.push_back(is_receiver(o.object_type));
    result.recoverable = false;  // it has left the table
    result.truncated =
        !carry({*world_, fixed}, first_ + static_cast<int>(taken), surface.point_m, plan, under(plan.drop_m));
    result.gaps.resize(3);
    for (Gap& gap : gaps(scene_, task_, before_, poses(), taken)) result.gaps.push_back(std::move(gap));
    if (result.truncated) return failure::truncated;
    brought_ = taken;
    return judge(scene_, task_, before_, poses(), taken);
  }

  std::unique_ptr<PhysicsWorld> world_;
  mutable Renderer renderer_;
  std::unique_ptr<Renderer> in_view_;
  bool shadows_ = false;
  Renderer* seen_by_ = &renderer_;
  std::map<std::string, int> receivers_;                                   // by type
  std::map<std::tuple<std::string, double, double, double>, int> models_;  // by type, size, friction and mass
  Task task_;                                                              // the scene's
  Scene scene_;
  mutable std::vector<VisibleObject> objects_;  // in the scene's order, at their poses now
  std::vector<Pose> before_;
  Failure ended_ = failure::none;       // of the last step()
  std::optional<std::size_t> brought_;  // which object it took to the end, if any
};

class MobileType final : public EnvironmentType {
 public:
  MobileType()
      : tasks_{{"bring", {layout}, std::nullopt, {}, "bring_fruit"},
               {"throw_away", {layout}, std::nullopt, {}, "throw_away_drink"},
               {fetch, {layout}, SecondRole{receiver, "the thing to put it on or into"}, {}, "fetch_fruit"}},
        failures_{failure::missed_object,     failure::wrong_object,  failure::blocked_way,   failure::out_of_reach,
                  failure::dropped_elsewhere, failure::moved_another, failure::wrong_receiver} {
    for (TaskInfo& task : tasks_) task.failures = {failures_.begin() + 2, failures_.end() - (task.id == fetch ? 0 : 1)};
  }

  const std::string& id() const override { return id_; }
  const std::vector<TaskInfo>& tasks() const override { return tasks_; }
  const std::vector<std::string>& spaces() const override { return spaces_; }
  const std::vector<std::string>& failures() const override { return failures_; }
  const ActionSpace& action_space() const override { return plans(); }
  const ActionSpace& action_space_of(const TaskInfo& task) const override {
    return task.id == fetch ? fetch_plans() : plans();
  }
  PictureSize picture_size() const override { return front_camera().size; }
  int most_instances(const TaskInfo& task) const override {
    return task.id == fetch ? most_fetch_objects : most_objects;
  }
  Vec2 in_picture(Vec3 point_m) const override {
    if (front_camera().depth(point_m) <= 0) return {-1e6, -1e6};  // behind the camera
    const Vec2 at = front_camera().at(point_m);
    return {at.y + .5, at.x + .5};
  }
  std::vector<std::string> scenario_members(const TaskInfo& task) const override {
    return task.id == fetch ? std::vector<std::string>{} : mobile::scenario_members();
  }
  std::vector<std::string> scene_members(const TaskInfo& task) const override {
    return task.id == fetch ? fetch_scene_members() : mobile::scene_members();
  }
  std::shared_ptr<const SceneContent> read_content(const Scenario& scenario, const JsonReader& file,
                                                   const JsonReader* scenes, bool training) const override {
    for (const ScenarioCommand& command : scenario.commands)
      if (!command.truth.target.is_product()) file.at("commands").fail("one set as the target of each command");
    if (scenario.task == fetch) return std::make_shared<FetchContent>(read_fetch_content(scenario, scenes, training));
    return std::make_shared<Content>(mobile::read_content(scenario, file, scenes, training));
  }
  Scene sample(const Scenario& scenario, const SceneRequest& request, int index) const override {
    return scenario.task == fetch ? sample_fetch(scenario, request, index) : sample_scene(scenario, request, index);
  }
  int room_for_distractors(const Scenario& scenario) const override {
    const SceneContent& control = *scenario.tests.front().scenes;
    const auto* fetched = dynamic_cast<const FetchContent*>(&control);
    const int others = fetched ? fetched->distractors.second : dynamic_cast<const Content&>(control).distractors.second;
    return std::clamp((fetched ? most_fetch_others : most_objects - 1) - others, 0, most_added);
  }
  Scene with_distractors(const Scenario& scenario, Scene scene, int count, bool near_miss,
                         RandomStream random) const override {
    return scenario.task == fetch ? fetch_with_distractors(scenario, scene, count, near_miss, random)
                                  : mobile::with_distractors(scenario, scene, count, near_miss, random);
  }
  Scene resized(Scene scene, double scale) const override {
    return common::resized(std::move(scene), scale, [](const SceneObject& o) { return !is_receiver(o.object_type); });
  }
  Scene with_larger_target(Scene scene, const std::vector<double>& scales) const override {
    return common::with_larger_target(std::move(scene), scales, [](const Scene& larger, std::size_t target) {
      return has_room(larger.objects, target, room_left_m);
    });
  }
  Perceive perception(const SceneContent& scenes) const override {
    const auto* fetched = dynamic_cast<const FetchContent*>(&scenes);
    const std::optional<double> error =
        fetched ? fetched->caption_error : dynamic_cast<const Content&>(scenes).caption_error;
    if (!error) return nullptr;
    const auto model = fetched ? perceive_in_bad_light : perceive;
    return [e = *error, model](Observation seen, RandomStream stream) { return model(std::move(seen), e, stream); };
  }
  Observation draw(const Scene& scene, const View& view) const override {
    static Renderer& renderer = *new Renderer(front_camera());
    renderer.look(view);
    return renderer.render(visible_objects(scene));
  }
  bool has_views() const override { return true; }
  std::string world_of(const Scenario& scenario) const override { return scenario.task == fetch ? fetch : ""; }
  std::unique_ptr<Environment> make(std::unique_ptr<PhysicsWorld> engine, const Scenario& scenario) const override {
    return make_environment(std::move(engine), scenario.task == fetch, body_variants(scenario));
  }

 private:
  std::string id_ = "mobile";
  std::vector<TaskInfo> tasks_;
  const std::vector<std::string> spaces_{"household_mobile", "household"};
  std::vector<std::string> failures_;
};

}  // namespace

Task task_of(const Scene& scene) {
  if (scene.task == fetch) return fetch_task(scene);
  for (const Task& task : fixed_tasks())
    if (task.id == scene.task) return task;
  throw InputError(none_named("task", scene.task, {fixed_tasks()[0].id, fixed_tasks()[1].id, fetch}));
}

std::unique_ptr<Environment> make_environment(std::unique_ptr<PhysicsWorld> world, bool fetches,
                                              const std::vector<BodyVariant>& variants) {
  return std::make_unique<Mobile>(std::move(world), fetches, variants);
}

}  // namespace lgabench::mobile

const lgabench::EnvironmentType* lgabench_environment() {
  static const lgabench::mobile::MobileType type;
  return &type;
}
