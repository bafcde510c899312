// Scenes whose objects all share types and textures with as many others, so that no rule that does not hear the command
// tells the target by what it shares.
#pragma once
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <lgabench/core/random.hpp>
#include <tabletop/near_misses.hpp>

namespace lgabench::tabletop {

/// With how many others the object shares its type, and with how many its texture, together.
int shared(const Features& object, const std::vector<Features>& all);

/// From `count.first` to `count.second` further objects beside `there`, whose first is the target, with which all share
/// alike; of such, some with which the target shares its type and its texture, if there are any. They have types and
/// textures of `there` or of `fresh`, and `may_be` holds for each. Nothing where no such objects are found.
std::optional<std::vector<Features>> sharing_alike(const std::vector<Features>& there,
                                                   const std::vector<Features>& fresh, std::pair<int, int> count,
                                                   const std::function<bool(const Features&)>& may_be,
                                                   RandomStream& random);

}  // namespace lgabench::tabletop
