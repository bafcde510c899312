// How well a Selection matches the true distribution.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/selection.hpp>

namespace lgabench {

/// Quality of the selected names of one kind. A precision or recall over an empty set is absent.
struct NameQuality {
  std::optional<double> precision, recall;
  double size = 0, true_size = 0;  // numbers of names; whole but in a mean
};

/// Names are those that any of a meaning's sets holds. `pairs` of object type and texture tell crossed products from
/// their union; they are there where the Selection or the truth is more than one product.
struct SetQuality {
  NameQuality object_types, textures;
  std::optional<NameQuality> pairs = std::nullopt;
};

/// Quality by set: "target", and the second set's role id where there is one. Empty for a Selection of provenance none.
using Quality = std::map<std::string, SetQuality>;

Quality quality(const Selection& selection, const Selection& truth);

/// The mean of the values that are present; if all agree, the value itself, without rounding.
std::optional<double> mean_of(const std::vector<std::optional<double>>& all);

/// Means for each set of the first Quality. A precision or recall is the mean over those that have it.
Quality mean_quality(const std::vector<Quality>& all);

/// A count, or a mean of counts: without a fraction where it is whole.
Json count_json(double count);
/// {"target": {"object_types": {"precision", "recall", "size", "true_size"}, "textures": ...}, ...}; null if empty.
Json to_json(const Quality& quality);
Json to_json(const SetQuality& quality);

/// What to_json() wrote, or null for none; a null set is left out. @throws InputError for anything else.
Quality read_quality(const JsonReader& reader);

}  // namespace lgabench
