// What words hold, pair by pair of object type and texture: nobody, somebody or everybody would count it in.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <lgabench/core/feature_space.hpp>

namespace lgabench::drawn {

/// Kleene's three values, in an order in which "and" is the least and "or" the greatest.
enum class Holds : std::uint8_t { no = 0, undecided = 1, yes = 2 };

/// A value for each pair of a space's object types and textures, type by type.
using Extent = std::vector<Holds>;

Extent of_types(const FeatureSpace& space, const std::vector<std::string>& yes,
                const std::vector<std::string>& undecided);
Extent of_textures(const FeatureSpace& space, const std::vector<std::string>& yes,
                   const std::vector<std::string>& undecided);
/// Either's values, where both are of one space.
Extent both(const Extent& a, const Extent& b);
Extent either(const Extent& a, const Extent& b);
Extent none_of(Extent a);
/// What has that value has yes, all else no.
Extent where(Extent extent, Holds value);
bool is_empty(const Extent& extent);  // no pair has yes

/// The pairs with that value as few products, types with the same textures together; equal pairs give equal sets. The
/// type of the place that things are brought to is left out.
std::vector<FeatureSet> sets_of(const FeatureSpace& space, const Extent& extent, Holds value);

}  // namespace lgabench::drawn
