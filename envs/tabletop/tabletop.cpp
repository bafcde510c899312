#include <tabletop/tabletop.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <common/changed.hpp>
#include <common/objects.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/random.hpp>
#include <tabletop/content.hpp>
#include <tabletop/errand.hpp>
#include <tabletop/judge.hpp>
#include <tabletop/near_misses.hpp>
#include <tabletop/raster.hpp>
#include <tabletop/renderer.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {
namespace {

class Tabletop final : public Environment {
 public:
  Tabletop(std::unique_ptr<PhysicsWorld> world, const FeatureSpace& space, int bodies,
           const std::vector<BodyVariant>& variants, bool matched_sizes)
      : world_(std::move(world)) {
    std::vector<BodyModel> models;
    const auto add = [&](const std::string& type, bool fixed, const BodyVariant& variant) {
      models_[{type, fixed, variant.scale, variant.friction, variant.mass}] = static_cast<int>(models.size());
      models.push_back(varied(object_model(type, variant.scale).body, variant));
      models.back().fixed = fixed;
    };
    for (const BodyVariant& variant : variants) {
      for (const std::string& type : space.object_types) add(type, false, variant);
      if (models_.count({goal_type, true, 1, 1, 1}) == 0) add(goal_type, true, {});
    }
    for (const std::string& type : space.object_types)
      for (const double scale : matched_sizes ? matched_scales(type) : std::vector<double>()) {
        BodyVariant variant;
        variant.scale = scale;
        if (models_.count({type, false, scale, 1, 1}) == 0) add(type, false, variant);
      }
    world_->load(models, bodies);
  }

  const ActionSpace& action_space() const override { return two_poses(); }

  Observation reset(const Scene& scene) override {
    std::vector<VisibleObject> objects = visible_objects(scene);
    std::vector<BodyPlacement> placements;
    std::vector<bool> fixed, there;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      fixed.push_back(scene.objects[i].role == role::goal);
      const auto model =
          fixed[i] ? models_.find({objects[i].object_type, true, 1, 1, 1})
                   : models_.find({objects[i].object_type, false, objects[i].scale, scene.friction, scene.mass});
      if (model == models_.end())
        throw InputError(
            fmt::format("scene {} {}: object type \"{}\" with role {}, size {:g}, friction {:g}, mass {:g} is not "
                        "among the environment's",
                        scene.scenario, scene.index, objects[i].object_type, scene.objects[i].role, objects[i].scale,
                        scene.friction, scene.mass));
      there.push_back(scene.objects[i].role != role::later);
      placements.push_back({model->second, there[i] ? objects[i].pose : beside_the_table(i)});
    }
    world_->reset(placements);
    task_ = &find_task(scene.task);
    scene_ = scene;
    objects_ = std::move(objects);
    placements_ = std::move(placements);
    fixed_ = std::move(fixed);
    there_ = std::move(there);
    errand_.reset();
    if (scene_.errand) errand_.emplace(scene_);
    steps_ = 0;
    went_wrong_ = failure::none;
    return look({});
  }

  Observation look(const View& view) override {
    view_ = view;
    return observe();
  }

  void show_shadows(bool on) override { shadows_ = on; }

  StepResult step(const Action& action) override {
    if (errand_) return errand_step(action);
    const TwoPoses carried_out = executable(two_poses(), action);
    const std::vector<Pose> before = poses();
    Motion motion = task_->carry_out(scene_, {*world_, fixed_}, carried_out);
    if (went_wrong_ == failure::none) went_wrong_ = motion.failure;
    motion.failure = went_wrong_;
    const std::vector<Pose> reached = poses();
    last_ = motion;
    StepResult result;
    result.observation = observe();
    result.terminated = true;
    result.truncated = !motion.came_to_rest;
    result.failure = judge(scene_, reached, motion);
    result.is_success = result.failure == failure::none;
    result.gaps = gaps(scene_, carried_out, before, reached, motion);
    if (motion.taken != no_body) result.taken = scene_.objects[static_cast<std::size_t>(motion.taken)].instance_id;
    result.recoverable = !result.truncated && result.failure != failure::left_workspace && went_wrong_ == failure::none;
    return result;
  }

  Rejudged judged_again(const JudgeLimits& limits) const override {
    if (errand_) throw InputError("environment: the judge of errands has no limits to change");
    const std::vector<Pose> reached = poses();
    return {judge(scene_, reached, last_, limits), off_m(scene_, reached)};
  }

  std::vector<EngineBody> bodies() const override {
    std::vector<EngineBody> all;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i)
      all.push_back({world_->pose(static_cast<int>(i)), world_->physics(static_cast<int>(i))});
    return all;
  }

  Observation observe() override {
    const std::vector<Pose> now = poses();
    for (std::size_t i = 0; i < now.size(); ++i) objects_[i].pose = now[i];
    if (!errand_) return renderer_.render(objects_, task_->ground(), view_, shadows_);
    std::vector<VisibleObject> in_view;
    for (std::size_t i = 0; i < now.size(); ++i)
      if (there_[i]) in_view.push_back(objects_[i]);
    Observation seen = renderer_.render(in_view, task_->ground(), view_, shadows_);
    seen.brought = errand_->brought();
    return seen;
  }

  Action expert_action() const override {
    if (!errand_) return expert_action_for(expect(scene_, role::target).instance_id);
    const std::vector<std::size_t> wanted = errand_->wanted();
    if (wanted.empty() || errand_->is_done()) return {};
    RandomStream stream(fmt::format("oracle/{}/{}", hex(scene_.shared_hash()), steps_));
    const std::size_t one = wanted[stream.below(static_cast<std::uint32_t>(wanted.size()))];
    return expert_action_for(scene_.objects[one].instance_id);
  }

  Action expert_action_for(std::uint8_t instance_id) const override {
    const auto& objects = scene_.objects;
    const auto found = std::find_if(objects.begin(), objects.end(),
                                    [instance_id](const SceneObject& o) { return o.instance_id == instance_id; });
    if (found == objects.end()) throw InputError(fmt::format("scene: expected an object with id {}", instance_id));
    return misread(task_->expert_action(scene_, poses(), *world_, static_cast<std::size_t>(found - objects.begin())));
  }

 private:
  // Out of every picture, each by itself.
  static Pose beside_the_table(std::size_t object) {
    constexpr double away_m = 10;
    return {{away_m + static_cast<double>(object), 0, 0}, {}};
  }

  StepResult errand_step(const Action& action) {
    StepResult result;
    ++steps_;
    if (action.empty()) {
      result.failure = errand_->ended();
    } else {
      const TwoPoses carried_out = executable(two_poses(), action);
      const std::vector<Pose> before = poses();
      const Errand began = *errand_;
      const Motion motion = task_->carry_out(scene_, {*world_, fixed_}, carried_out);
      const std::vector<Pose> reached = poses();
      result.gaps = errand_gaps(scene_, began, carried_out, before, reached, motion);
      if (motion.taken != no_body) result.taken = scene_.objects[static_cast<std::size_t>(motion.taken)].instance_id;
      result.failure = errand_->moved(reached, motion);
      const bool is_only = task_->most_steps() == 1;
      while (!is_only && result.failure == failure::goes_on && person_comes())
        result.failure = errand_->moved(poses(), settled());
      if (is_only && result.failure == failure::goes_on)
        result.failure = !errand_->brought().empty() ? errand_->ended()
                         : motion.taken == no_body   ? failure::missed_object
                                                     : failure::bad_placement;
    }
    result.observation = observe();
    result.terminated = result.failure != failure::goes_on;
    result.truncated = result.failure == failure::truncated;
    result.is_success = result.failure == failure::none;
    result.recoverable = !result.terminated;
    return result;
  }

  // Takes away what the errand no longer has on the table, and puts down what it has now; false where nothing is to be
  // done. All else stays as it lies.
  bool person_comes() {
    const std::vector<Pose> now = poses();
    std::vector<std::size_t> comes;
    bool goes = false;
    for (std::size_t i = 0; i < now.size(); ++i) {
      placements_[i].pose = now[i];
      if (there_[i] == errand_->on_table(i)) continue;
      there_[i] = !there_[i];
      if (there_[i]) {
        comes.push_back(i);
      } else {
        placements_[i].pose = beside_the_table(i);
        goes = true;
      }
    }
    for (const std::size_t i : comes) placements_[i].pose = free_place(i);
    if (!goes && comes.empty()) return false;
    world_->reset(placements_);
    return true;
  }

  Motion settled() {
    const Bodies bodies{*world_, fixed_};
    Clock clock(*world_);
    return {no_body, settle(bodies, clock), failure::none};
  }

  // The object's own place or, where something was pushed there, the nearest that is free.
  Pose free_place(std::size_t object) const {
    constexpr double margin_m = .002, spacing_m = .01, farthest_m = .5;
    constexpr int directions = 16;
    std::vector<SceneObject> all;
    for (std::size_t i = 0; i < placements_.size(); ++i) {
      if (i == object || !there_[i]) continue;
      const auto& [position_m, rotation] = placements_[i].pose;
      all.push_back(scene_.objects[i]);
      all.back().position_m = {position_m.x, position_m.y};
      all.back().yaw_rad = yaw_of(rotation);
    }
    const SceneObject& own = scene_.objects[object];
    all.push_back(own);
    for (double away_m = 0; away_m < farthest_m; away_m += spacing_m)
      for (int i = 0; i < (away_m > 0 ? directions : 1); ++i) {
        all.back().position_m = own.position_m + rotated({away_m, 0}, 2 * pi * i / directions);
        if (!has_room({}, all, all.size() - 1, margin_m)) continue;
        return {{all.back().position_m.x, all.back().position_m.y, 0}, from_yaw(own.yaw_rad)};
      }
    throw EngineError(fmt::format("scene {} of {}: no room for the object that comes later", scene_.index, scene_.arm));
  }

  // Both places as if the picture were the usual view's; an object's height does not show from straight above.
  TwoPoses misread(TwoPoses action) const {
    if (view_ == View()) return action;  // to the bit
    const Camera usual, camera(view_);
    for (PlanarPose* const pose : {&action.pose0, &action.pose1}) {
      const Vec2 seen = camera.at(pose->position_m);
      pose->position_m = usual.point(seen.x, seen.y);
    }
    return action;
  }

  std::vector<Pose> poses() const {
    std::vector<Pose> all;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) all.push_back(world_->pose(static_cast<int>(i)));
    return all;
  }

  std::unique_ptr<PhysicsWorld> world_;
  Renderer renderer_;
  // By type, whether it is fixed, size, friction and mass.
  std::map<std::tuple<std::string, bool, double, double, double>, int> models_;
  const Task* task_ = nullptr;  // the scene's
  Scene scene_;
  std::vector<VisibleObject> objects_;  // in the scene's order, at their poses now
  std::vector<BodyPlacement> placements_;
  std::vector<bool> fixed_, there_;  // there_: on the table, where a person takes things away or brings one
  std::optional<Errand> errand_;     // the scene's
  int steps_ = 0;                    // of the errand
  View view_;
  bool shadows_ = false;
  Motion last_;                         // what step() carried out
  Failure went_wrong_ = failure::none;  // in a motion since the scene's beginning
};

bool matches_sizes(const Scenario& scenario) {
  const auto matched = [](const Content& content) { return content.near_miss && content.near_miss->size_matched; };
  return matched(content_of(*scenario.train)) ||
         std::any_of(scenario.tests.begin(), scenario.tests.end(),
                     [&matched](const Arm& arm) { return matched(content_of(*arm.scenes)); });
}

// More than usual only where a scene can hold more: their number shows in an engine's last digits.
int bodies_of(const Scenario& scenario) {
  int bodies = most_bodies;
  const auto hold = [&bodies](const SceneContent& scenes) {
    const Content& content = content_of(scenes);
    bodies = std::max(bodies, content.others() + 2);  // with target and goal
  };
  hold(*scenario.train);
  for (const Arm& arm : scenario.tests) hold(*arm.scenes);
  if (const int more = more_bodies(scenario); more > 0)
    bodies = std::max(bodies, content_of(*scenario.tests.front().scenes).others() + more + 2);
  return bodies;
}

class TabletopType final : public EnvironmentType {
 public:
  TabletopType() {
    failures_ = {failure::missed_object, failure::wrong_object};
    for (const Task* task : tabletop::tasks()) {
      TaskInfo info{task->id(), {}, std::nullopt, task->failures(), task->example(), task->most_steps()};
      for (const Layout& layout : task->layouts()) info.layouts.push_back(layout.id);
      if (const auto second = task->second()) info.second = *second;
      tasks_.push_back(info);
      if (task->has_errand()) continue;
      most_instances_ = std::max(most_instances_, task->most_distractors() + 2);  // with target and goal
      for (const std::string& word : info.failures)
        if (!contains(failures_, word)) failures_.push_back(word);
    }
    failures_.emplace_back(failure::left_workspace);
    failures_.emplace_back(failure::not_meant);
  }

  const std::string& id() const override { return id_; }
  const std::vector<TaskInfo>& tasks() const override { return tasks_; }
  const std::vector<std::string>& spaces() const override { return spaces_; }
  std::optional<Showcase> showcase() const override {
    return Showcase{"household", "yellow", "tabletop", "pallet", {.5, 0}};
  }
  const std::vector<std::string>& failures() const override { return failures_; }
  const ActionSpace& action_space() const override { return two_poses(); }
  PictureSize picture_size() const override { return Workspace::picture; }
  int most_instances(const TaskInfo& task) const override {
    return task.most_steps == 1 ? most_instances_ : find_task(task.id).most_distractors() + 2;
  }
  // The corner of the first pixel is half a pixel before its centre.
  Vec2 in_picture(Vec3 point_m) const override {
    const Vec2 at = tabletop::in_picture(point_m.x, point_m.y);
    return {at.y + .5, at.x + .5};
  }
  std::vector<std::string> scenario_members(const TaskInfo& task) const override {
    return tabletop::scenario_members(find_task(task.id));
  }
  std::vector<std::string> scene_members(const TaskInfo& task) const override {
    return tabletop::scene_members(find_task(task.id));
  }
  std::shared_ptr<const SceneContent> read_content(const Scenario& scenario, const JsonReader& file,
                                                   const JsonReader* scenes, bool training) const override {
    return std::make_shared<Content>(tabletop::read_content(scenario, file, scenes, training));
  }
  Scene sample(const Scenario& scenario, const SceneRequest& request, int index) const override {
    return sample_scene(scenario, request, index);
  }
  std::optional<ActionDistance> distance(const TaskInfo& task, const Action& one, const Action& other) const override {
    const TwoPoses a = executable(two_poses(), one), b = executable(two_poses(), other);
    ActionDistance distance{norm(a.pose0.position_m - b.pose0.position_m),
                            norm(a.pose1.position_m - b.pose1.position_m)};
    if (find_task(task.id).judges_turn())
      distance.turn_rad = std::abs(std::remainder(yaw_of(a.pose1.rotation) - yaw_of(b.pose1.rotation), 2 * pi));
    return distance;
  }
  // Where wide targets leave no room for more than usual there is none for perturbations either.
  int room_for_distractors(const Scenario& scenario) const override {
    constexpr int usual = 2;
    const Content& control = content_of(*scenario.tests.front().scenes);
    const int most = find_task(scenario.task).most_distractors();
    if (control.by_meaning || control.persons || control.errands || control.cue || !control.choice.empty() ||
        most <= usual)
      return 0;
    return std::min(most_added, std::max(0, most - control.distractors.second));
  }
  Scene with_distractors(const Scenario& scenario, Scene scene, int count, bool near_miss,
                         RandomStream random) const override {
    return tabletop::with_distractors(scenario, scene, count, near_miss, random);
  }
  Scene resized(Scene scene, double scale) const override {
    return common::resized(std::move(scene), scale, [](const SceneObject& o) { return o.role != role::goal; });
  }
  Scene with_larger_target(Scene scene, const std::vector<double>& scales) const override {
    const Task& task = find_task(scene.task);
    const Layout layout = find_layout(task, scene.layout);
    const Room room = [&](const SceneObject& target) { return task.room(layout, target); };
    return common::with_larger_target(std::move(scene), scales, [&room](const Scene& larger, std::size_t target) {
      return has_room(room, larger.objects, target, room_left_m);
    });
  }
  Observation draw(const Scene& scene, const View& view) const override { return drawn(scene, view); }
  bool has_views() const override { return true; }
  Json shown_members(const Scenario& scenario, const SceneRequest& request) const override {
    const int shown = content_of(*scenario.train).members;
    if (shown == 0) return nullptr;
    Json commands = Json::array();
    for (int command = 0; command < static_cast<int>(scenario.commands.size()); ++command) {
      Json pairs = Json::array();
      for (const auto& [type, texture] : members_of(scenario, request.layout, command, request.seed)) {
        if (static_cast<int>(pairs.size()) == shown) break;
        pairs.push_back(Json::array({type, texture}));
      }
      commands.push_back(std::move(pairs));
    }
    return commands;
  }
  // Fixed places cannot show where things lie beside each other, nor more things than they are.
  std::vector<std::string> layouts_of(const Scenario& scenario) const override {
    const Content& train = content_of(*scenario.train);
    const bool anywhere = train.by_meaning || train.persons || train.cue || more_bodies(scenario) > 0;
    std::vector<std::string> ids;
    for (const Layout& layout : find_task(scenario.task).layouts())
      if (!anywhere || layout.target_places.empty()) ids.push_back(layout.id);
    return ids;
  }
  std::string goal_type() const override { return tabletop::goal_type; }
  std::string world_of(const Scenario& scenario) const override {
    const int bodies = bodies_of(scenario);
    return bodies == most_bodies ? "" : fmt::format("{} bodies", bodies);
  }
  std::unique_ptr<Environment> make(std::unique_ptr<PhysicsWorld> engine, const Scenario& scenario) const override {
    return make_environment(std::move(engine), scenario.space, bodies_of(scenario), body_variants(scenario),
                            matches_sizes(scenario));
  }

 private:
  std::string id_ = "tabletop";
  int most_instances_ = most_bodies;
  std::vector<TaskInfo> tasks_;
  const std::vector<std::string> spaces_{"tabletop", "household"};
  std::vector<std::string> failures_;
};

}  // namespace

std::unique_ptr<Environment> make_environment(std::unique_ptr<PhysicsWorld> world, const FeatureSpace& space,
                                              int bodies, const std::vector<BodyVariant>& variants,
                                              bool matched_sizes) {
  return std::make_unique<Tabletop>(std::move(world), space, bodies, variants, matched_sizes);
}

}  // namespace lgabench::tabletop

const lgabench::EnvironmentType* lgabench_environment() {
  static const lgabench::tabletop::TabletopType type;
  return &type;
}
