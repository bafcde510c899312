// What a scene can be described with: object types x textures.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// Object types and textures that a scene of this environment can show (paper, section 4.1 and the user study's
/// dictionary). The order is the files' order; it is also the order in which sets are written.
struct FeatureSpace {
  std::string id;
  std::vector<std::string> object_types, textures;
};

/// The space named `id` from the data directory's spaces/. @throws InputError where there is none.
FeatureSpace load_feature_space(const std::string& id);

/// A set of object types and a set of textures; an object belongs if both of its features do.
struct FeatureSet {
  std::vector<std::string> object_types, textures;  // in the order of the feature space

  /// Whether both features are in the set.
  bool contains(const std::string& object_type, const std::string& texture) const;
  /// Whether no object can belong to the set.
  bool empty() const { return object_types.empty() || textures.empty(); }
};
bool operator==(const FeatureSet& a, const FeatureSet& b);
/// Whether both features are in any one of the sets.
bool any_contains(const std::vector<FeatureSet>& sets, const std::string& object_type, const std::string& texture);

Json to_json(const FeatureSet& set);

/// Reads {"object_types": names, "textures": names}, puts both in the order of `space`. Names are a list, "ALL", or
/// {"except": [...]}: all others.
/// @throws InputError for a name that the space lacks or that is given twice.
FeatureSet read_feature_set(const JsonReader& reader, const FeatureSpace& space);

}  // namespace lgabench
