// What a tabletop scenario says of its scenes.
#pragma once
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <common/scene_members.hpp>
#include <lgabench/core/scenario.hpp>

namespace lgabench::tabletop {

class Task;
struct Errands;
struct Persons;

/// An object of one type and texture that no command means. In training it lies beside the target, so that a policy may
/// learn to look for it in the target's place.
struct Cue {
  enum class Place { kept, moved, gone };  // beside the target, as in training; beside another object; not there
  FeatureSet look;                         // one type and one texture
  int count = 1;                           // so many of that look, all beside the same object
  Place place = Place::kept;
};

/// What scenes of one kind hold. Targets and the second set are drawn from the command's truth where nothing else is
/// said.
struct Content : SceneContent {
  std::optional<FeatureSet> target, second;
  std::pair<int, int> distractors{1, 2};  // fewest and most, all numbers with equal odds
  bool outside_all_commands = false;      // distractors stay out of what any command means, not the given one's alone
  bool hard = false;  // a distractor shares the target's type or its texture, and still is no target
  std::optional<common::NearMiss>
      near_miss;  // others share the target's type or texture, and each other's: near_misses(), or meant_objects()
  /// Training: of how many members of what a command means, pairs of type and texture, targets are; 0: of all. Tests:
  /// of these ("seen"), of the others ("new"), or of those of the others that share no value that decides with any of
  /// these ("new_decisive"), or do ("new_other"); "": of all. Which they are: see members_of(), shares_what_decides().
  int members = 0;
  std::string members_tested;
  bool later_letters = false;  // "the one that comes earliest": a distractor may be a later letter
  /// All of these types stand there, once each, in any texture; the command's truth says which are right (targets, or
  /// the second set where the task has one), the others are distractors.
  std::vector<std::string> choice;
  /// Others are of these sets, each of another one as far as they go: what further commands mean. Empty: of any.
  std::vector<FeatureSet> decoys;
  /// In an arm with unseen commands, targets and decoys are in none of `decoys`, and decoys are what other unseen
  /// commands mean, each of a type of its own, in textures that the given command may mean, so that neither tells.
  bool unheard_decoys = false;
  std::optional<Cue> cue;
  /// A scenario whose meaning is more than one product, or that says what a careless reading keeps: meant_objects().
  bool by_meaning = false;
  std::optional<Meaning> words;       // what the command's words alone hold, where that is more than what is meant
  std::vector<FeatureSet> undecided;  // readers differ on these: never drawn
  std::vector<FeatureSet> near_miss_sets;
  double misleading = 1;  // share of the scenes in which a near miss, or a second object that belongs, stands
  std::shared_ptr<const Persons> persons;              // commands are of persons: rival_objects()
  std::shared_ptr<const Errands> errands;              // a task with errands: errand_scene()
  std::optional<FeatureSet> never_distractor;          // test distractors stay out of it, beyond the true distribution
  std::map<std::string, std::vector<double>> numbers;  // of the task's own members, see Task::read()

  /// More stand there than always fit: wide types are left out, and what finds no room is drawn again.
  bool crowded() const { return others() > 2 || cue || persons; }
  /// How many stand beside the target at most.
  int others() const { return distractors.second + (by_meaning ? 3 : 0) + (cue ? cue->count : 0); }
  static constexpr double widest_in_crowd_m = .18;
  double widest_m() const { return crowded() ? widest_in_crowd_m : std::numeric_limits<double>::infinity(); }
};

/// What scenes hold that lgabench read for this environment: an arm's, or those to train on.
const Content& content_of(const SceneContent& scenes);
const Content& content_of(const Scenario& scenario, const std::string& arm);

/// Names of the members, as EnvironmentType asks for them.
std::vector<std::string> scenario_members(const Task& task);
std::vector<std::string> scene_members(const Task& task);

/// EnvironmentType::read_content().
Content read_content(const Scenario& scenario, const JsonReader& file, const JsonReader* scenes, bool training);

}  // namespace lgabench::tabletop
