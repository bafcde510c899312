#include <tabletop/sampler.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>

#include <common/changed.hpp>
#include <common/objects.hpp>
#include <lgabench/core/sampling.hpp>
#include <tabletop/cue.hpp>
#include <tabletop/errand_scenes.hpp>
#include <tabletop/meant.hpp>
#include <tabletop/near_misses.hpp>
#include <tabletop/rivals.hpp>
#include <tabletop/task.hpp>

#include <lgabench/core/contains.hpp>

namespace lgabench::tabletop {
namespace {

// Uniform over what of the distribution can be shown. `whom` is named in errors.
Features sample_features(const Scenario& scenario, const Layout& layout, const FeatureSet& distribution,
                         double widest_m, const char* whom, RandomStream& random) {
  std::vector<std::string> types;
  std::copy_if(distribution.object_types.begin(), distribution.object_types.end(), std::back_inserter(types),
               [&](const std::string& type) { return can_show(type, widest_m); });
  if (types.empty() || distribution.textures.empty())
    throw NothingToShow(
        fmt::format("scenario \"{}\", layout {}: expected a distribution with {} that can be shown, got {}",
                    scenario.id, layout.id, whom, canonical(to_json(distribution))));
  const std::string& type = any_of(types, random);
  return {type, any_of(distribution.textures, random)};
}

bool is_letter(const std::string& type) { return type.rfind("letter ", 0) == 0; }

// Types and textures (as indices of the space's) that belong to none of the sets.
std::vector<std::pair<std::size_t, std::size_t>> outside(const FeatureSpace& space,
                                                         const std::vector<const FeatureSet*>& sets,
                                                         const std::vector<bool>& type_allowed) {
  std::vector<std::vector<bool>> in_textures;  // of each set
  for (const FeatureSet* set : sets) {
    in_textures.emplace_back();
    for (const std::string& texture : space.textures) in_textures.back().push_back(contains(set->textures, texture));
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t type = 0; type < space.object_types.size(); ++type) {
    if (!type_allowed[type]) continue;
    std::vector<bool> taken(space.textures.size());
    for (std::size_t s = 0; s < sets.size(); ++s)
      if (contains(sets[s]->object_types, space.object_types[type]))
        for (std::size_t t = 0; t < taken.size(); ++t) taken[t] = taken[t] || in_textures[s][t];
    for (std::size_t t = 0; t < taken.size(); ++t)
      if (!taken[t]) pairs.emplace_back(type, t);
  }
  return pairs;
}

// What a scene holds, and what is meant by the command that it is for.
struct Request {
  const Scenario& scenario;
  const Task& task;
  const Layout& layout;
  const Content& content;
  bool training;
  Selection meant;                // distractors stay out of it
  std::vector<Features> members;  // of what is meant, those that targets are of; none: all

  double widest_m() const { return std::min(layout.widest_m, content.widest_m()); }
};

// What further commands mean and this one does not: of each set one, in random order, over and over.
std::vector<Features> sample_decoys(const Request& request, const std::vector<const FeatureSet*>& excluded,
                                    const std::vector<bool>& allowed, int count, RandomStream& random) {
  constexpr int tries = 50, rounds = 8;
  const FeatureSpace& space = request.scenario.space;
  const std::vector<FeatureSet>& sets = request.content.decoys;
  std::vector<Features> decoys;
  for (int round = 0; round < rounds; ++round)
    for (const int i : random.permutation(static_cast<int>(sets.size()))) {
      const FeatureSet& set = sets[static_cast<std::size_t>(i)];
      std::vector<std::string> types;
      for (std::size_t type = 0; type < allowed.size(); ++type)
        if (allowed[type] && std::count(set.object_types.begin(), set.object_types.end(), space.object_types[type]) > 0)
          types.push_back(space.object_types[type]);
      for (int n = 0; n < tries && !types.empty() && !set.textures.empty(); ++n) {
        if (static_cast<int>(decoys.size()) == count) return decoys;
        const std::string& type = any_of(types, random);
        const Features one{type, any_of(set.textures, random)};
        if (std::any_of(excluded.begin(), excluded.end(),
                        [&one](const FeatureSet* all) { return all->contains(one.type, one.texture); }))
          continue;
        decoys.push_back(one);
        break;
      }
    }
  if (static_cast<int>(decoys.size()) < count)
    throw NothingToShow(fmt::format("decoys: expected sets that hold what the command of scenario \"{}\" leaves out",
                                    request.scenario.id));
  return decoys;
}

bool holds(const std::vector<FeatureSet>& sets, const Features& one) {
  return std::any_of(sets.begin(), sets.end(),
                     [&one](const FeatureSet& set) { return set.contains(one.type, one.texture); });
}

// What unseen commands mean and no demonstrated one does: as the target is, but for the command. Each of a type of its
// own: of two of one type and a third alone, an order of types would find the third too often.
std::vector<Features> sample_unheard_decoys(const Request& request, const Features& target,
                                            const std::vector<bool>& allowed, int count, RandomStream& random) {
  constexpr int tries = 200;
  const FeatureSpace& space = request.scenario.space;
  const FeatureSet& meant = request.meant.target.product();
  std::vector<Features> decoys;
  for (const int type : random.permutation(static_cast<int>(allowed.size()))) {
    const std::string& name = space.object_types[static_cast<std::size_t>(type)];
    if (static_cast<int>(decoys.size()) == count) break;
    if (!allowed[static_cast<std::size_t>(type)] || name == target.type) continue;
    for (int n = 0; n < tries; ++n) {
      const Features one{name, any_of(meant.textures, random)};
      const auto is_meant = [&one](const ScenarioCommand& command) {
        return !command.seen && command.truth.target.product().contains(one.type, one.texture);
      };
      const std::vector<ScenarioCommand>& all = request.scenario.commands;
      if (std::none_of(all.begin(), all.end(), is_meant) || meant.contains(one.type, one.texture) ||
          holds(request.content.decoys, one))
        continue;
      decoys.push_back(one);
      break;
    }
  }
  if (static_cast<int>(decoys.size()) < count)
    throw NothingToShow(
        fmt::format("unheard_decoys: expected {} further types of what unseen commands of scenario "
                    "\"{}\" mean and no other, got {}",
                    count, request.scenario.id, decoys.size()));
  return decoys;
}

// Each object is drawn alike, the target too: who takes the largest, or what is as large as what was shown, finds the
// target by chance.
void match_sizes(std::vector<SceneObject>& objects, RandomStream& random) {
  for (SceneObject& object : objects) {
    const std::vector<double> scales = matched_scales(object.object_type);
    object.scale = scales[random.below(static_cast<std::uint32_t>(scales.size()))];
  }
}

// What distractors stay out of.
std::vector<const FeatureSet*> excluded_sets(const Request& request) {
  std::vector<const FeatureSet*> excluded;
  const auto exclude = [&excluded](const Selection& meant) {
    for (const FeatureSet& set : meant.target.sets) excluded.push_back(&set);
    if (meant.second) excluded.push_back(&*meant.second);
  };
  const Content& content = request.content;
  exclude(request.meant);
  if (content.outside_all_commands)
    for (const ScenarioCommand& command : request.scenario.commands) exclude(command.truth);
  if (content.cue) excluded.push_back(&content.cue->look);
  if (!request.training && content.never_distractor) excluded.push_back(&*content.never_distractor);
  return excluded;
}

// The types that distractors may have. Where the earliest letter is asked for, a later one may stand beside it, never
// an earlier one or the same.
struct Types {
  std::vector<bool> allowed;               // of the space's
  std::vector<std::string> later_letters;  // none where no letter is asked for
};

Types types_beside(const Request& request, const Features& target) {
  const bool earliest = request.content.later_letters && is_letter(target.type);
  Types types;
  const bool matched = request.content.near_miss && request.content.near_miss->size_matched;
  for (const std::string& type : request.scenario.space.object_types) {
    const bool later = is_letter(type) && type > target.type;
    const bool shown = can_show(type, request.widest_m()) && (!matched || fits_matched(type, request.widest_m()));
    types.allowed.push_back(shown && (!earliest || !is_letter(type) || later));
    if (earliest && shown && later) types.later_letters.push_back(type);
  }
  return types;
}

// Types and textures, as indices of the space's, of which a distractor may be: hard ones share one with the target.
class Others {
 public:
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

  Others(const FeatureSpace& space, Pairs all, const Features& target, bool hard) : all_(std::move(all)), hard_(hard) {
    if (!hard) return;
    for (const auto& pair : all_) {
      if (space.object_types[pair.first] == target.type) same_type_.push_back(pair);
      if (space.textures[pair.second] == target.texture) same_texture_.push_back(pair);
    }
  }
  // Empty where there is none.
  const Pairs& any(RandomStream& random) const {
    if (!hard_) return all_;
    const bool by_type = random.coin();
    const Pairs &first = by_type ? same_type_ : same_texture_, &second = by_type ? same_texture_ : same_type_;
    return first.empty() ? second : first;
  }

 private:
  Pairs all_, same_type_, same_texture_;
  bool hard_;
};

// Near misses of the target, or what other commands mean, where the scenes ask for them; else none.
std::vector<Features> sample_misleading(const Request& request, const Features& target,
                                        const std::vector<const FeatureSet*>& excluded,
                                        const std::vector<bool>& allowed, int count, RandomStream& random) {
  const FeatureSpace& space = request.scenario.space;
  const Content& content = request.content;
  if (content.unheard_decoys) return sample_unheard_decoys(request, target, allowed, count, random);
  if (!content.decoys.empty()) return sample_decoys(request, excluded, allowed, count, random);
  if (!content.near_miss) return {};
  std::vector<std::string> types;
  for (std::size_t type = 0; type < allowed.size(); ++type)
    if (allowed[type]) types.push_back(space.object_types[type]);
  common::NearMiss sets = *content.near_miss;
  const auto cannot_match = [&types](const std::string& type) { return !contains(types, type); };
  if (sets.size_matched)  // where none of those called near can be as large as the target, others are
    sets.object_types.erase(std::remove_if(sets.object_types.begin(), sets.object_types.end(), cannot_match),
                            sets.object_types.end());
  NearMissRequest near{request.meant.target.product(), target, types, space.textures, sets, {}};
  near.may_be = [&excluded](const Features& one) {
    return std::none_of(excluded.begin(), excluded.end(),
                        [&one](const FeatureSet* set) { return set->contains(one.type, one.texture); });
  };
  return near_misses(near, count, random);
}

// docs/protocol.md, section 3: objects that don't satisfy the command.
std::vector<Features> sample_distractors(const Request& request, const Features& target, RandomStream& random) {
  const FeatureSpace& space = request.scenario.space;
  const Content& content = request.content;
  const std::vector<const FeatureSet*> excluded = excluded_sets(request);
  const auto [allowed, later_letters] = types_beside(request, target);
  const Others others(space, outside(space, excluded, allowed), target, content.hard);
  const auto [fewest, most] = content.distractors;
  const int count =
      fewest == most ? most : fewest + static_cast<int>(random.below(static_cast<std::uint32_t>(most - fewest + 1)));
  std::vector<Features> distractors = sample_misleading(request, target, excluded, allowed, count, random);
  for (int i = static_cast<int>(distractors.size()); i < count; ++i) {
    if (!later_letters.empty() && random.coin()) {
      const std::string& type = any_of(later_letters, random);
      distractors.push_back({type, content.hard ? target.texture : any_of(space.textures, random)});
      continue;
    }
    const Others::Pairs& from = others.any(random);
    if (from.empty()) continue;
    const auto [type, texture] = from[random.below(static_cast<std::uint32_t>(from.size()))];
    distractors.push_back({space.object_types[type], space.textures[texture]});
  }
  return distractors;
}

// docs/suites.md (q3): all types of the choice, in random order, but a target first.
std::vector<SceneObject> sample_choice(const Request& request, RandomStream random) {
  const auto second = request.task.second();
  if (second && !request.meant.second)
    throw NothingToShow(fmt::format("scenario \"{}\": expected a distribution with a second set", request.scenario.id));
  const FeatureSet& right = second ? *request.meant.second : request.meant.target.product();
  const Role if_right = second ? second->in_scenes : role::target;
  std::vector<SceneObject> objects;
  for (const int i : random.permutation(static_cast<int>(request.content.choice.size()))) {
    const std::string& type = request.content.choice[static_cast<std::size_t>(i)];
    if (!can_show(type, request.layout.widest_m))
      throw InputError(fmt::format("scenario \"{}\", layout {}: expected a choice that can be shown, got \"{}\"",
                                   request.scenario.id, request.layout.id, type));
    const std::string& texture = any_of(request.scenario.space.textures, random);
    objects.push_back({type, texture, right.contains(type, texture) ? if_right : role::distractor, {}, 0, 0});
  }
  if (std::none_of(objects.begin(), objects.end(), [&](const auto& o) { return o.role == if_right; }))
    throw NothingToShow(
        fmt::format("scenario \"{}\", layout {}: expected a distribution that has one of the choice, got {}",
                    request.scenario.id, request.layout.id, canonical(to_json(right))));
  std::stable_partition(objects.begin(), objects.end(), [](const auto& o) { return o.role == role::target; });
  return objects;
}

// Streams that go on where the same scene is drawn again.
struct Draws {
  RandomStream targets, distractors, sizes;
};

std::vector<SceneObject> sample_objects(const Request& request, const Streams& stream, Draws& draws) {
  const auto& [scenario, task, layout, content, training, meant, of_members] = request;
  const auto second = task.second();
  const bool by_choice = !content.choice.empty();
  if (by_choice && !second) return sample_choice(request, stream("choice"));

  const auto draw_target = [&request, &draws] {  // a lambda may not capture the names above (C++17)
    const std::vector<Features>& members = request.members;
    return members.empty()
               ? sample_features(
                     request.scenario, request.layout, request.content.target.value_or(request.meant.target.product()),
                     std::min(request.widest_m(), request.layout.widest_target_m), "a target", draws.targets)
               : members[draws.targets.below(static_cast<std::uint32_t>(members.size()))];
  };
  Features target = draw_target();
  for (int n = 0; content.unheard_decoys && holds(content.decoys, target); target = draw_target())
    if (++n == 200)
      throw NothingToShow(
          fmt::format("unheard_decoys: expected that each unseen command of scenario \"{}\" means "
                      "what no set of \"decoys\" holds",
                      scenario.id));
  const bool matched = content.near_miss && content.near_miss->size_matched;
  for (int n = 0; matched && !fits_matched(target.type, request.widest_m()); target = draw_target())
    if (++n == 200)
      throw NothingToShow(
          fmt::format("near_miss: expected a target of scenario \"{}\" whose size can be matched", scenario.id));
  std::vector<SceneObject> objects{{target.type, target.texture, role::target, {}, 0, 0}};
  if (by_choice) {
    const std::vector<SceneObject> chosen = sample_choice(request, stream("choice"));
    objects.insert(objects.end(), chosen.begin(), chosen.end());
    return objects;
  }
  for (const Features& d : sample_distractors(request, target, draws.distractors))
    objects.push_back({d.type, d.texture, role::distractor, {}, 0, 0});
  if (matched) match_sizes(objects, draws.sizes);
  if (second) {
    FeatureSet from;
    if (meant.second) from = *meant.second;
    RandomStream random = stream(second->in_scenes);
    const Features features =
        sample_features(scenario, layout, content.second.value_or(from), layout.widest_m, "the second set", random);
    objects.push_back({features.type, features.texture, second->in_scenes, {}, 0, 0});
  }
  return objects;
}

// Types and textures of the members that the scene shows; empty where every member may be shown.
std::vector<Features> members_to_show(const Scenario& scenario, const SceneRequest& request, const Content& content,
                                      int command) {
  const int shown = content_of(*scenario.train).members;
  const bool training = request.arm == "train";
  if (training ? shown == 0 : content.members_tested.empty()) return {};
  std::vector<Features> all =
      members_of(scenario, request.layout, command, training ? request.seed : request.training_seed.value_or(0));
  const auto first_new = all.begin() + std::min<std::ptrdiff_t>(shown, static_cast<std::ptrdiff_t>(all.size()));
  const std::vector<Features> seen(all.begin(), first_new);
  const std::string tested = training ? "seen" : content.members_tested;
  if (tested == "seen")
    all = seen;
  else
    all.erase(all.begin(), first_new);
  if (tested == "new_decisive" || tested == "new_other") {
    const FeatureSet& meant = scenario.commands[static_cast<std::size_t>(command)].truth.target.product();
    const auto is_other = [&](const Features& one) {
      return std::any_of(seen.begin(), seen.end(), [&](const Features& shown_one) {
        return shares_what_decides(meant, scenario.space, one, shown_one);
      });
    };
    const auto goes = [&](const Features& one) { return is_other(one) != (tested == "new_other"); };
    all.erase(std::remove_if(all.begin(), all.end(), goes), all.end());
    if (all.empty())
      throw NothingToShow(fmt::format("scenario \"{}\", layout {}: expected {} members beside the {} shown, got none",
                                      scenario.id, request.layout, tested, seen.size()));
  }
  if (all.empty() || seen.size() < static_cast<std::size_t>(shown))
    throw InputError(fmt::format("scenario \"{}\", layout {}: expected more members that can be shown than {}",
                                 scenario.id, request.layout, shown));
  return all;
}

// Where a crowd finds no room, the next draw of its objects.
std::vector<SceneObject> placed_objects(const Request& request, const Streams& stream) {
  constexpr int draws = 20;
  const auto& [scenario, task, layout, content, training, meant, of_members] = request;
  Draws random{stream("target"), stream("distractors"), stream("sizes")};
  for (int draw = 1;; ++draw) {
    std::vector<SceneObject> objects = sample_objects(request, stream, random);
    const std::size_t sampled = objects.size();
    try {
      place_with_cue(task, layout, content, objects, stream);
    } catch (const NoRoom&) {
      if (!content.crowded() || draw == draws) throw;
      continue;
    }
    const bool all = !content.choice.empty() || content.near_miss || content.crowded();
    if (all && objects.size() < sampled)
      throw InputError(fmt::format("scenario \"{}\", layout {}: expected places for all {} objects{}, got {}",
                                   scenario.id, layout.id, sampled, content.choice.empty() ? "" : " of a choice",
                                   objects.size()));
    return objects;
  }
}

}  // namespace

bool shares_what_decides(const FeatureSet& meant, const FeatureSpace& space, const Features& one,
                         const Features& other) {
  return (meant.object_types.size() < space.object_types.size() && one.type == other.type) ||
         (meant.textures.size() < space.textures.size() && one.texture == other.texture);
}

std::vector<Features> members_of(const Scenario& scenario, const std::string& layout_id, int command,
                                 std::uint64_t training_seed) {
  const Layout layout = find_layout(find_task(scenario.task), layout_id);
  double widest_m = std::min({layout.widest_m, layout.widest_target_m, content_of(*scenario.train).widest_m()});
  bool matched = false;
  for (const Arm& arm : scenario.tests) {
    const Content& content = content_of(*arm.scenes);
    widest_m = std::min(widest_m, content.widest_m());
    matched = matched || (content.near_miss && content.near_miss->size_matched);
  }
  const ScenarioCommand& meant = scenario.commands.at(static_cast<std::size_t>(command));
  std::vector<Features> all, drawn;
  for (const std::string& type : meant.truth.target.product().object_types)
    if (can_show(type, widest_m) && (!matched || fits_matched(type, widest_m)))
      for (const std::string& texture : meant.truth.target.product().textures) all.push_back({type, texture});
  RandomStream random(fmt::format("members/{}/{}/{}", meant.utterance, layout_id, training_seed));
  for (const int i : random.permutation(static_cast<int>(all.size())))
    drawn.push_back(all[static_cast<std::size_t>(i)]);
  return drawn;
}

Scene sample_scene(const Scenario& scenario, const SceneRequest& request, int index) {
  if (content_of(scenario, request.arm).errands) return errand_scene(scenario, request, index);
  Scene scene = without_objects(scenario, request, index);
  const auto command = static_cast<std::size_t>(scene.command);
  const bool training = request.arm == "train";
  const Content& content = content_of(scenario, request.arm);
  const bool asked = training && scenario.as_method_asks && !request.selections.empty();
  const Task& task = find_task(scenario.task);
  const Layout layout = find_layout(task, request.layout);
  const Request what{scenario,
                     task,
                     layout,
                     content,
                     training,
                     asked ? request.selections.at(command) : scenario.commands[command].truth,
                     members_to_show(scenario, request, content, scene.command)};
  const Streams stream = streams_of(scenario, request, index);

  set_asked_turn(scene, task.turn_rad(content));
  scene.objects = content.persons      ? rival_objects(scenario, task, layout, content, scene.command, training, stream)
                  : content.by_meaning ? meant_objects(scenario, task, layout, content, what.meant.target, stream)
                                       : placed_objects(what, stream);
  if (layout.pallet) scene.objects.push_back({goal_type, goal_texture, role::goal, *layout.pallet, 0, 0});
  permute_ids(scene.objects, stream("ids"));
  if (content.cue && content.cue->place == Cue::Place::gone) take_cue_away(*content.cue, scene.objects);
  return scene;
}

Scene with_distractors(const Scenario& scenario, const Scene& scene, int count, bool near_miss, RandomStream random) {
  constexpr int draws_of_any = 20;
  constexpr double narrow_m = .12;
  const Task& task = find_task(scenario.task);
  Layout layout = find_layout(task, scene.layout);
  layout.widest_m = std::min(layout.widest_m, Content::widest_in_crowd_m);
  Content content = content_of(scenario, scene.arm);
  content.distractors = {1, 1};
  content.hard = false;
  content.decoys.clear();
  content.unheard_decoys = false;
  content.near_miss.reset();
  if (near_miss) content.near_miss.emplace();
  const Request request{
      scenario, task, layout, content, false, scenario.commands[static_cast<std::size_t>(scene.command)].truth, {}};
  const Room room = [&](const SceneObject& target) { return task.room(layout, target); };
  const auto one = [&](const SceneObject& target) -> std::vector<Features> {
    try {
      return sample_distractors(request, {target.object_type, target.texture}, random);
    } catch (const NothingToShow&) {  // the command leaves out nothing that is near
      content.near_miss.reset();
      return {};
    }
  };
  const auto draw = [&](const std::vector<SceneObject>& objects, int n) -> std::optional<SceneObject> {
    if (n == draws_of_any) {
      layout.widest_m = narrow_m;
      content.near_miss.reset();
    }
    const std::vector<Features> drawn = one(objects.front());
    if (drawn.empty()) return std::nullopt;
    const auto& [type, texture] = drawn.front();
    const auto same = [&, t = type, x = texture](const SceneObject& o) { return o.object_type == t && o.texture == x; };
    if (content.near_miss && std::any_of(objects.begin(), objects.end(), same)) return std::nullopt;
    return SceneObject{type, texture, role::distractor, {}, 0, 0};
  };
  const auto place = [&](std::vector<SceneObject>& objects) { return place_last(room, objects, random); };
  return with_more(scene, count, random, {draw, place});
}

}  // namespace lgabench::tabletop
