#include <tabletop/meant.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include <common/objects.hpp>
#include <tabletop/alike.hpp>
#include <tabletop/cue.hpp>
#include <tabletop/near_misses.hpp>
#include <tabletop/raster.hpp>

namespace lgabench::tabletop {
namespace {

using Rule = Which::Rule;
constexpr double column_margin_m = .08, distance_margin_m = .10;

struct Draw {
  const Scenario& scenario;
  const Content& content;
  const Meaning& truth;
  RandomStream random;

  bool undecided(const Features& one) const {
    return std::any_of(content.undecided.begin(), content.undecided.end(),
                       [&one](const FeatureSet& set) { return set.contains(one.type, one.texture); });
  }
  bool reference(const Features& one) const {
    return truth.which && truth.which->of && truth.which->of->contains(one.type, one.texture);
  }
  bool belongs(const Features& one) const { return truth.belongs(one.type, one.texture); }
  bool in_words(const Features& one) const { return content.words && content.words->belongs(one.type, one.texture); }
  bool may_be_meant(const Features& one) const { return !undecided(one) && !reference(one); }
  // Nothing that anybody could take for what is meant.
  bool plain(const Features& one) const {
    return may_be_meant(one) && !belongs(one) && !in_words(one) &&
           !(content.cue && content.cue->look.contains(one.type, one.texture));
  }
  bool near_miss(const Features& one) const {
    return std::any_of(content.near_miss_sets.begin(), content.near_miss_sets.end(),
                       [&one](const FeatureSet& set) { return set.contains(one.type, one.texture); });
  }

  // Of any of the sets, each with equal odds, one that may be; nothing if a thousand draws find none.
  std::optional<Features> of(const std::vector<FeatureSet>& sets, const std::function<bool(const Features&)>& may_be,
                             double widest_m) {
    for (int attempt = 0; attempt < 1000; ++attempt) {
      const FeatureSet& set = sets[random.below(static_cast<std::uint32_t>(sets.size()))];
      if (set.empty()) continue;
      const Features one{any_of(set.object_types, random), any_of(set.textures, random)};
      if (can_show(one.type, widest_m) && may_be(one)) return one;
    }
    return std::nullopt;
  }

  Features expect(const char* whom, const std::vector<FeatureSet>& sets,
                  const std::function<bool(const Features&)>& may_be, double widest_m) {
    if (auto one = of(sets, may_be, widest_m)) return *one;
    throw NothingToShow(
        fmt::format("scenario \"{}\": expected {} that can be shown and is not undecided", scenario.id, whom));
  }
};

SceneObject object(const Features& features, const Role& role) {
  return {features.type, features.texture, role, {}, 0, 0};
}

// The target and, in a misleading scene of a rule, a second object that belongs.
std::vector<SceneObject> sample_belonging(Draw& draw, bool misleading, double widest_m) {
  const Meaning& truth = draw.truth;
  const auto may_be_meant = [&draw](const Features& one) { return draw.may_be_meant(one); };
  Features target = draw.expect("a target", truth.sets, may_be_meant, widest_m);
  if (!truth.which || !misleading) return {object(target, role::target)};
  const bool in_order = truth.which->rule == Rule::first_in;
  const auto place = [&truth](const Features& one) { return place_in_order(truth, one.type, one.texture); };
  const auto another = [&](const Features& one) {
    return draw.may_be_meant(one) && (!in_order || place(one) != place(target));
  };
  Features also = draw.expect("a second object that belongs", truth.sets, another, widest_m);
  if (in_order && place(also) < place(target)) std::swap(target, also);
  return {object(target, role::target), object(also, role::not_meant)};
}

SceneObject sample_near_miss(Draw& draw, double widest_m) {
  const auto near = [&draw](const Features& one) { return draw.may_be_meant(one) && !draw.belongs(one); };
  const Features one = draw.expect("a near miss", draw.content.near_miss_sets, near, widest_m);
  return object(one, draw.in_words(one) ? role::not_meant : role::distractor);
}

// Beside these objects; nothing where none share alike with them.
std::optional<std::vector<Features>> sample_alike(Draw& draw, const std::vector<SceneObject>& objects,
                                                  const std::function<Features()>& distractor, double widest_m) {
  constexpr int fresh = 3;
  std::vector<Features> there, others;
  for (const SceneObject& one : objects) there.push_back({one.object_type, one.texture});
  for (int i = 0; i < fresh; ++i) others.push_back(distractor());
  const auto may_be = [&](const Features& one) {
    const bool another_near_miss = draw.truth.which && draw.near_miss(one);  // of which a rule would have to choose
    return draw.plain(one) && !another_near_miss && can_show(one.type, widest_m);
  };
  return sharing_alike(there, others, draw.content.distractors, may_be, draw.random);
}

std::optional<std::vector<Features>> sample_others(Draw& draw, const std::vector<SceneObject>& objects,
                                                   double widest_m) {
  const FeatureSet all{draw.scenario.space.object_types, draw.scenario.space.textures};
  const auto plain = [&draw](const Features& one) { return draw.plain(one); };
  const auto distractor = [&] { return draw.expect("a distractor", {all}, plain, widest_m); };
  if (draw.content.near_miss) return sample_alike(draw, objects, distractor, widest_m);
  const auto [fewest, most] = draw.content.distractors;
  const int count = fewest + static_cast<int>(draw.random.below(static_cast<std::uint32_t>(most - fewest + 1)));
  std::vector<Features> some;
  for (int i = 0; i < count; ++i) some.push_back(distractor());
  return some;
}

// Nothing where no further objects share alike with these.
std::optional<std::vector<SceneObject>> sample(Draw& draw, double widest_m) {
  constexpr double any_width = std::numeric_limits<double>::infinity();
  const auto& which = draw.truth.which;
  const auto anything = [](const Features&) { return true; };
  const bool misleading = draw.random.uniform() < draw.content.misleading;
  std::vector<SceneObject> objects = sample_belonging(draw, misleading, widest_m);
  if (which && which->of)
    objects.push_back(object(draw.expect("a reference", {*which->of}, anything, any_width), role::distractor));
  if (misleading && !draw.content.near_miss_sets.empty()) objects.push_back(sample_near_miss(draw, widest_m));
  const auto distractors = sample_others(draw, objects, widest_m);
  if (!distractors) return std::nullopt;
  for (const Features& one : *distractors) objects.push_back(object(one, role::distractor));
  return objects;
}

double away_m(const SceneObject& a, const SceneObject& b) { return norm(a.position_m - b.position_m); }

// Nothing that belongs is so near to being the one that a reader could doubt it.
bool is_plain(const Meaning& truth, const std::vector<SceneObject>& objects) {
  const Which& which = *truth.which;
  std::vector<const SceneObject*> candidates, references;
  for (const SceneObject& one : objects) {
    const bool reference = which.of && which.of->contains(one.object_type, one.texture);
    if (reference)
      references.push_back(&one);
    else if (truth.belongs(one.object_type, one.texture))
      candidates.push_back(&one);
  }
  const auto apart = [](double a, double b, double margin) { return std::abs(a - b) >= margin; };
  const SceneObject& target = objects.front();
  for (const SceneObject* one : candidates) {
    for (const SceneObject* reference : references)
      if ((which.rule == Rule::left_of || which.rule == Rule::right_of) &&
          !apart(one->position_m.y, reference->position_m.y, column_margin_m))
        return false;
    if (one == &target) continue;
    if ((which.rule == Rule::leftmost || which.rule == Rule::rightmost) &&
        !apart(one->position_m.y, target.position_m.y, column_margin_m))
      return false;
    if (which.needs_reference() && !references.empty() &&
        !apart(away_m(*one, *references.front()), away_m(target, *references.front()), distance_margin_m))
      return false;
  }
  return true;
}

// The scene's picture, with ids in the order of the objects.
Observation picture(const Task& task, const Layout& layout, const std::vector<SceneObject>& objects) {
  Scene scene;
  scene.task = task.id();
  scene.objects = objects;
  if (layout.pallet) scene.objects.push_back({goal_type, goal_texture, role::goal, *layout.pallet, 0, 0});
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    scene.objects[i].instance_id = static_cast<std::uint8_t>(i + 1);
  return drawn(scene);
}

// The same picture of their positions alone, a pixel each: what it does not show need not be drawn.
Observation sketch(const Layout& layout, const std::vector<SceneObject>& objects) {
  Observation seen;
  seen.size = {rows, columns};
  seen.ids.resize(pixels);
  const auto mark = [&seen](Vec2 position_m, const std::string& type, const std::string& texture) {
    const Vec2 at = in_picture(position_m.x, position_m.y);
    const int row = std::clamp(static_cast<int>(std::lround(at.x)), 0, rows - 1);
    const int column = std::clamp(static_cast<int>(std::lround(at.y)), 0, columns - 1);
    seen.instances.push_back({static_cast<std::uint8_t>(seen.instances.size() + 1), type, texture});
    seen.ids[static_cast<std::size_t>(row * columns + column)] = seen.instances.back().id;
  };
  for (const SceneObject& one : objects) mark(one.position_m, one.object_type, one.texture);
  if (layout.pallet) mark(*layout.pallet, goal_type, goal_texture);
  return seen;
}

// What is seen is what is meant: the target alone; and a near miss, if one stands there, would be chosen by the rule of
// a position without what it is that the near miss lacks.
bool shows(const Observation& seen, const Meaning& truth, const Content& content) {
  if (grounded(truth, seen) != std::vector<std::uint8_t>{1}) return false;
  if (!truth.which || truth.which->rule == Rule::first_in) return true;
  Meaning careless = truth;
  careless.sets.insert(careless.sets.end(), content.near_miss_sets.begin(), content.near_miss_sets.end());
  const auto near = std::find_if(seen.instances.begin(), seen.instances.end(), [&](const Instance& one) {
    return careless.belongs(one.object_type, one.texture) && !truth.belongs(one.object_type, one.texture) &&
           !(truth.which->of && truth.which->of->contains(one.object_type, one.texture));
  });
  return near == seen.instances.end() || grounded(careless, seen) == std::vector<std::uint8_t>{near->id};
}

}  // namespace

std::vector<SceneObject> meant_objects(const Scenario& scenario, const Task& task, const Layout& layout,
                                       const Content& content, const Meaning& truth, const Streams& stream) {
  constexpr int draws = 50, placements = 40;
  if (!layout.target_places.empty())
    throw InputError(fmt::format("scenario \"{}\": expected the layout continuous, got {}", scenario.id, layout.id));
  Draw draw{scenario, content, truth, stream("meant")};
  for (int i = 0; i < draws; ++i) {
    const auto sampled = sample(draw, std::min(layout.widest_m, content.widest_m()));
    if (!sampled) continue;
    for (int j = 0; j < placements; ++j) {
      std::vector<SceneObject> objects = *sampled;
      try {
        task.place(layout, content, objects,
                   [&](const std::string& purpose) { return stream(fmt::format("{}/{}/{}", purpose, i, j)); });
      } catch (const NoRoom&) {
        break;  // other objects may fit
      }
      if (truth.which && !(is_plain(truth, objects) && shows(sketch(layout, objects), truth, content))) continue;
      if (content.cue && !add_cue(task, layout, *content.cue, objects, stream("cue"))) continue;
      if (shows(picture(task, layout, objects), truth, content)) return objects;
    }
  }
  throw NothingToShow(
      fmt::format("scenario \"{}\": expected room for the target where the command alone tells it", scenario.id));
}

}  // namespace lgabench::tabletop
