// What the reference rows do in a scene, which no plugin is asked for.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <lgabench/cell/evaluator.hpp>

namespace lgabench {

/// The scenes that were demonstrated, and what their targets are brought to.
struct DemonstratedScenes {
  std::vector<Scene> scenes{};
  Role second{};          // of the second set's object in them; "" where there is none
  ActionSpace actions{};  // of the scenario
};

/// The method that the row is, "constant_action"; null of a row that acts by a rule. @throws InputError for another id.
std::unique_ptr<Method> reference_method(const std::string& id);

/// The rule of the row: "oracle", or the oracle's rule for one visible object, the goal excepted: "random_object", any;
/// "most_shared", one of those that share types and textures with most others; "never_demonstrated", one whose type and
/// texture together were no target's in `shown`, any where there is none; "most_demonstrated", the highest score (times
/// its type was taken + 1/2) x (times its texture was + 1/2) in the command's demonstrations, in all where it has none;
/// "most_alike_names", likewise by alike_in_name(); "least_demonstrated", the lowest score in all. Where actions have
/// stations, the last three lead to the object that scores so among those of the second set. Drawn from a stream of row
/// and scene. "stops_at_once", "two_then_stops" and "stops_at_random" take any object at each step until they say that
/// nothing is left to do, which is an action where the scenario has may_stop. None of a row that is a method.
/// @throws InputError for another id.
Actor reference_actor(const std::string& id, const DemonstratedScenes& shown = {});

}  // namespace lgabench
