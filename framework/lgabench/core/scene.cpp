#include <lgabench/core/scene.hpp>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/turns.hpp>

namespace lgabench {

Json to_json(const Scene& scene) {
  Json objects = Json::array();
  for (const SceneObject& o : scene.objects) {
    objects.push_back({{"object_type", o.object_type},
                       {"texture", o.texture},
                       {"role", o.role},
                       {"position_m", {o.position_m.x, o.position_m.y}},
                       {"yaw_rad", o.yaw_rad},
                       {"instance_id", o.instance_id}});
    if (o.scale != 1) objects.back()["scale"] = o.scale;
  }
  Json json = scene.parameters;
  json.update({{"scenario", scene.scenario},
               {"arm", scene.arm},
               {"layout", scene.layout},
               {"split", scene.split},
               {"seed", scene.seed},
               {"index", scene.index},
               {"command", scene.command},
               {"task", scene.task},
               {"objects", std::move(objects)}});
  if (scene.friction != 1) json["friction"] = scene.friction;
  if (scene.mass != 1) json["mass"] = scene.mass;
  if (!scene.own.is_null()) json["own"] = scene.own;
  if (scene.errand) json["errand"] = to_json(*scene.errand);
  if (scene.pair) json["pair"] = *scene.pair;
  return json;
}

std::uint64_t Scene::hash() const { return hash64(canonical(to_json(*this))); }

std::vector<bool> meant_at_first(const Scene& scene) {
  std::vector<Named> on_table, next;
  for (const SceneObject& one : scene.objects) on_table.push_back({one.object_type, one.texture});
  if (scene.errand) next = wanted(*scene.errand, on_table, {});
  std::vector<bool> meant;
  for (std::size_t i = 0; i < on_table.size(); ++i)
    meant.push_back(scene.errand ? contains(next, on_table[i]) : scene.objects[i].role == role::target);
  return meant;
}

std::uint64_t Scene::shared_hash() const {
  if (!pair) return hash();
  Scene shared = *this;
  shared.scenario.clear();
  shared.errand.reset();
  shared.index = shared.command = 0;
  for (SceneObject& object : shared.objects)
    if (object.role == role::target) object.role = role::distractor;
  return shared.hash();
}

const SceneObject* Scene::find(const Role& role) const {
  for (const SceneObject& o : objects)
    if (o.role == role) return &o;
  return nullptr;
}

}  // namespace lgabench
