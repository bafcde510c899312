#include <lgabench/learning/centroid_policy.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <lgabench/core/error.hpp>
#include <lgabench/core/stations.hpp>
#include <lgabench/learning/motion.hpp>
#include <lgabench/learning/places.hpp>

namespace lgabench {
namespace {

constexpr double alike = .15;  // unit vectors that are one direction

// A unit vector; 0 where nothing is to be avoided.
Vec2 to_second(const Places& places) {
  if (!places.second_m) return {};
  const Vec2 way = *places.second_m - places.taken_m;
  const double length = norm(way);
  return length > 0 ? 1 / length * way : Vec2{};
}

// How demonstrations of one group see what is to be avoided.
struct Side {
  std::size_t members = 0;
  Vec2 to_second{};  // mean
};

}  // namespace

struct CentroidRule::Impl {
  const SampleShape shape;
  const Field field;
  Eye eye;
  std::optional<Action> mean;    // of all
  std::optional<Motion> motion;  // of those whose target is seen
  std::vector<Side> sides;       // of each group of those
  std::vector<float> outputs;

  explicit Impl(const SampleShape& of_a_row) : shape(of_a_row), field(of_a_row.actions) {}

  FieldMask mask_of(const Samples& samples, int row) const {
    return {samples.picture(0, row), shape.pictures[0].size, field};
  }

  std::optional<Places> look(const FieldMask& mask, const Vec2* begin) {
    const std::optional<Vec2> taken = eye.taken(mask, begin);
    if (!taken) return std::nullopt;
    return Places{*taken, mask.avoided()};
  }

  void fit(const Samples& samples) {
    std::vector<Action> labels;
    std::vector<Demonstrated> seen;
    for (int row = 0; row < samples.rows; ++row) {
      const FieldMask mask = mask_of(samples, row);
      const Action done = executable(shape.actions, samples.label(row));
      labels.push_back(done);
      const Vec2 begin = place_of(shape.actions, done, 0);
      const auto places = look(mask, &begin);
      if (!places) continue;
      Demonstrated& one = seen.emplace_back(Demonstrated{done, *places, {}});
      for (std::size_t i = 0; i < shape.actions.places.size(); ++i)
        one.on_target.push_back(mask.on_target(place_of(shape.actions, done, i)));
    }
    mean = mean_action(shape.actions, labels);
    if (seen.empty()) return;
    const bool takes = mostly_on_target(seen, 0);
    const Groups groups = takes ? one_group(seen) : by_push(shape.actions, seen);
    motion.emplace(shape.actions, seen, groups, takes, false);
    for (const auto& group : groups) {
      Side& side = sides.emplace_back(Side{group.size()});
      for (const std::size_t member : group) side.to_second = side.to_second + to_second(seen[member].places);
      side.to_second = 1. / static_cast<double>(group.size()) * side.to_second;
    }
  }

  Action act(const FieldMask& mask) {
    const auto places = look(mask, nullptr);
    Action action = places && motion ? motion->act(*places, nearest(to_second(*places))) : *mean;
    const Stations& stations = shape.actions.stations;
    if (stations.all.empty()) return action;
    const bool second = places && places->second_m;
    const std::size_t station = second ? nearest_station(stations, *places->second_m) : station_of(stations, action);
    return led_to(stations, station, std::move(action));
  }

  std::size_t nearest(Vec2 direction) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Side& side : sides) least = std::min(least, norm(side.to_second - direction));
    std::size_t chosen = sides.size();
    for (std::size_t i = 0; i < sides.size(); ++i)
      if (norm(sides[i].to_second - direction) <= least + alike &&
          (chosen == sides.size() || sides[i].members > sides[chosen].members))
        chosen = i;
    return chosen;
  }
};

CentroidRule::CentroidRule(const SampleShape& shape) {
  if (shape.pictures.size() != 1 || shape.pictures[0].channels != 1)
    throw InputError("inputs: expected one mask for policy=centroid");
  impl_ = std::make_unique<Impl>(shape);
}
CentroidRule::~CentroidRule() = default;

TrainingOptions CentroidRule::schedule(const TrainingOptions& asked, int) const {
  TrainingOptions none = asked;
  none.epochs = 0;
  return none;
}

void CentroidRule::begin(const Samples& samples) { impl_->fit(samples); }

const std::vector<float>& CentroidRule::predict(const Samples& samples) {
  impl_->outputs.clear();
  for (int row = 0; row < samples.rows; ++row) {
    const Action action = as_stored(impl_->shape.actions, impl_->act(impl_->mask_of(samples, row)));
    impl_->outputs.insert(impl_->outputs.end(), action.begin(), action.end());
  }
  return impl_->outputs;
}

bool CentroidRule::learned(Archive& archive) {
  name_motion(impl_->motion, impl_->mean, impl_->shape.actions, archive);
  archive(impl_->sides);
  if (impl_->motion && impl_->motion->groups() != impl_->sides.size()) Archive::fail();
  for (const Side& side : impl_->sides)
    if (!std::isfinite(norm(side.to_second))) Archive::fail();  // nearest() must find one
  return true;
}

}  // namespace lgabench
