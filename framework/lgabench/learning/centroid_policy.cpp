#include <lgabench/learning/centroid_policy.hpp>

#include <algorithm>
#include <limits>
#include <optional>

#include <lgabench/core/error.hpp>
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
  Eye eye;
  std::optional<Action> mean;    // of all
  std::optional<Motion> motion;  // of those whose target is seen
  std::vector<Side> sides;       // of each group of those
  std::vector<float> outputs;

  std::optional<Places> look(const float* mask, const Vec2* pose0) {
    const std::optional<Vec2> taken = eye.taken(mask, pose0);
    if (!taken) return std::nullopt;
    return Places{*taken, avoided_in(mask)};
  }

  void fit(const Samples& samples) {
    std::vector<Action> labels;
    std::vector<Demonstrated> seen;
    for (int row = 0; row < samples.rows; ++row) {
      const float* const mask = samples.picture(0, row);
      const Action done = executable(samples.label(row));
      labels.push_back(done);
      const auto places = look(mask, &done.pose0.position_m);
      if (!places) continue;
      seen.push_back({done, *places, {on_target(mask, done.pose0.position_m), on_target(mask, done.pose1.position_m)}});
    }
    mean = mean_action(labels);
    if (seen.empty()) return;
    const bool takes = mostly_on_target(seen, 0);
    const Groups groups = takes ? one_group(seen) : by_push(seen);
    motion.emplace(seen, groups, takes, false);
    for (const auto& group : groups) {
      Side& side = sides.emplace_back(Side{group.size()});
      for (const std::size_t member : group) side.to_second = side.to_second + to_second(seen[member].places);
      side.to_second = 1. / static_cast<double>(group.size()) * side.to_second;
    }
  }

  Action act(const float* mask) {
    const auto places = look(mask, nullptr);
    return places && motion ? motion->act(*places, nearest(to_second(*places))) : *mean;
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

CentroidRule::CentroidRule(const SampleShape& shape) : impl_(std::make_unique<Impl>()) {
  if (shape.pictures.size() != 1 || !(shape.pictures[0].size == native_size) || shape.pictures[0].channels != 1)
    throw InputError("inputs: expected one mask of 128 x 256 for policy=centroid");
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
    const ActionVector action = to_vector(impl_->act(samples.picture(0, row)));
    impl_->outputs.insert(impl_->outputs.end(), action.begin(), action.end());
  }
  return impl_->outputs;
}

}  // namespace lgabench
