// Demonstrations that are perceived through a perturbation axis.
#pragma once
#include <optional>
#include <string>

#include <lgabench/core/json.hpp>

namespace lgabench {

struct TrainOn {
  std::string axis;
  std::optional<int> level;  // none: one drawn for each demonstration

  bool operator==(const TrainOn& other) const { return axis == other.axis && level == other.level; }
};

/// {"AXIS": LEVEL}, or {"AXIS": "any"}.
Json to_json(const TrainOn& through);
/// The axis need not be installed. @throws InputError with file and place.
TrainOn read_train_on(const JsonReader& reader);

}  // namespace lgabench
