#include <lgabench/cell/perturbed.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include <lgabench/core/error.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench {
namespace {

std::string hash_of(const std::string& bytes) { return hex(hash64(bytes)); }
std::string hash_of(const Json& json) { return hash_of(canonical(json)); }

Json size_json(const Vec3& size) { return {size.x, size.y, size.z}; }
Json pose_json(const Pose& pose) {
  const auto& [p, q] = pose;
  return {p.x, p.y, p.z, q.x, q.y, q.z, q.w};
}

std::string bytes_of(const std::vector<std::uint8_t>& values) { return {values.begin(), values.end()}; }

using Key = std::pair<std::string, int>;  // arm, index

// Of axes that are not as they declare.
[[noreturn]] void fail(const std::vector<const PerturbationAxis*>& axes, const std::string& what) {
  for (const PerturbationAxis* axis : axes)
    if (axis->of_plugin) throw MethodError(fmt::format("plugin {} (perturbation): {}", axis->id, what));
  throw EngineError(what);
}

Json named_instances(const Observation& observation) {
  Json names = Json::array();
  for (const Instance& one : observation.instances) names.push_back({one.id, one.object_type, one.texture});
  return names;
}

}  // namespace

std::string names_hash(const Observation& observation) {
  return hash_of(hash_of(bytes_of(observation.ids)) + hash_of(named_instances(observation)));
}

std::array<std::string, parts> parts_of(const PlayedScene& played, const Observation& observation,
                                        const Instruction* selected, const Instruction* told, const Observation* read) {
  const Scene& scene = played.scene;
  Json objects = to_json(scene).at("objects"), control = to_json(played.control), physics = Json::array(),
       pixels = Json::array();
  for (const char* member : {"arm", "command"})
    control.erase(member);                             // a scene is the control's whoever asks, and how
  for (Json& object : objects) object.erase("scale");  // of physics
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    physics.push_back({scene.objects[i].object_type, scene.objects[i].role});
    if (i >= played.bodies.size()) continue;
    objects[i]["pose"] = pose_json(played.bodies[i].pose);
    if (const auto& of = played.bodies[i].physics)
      physics.back().push_back({of->mass_kg, of->friction, size_json(of->high_m - of->low_m)});
  }
  const Observation& given = read ? *read : observation;
  for (const Instance& one : given.instances) pixels.push_back(one.pixels);
  std::array<std::string, parts> hashes;
  const auto of = [&hashes](EpisodePart part) -> std::string& { return hashes[static_cast<std::size_t>(part)]; };
  of(EpisodePart::objects) = hash_of(objects);
  of(EpisodePart::physics) = hash_of(Json{{"bodies", physics}, {"parameters", scene.parameters}});
  of(EpisodePart::rgb) = hash_of(bytes_of(observation.rgb));
  of(EpisodePart::ids) = hash_of(bytes_of(observation.ids));
  of(EpisodePart::instances) = hash_of(named_instances(observation));
  of(EpisodePart::control) = hash_of(control);
  std::string input = of(EpisodePart::rgb) + of(EpisodePart::ids) + of(EpisodePart::instances) + canonical(pixels);
  if (read) input += names_hash(*read);
  if (!given.state.empty()) input += canonical(Json(given.state));
  for (const std::uint16_t bits : given.shadows) {
    input += static_cast<char>(bits);
    input += static_cast<char>(bits >> 8);
  }
  if (selected && told) {
    of(EpisodePart::words) = hash_of(told->utterance);
    if (selected->selection.provenance != Provenance::none) {
      of(EpisodePart::answers) = hash_of(distribution_json(selected->selection));
      of(EpisodePart::selection) = hash_of(distribution_json(told->selection));
    }
    input += of(EpisodePart::words) + of(EpisodePart::selection);
  }
  of(EpisodePart::input) = hash_of(input);
  return hashes;
}

void expect_declared(const std::vector<PerturbedEpisode>& all, const std::vector<Episode>& episodes, bool actions,
                     const Scenario& scenario) {
  std::map<Key, const Action*> acted;
  for (const Episode& e : episodes)
    if (!e.action.empty()) acted[{e.arm, e.index}] = &e.action;
  std::map<int, const PerturbedEpisode*> control;
  struct Changed {
    int of_all = 0, differing = 0;
    std::vector<const PerturbationAxis*> axes{};
  };
  std::map<std::tuple<std::string, int, std::size_t>, Changed> changed;  // by axis, level, part
  for (const PerturbedEpisode& e : all) {
    if (e.axis.empty()) {
      control.emplace(e.index, &e);  // of the first arm
      continue;
    }
    const auto found = control.find(e.index);
    if (found == control.end()) continue;  // not played
    const std::vector<const PerturbationAxis*>& axes = scenario.arm(e.arm).axes;
    for (std::size_t part = 0; part < parts; ++part) {
      const bool differs = e.hashes[part] != found->second->hashes[part];
      const auto touches = [part](const PerturbationAxis* axis) {
        return axis->touches(static_cast<EpisodePart>(part));
      };
      if (differs && std::none_of(axes.begin(), axes.end(), touches))
        fail(axes, fmt::format("perturbation {} at level {}: {} differs from the control's in episode {}, which "
                               "the axis does not declare",
                               e.axis, e.level, part_names[part], e.index));
      const auto changes = [part](const PerturbationAxis* axis) {
        return std::count(axis->changes.begin(), axis->changes.end(), static_cast<EpisodePart>(part)) > 0;
      };
      if (e.hashes[part].empty() || std::none_of(axes.begin(), axes.end(), changes)) continue;
      Changed& one = changed[{e.axis, e.level, part}];
      ++one.of_all;
      one.differing += differs;
      one.axes = axes;
    }
    const auto same = [&](EpisodePart part) {
      return e.hashes[static_cast<std::size_t>(part)] == found->second->hashes[static_cast<std::size_t>(part)];
    };
    if (e.names != found->second->names && same(EpisodePart::rgb) && same(EpisodePart::ids) &&
        same(EpisodePart::instances))
      throw MethodError(fmt::format("names read: not those of the control for the same picture, in episode {} of {}",
                                    e.index, e.arm));
    constexpr auto input = static_cast<std::size_t>(EpisodePart::input);
    const auto one = acted.find({e.arm, e.index}), other = acted.find({found->second->arm, e.index});
    if (actions && e.hashes[input] == found->second->hashes[input] && one != acted.end() && other != acted.end() &&
        *one->second != *other->second)
      throw MethodError(
          fmt::format("act(): not the action of the control for the same input, in episode {} of {}", e.index, e.arm));
  }
  for (const auto& [what, counts] : changed)
    if (counts.differing < fewest_changed * counts.of_all)
      fail(counts.axes,
           fmt::format("perturbation {} at level {}: {} equals the control's in {} of {} episodes, though the axis "
                       "declares a change",
                       std::get<0>(what), std::get<1>(what), part_names[std::get<2>(what)],
                       counts.of_all - counts.differing, counts.of_all));
}

}  // namespace lgabench
