#include <tabletop/task.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/suggest.hpp>

namespace lgabench::tabletop {
namespace {

template <class List, class Id>
auto named(const char* what, const List& list, const std::string& id, Id id_of) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& one) { return id_of(one) == id; });
  if (found != list.end()) return *found;
  std::vector<std::string> known;
  for (const auto& one : list) known.push_back(id_of(one));
  throw InputError(none_named(what, id, known));
}

bool comes_later(const Scene& scene, std::uint8_t instance_id) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [instance_id](const SceneObject& object) {
    return object.instance_id == instance_id && object.role == role::later;
  });
}

}  // namespace

void Task::place(const Layout& layout, const Content& content, std::vector<SceneObject>& objects,
                 const Streams& stream) const {
  const Patience patience = content.crowded() ? Patience{4, 10, 200} : Patience{};  // then a crowd is drawn again
  if (layout.target_places.empty())
    place_freely(
        layout, [&](const SceneObject& target) { return room(layout, target); }, patience, objects, stream);
  else
    place_on_cells(layout, objects, stream("layout"));
}

std::vector<Polygon> Task::room(const Layout&, const SceneObject&) const { return {}; }

Motion Task::carry_out(const Scene&, const Bodies& bodies, const TwoPoses& action) const {
  return pick_and_place(bodies, action);
}

const Task& find_task(const std::string& id) {
  return *named("task", tasks(), id, [](const Task* task) { return task->id(); });
}

Observation drawn(const Scene& scene, const View& view) {
  static thread_local Renderer renderer;
  std::vector<VisibleObject> objects = visible_objects(scene);
  objects.erase(std::remove_if(objects.begin(), objects.end(),
                               [&](const VisibleObject& one) { return comes_later(scene, one.instance_id); }),
                objects.end());
  return renderer.render(objects, find_task(scene.task).ground(), view);
}

Layout find_layout(const Task& task, const std::string& id) {
  return named(fmt::format("layout of {}", task.id()).c_str(), task.layouts(), id,
               [](const Layout& layout) { return layout.id; });
}

constexpr const char* turn = "angle_rad";
double asked_turn_rad(const Scene& scene) {
  const auto found = scene.parameters.find(turn);
  return found == scene.parameters.end() ? 0 : found->second;
}
void set_asked_turn(Scene& scene, double turn_rad) { scene.parameters[turn] = turn_rad; }

std::vector<Vec2> four_places() { return {{.375, -.36}, {.625, -.36}, {.375, -.06}, {.625, -.06}}; }

Layout released_layout(std::optional<Vec2> pallet) {
  constexpr double widest = .17;
  return {"released", {{.34375, -.265625}, {.34375, .125}}, {{.34375, .125}, {.625, -.265625}}, pallet, widest};
}

const SceneObject& expect(const Scene& scene, const Role& role) {
  const SceneObject* found = scene.find(role);
  if (!found) throw InputError(fmt::format("scene: expected an object with the role {}", role));
  return *found;
}

}  // namespace lgabench::tabletop
