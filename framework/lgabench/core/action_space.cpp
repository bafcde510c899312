#include <lgabench/core/action_space.hpp>

#include <lgabench/core/geometry.hpp>

namespace lgabench {

Json to_json(const ActionSpace& space) {
  Json numbers = Json::array();
  for (const ActionNumber& n : space.numbers)
    numbers.push_back({{"name", n.name}, {"unit", n.unit}, {"low", n.low}, {"high", n.high}});
  return numbers;
}

const ActionSpace& two_poses() {
  static const ActionSpace space = [] {
    ActionSpace s;
    for (const std::string pose : {"pose0", "pose1"}) {
      s.numbers.push_back({pose + ".x", "m", Workspace::x_min, Workspace::x_max});
      s.numbers.push_back({pose + ".y", "m", Workspace::y_min, Workspace::y_max});
      const std::size_t first = s.numbers.size();
      s.rotations.push_back({first, first + 1, first + 2, first + 3});
      for (const char* part : {".qx", ".qy", ".qz", ".qw"}) s.numbers.push_back({pose + part, "", -1, 1});
    }
    return s;
  }();
  return space;
}

}  // namespace lgabench
