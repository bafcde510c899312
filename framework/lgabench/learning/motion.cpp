#include <lgabench/learning/motion.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lgabench {
namespace {

constexpr double alike = .15;          // unit vectors that are one direction
constexpr double least_spread = 1e-3;  // m: less is none

Vec2 push(const Action& action) {
  const Vec2 way = action.pose1.position_m - action.pose0.position_m;
  const double length = norm(way);
  return length > 0 ? 1 / length * way : Vec2{};
}

// q and -q turn alike: the one on the sum's side is added.
void add(Quat& sum, const Quat& q) {
  const double sign = sum.x * q.x + sum.y * q.y + sum.z * q.z + sum.w * q.w < 0 ? -1 : 1;
  sum = {sum.x + sign * q.x, sum.y + sign * q.y, sum.z + sign * q.z, sum.w + sign * q.w};
}

}  // namespace

bool mostly_on_target(const std::vector<Demonstrated>& all, std::size_t pose) {
  const auto on = std::count_if(all.begin(), all.end(), [&](const Demonstrated& d) { return d.on_target[pose]; });
  return 2 * static_cast<std::size_t>(on) > all.size();
}

Groups one_group(const std::vector<Demonstrated>& all) {
  std::vector<std::size_t> everyone(all.size());
  std::iota(everyone.begin(), everyone.end(), 0);
  return {everyone};
}

Groups by_push(const std::vector<Demonstrated>& all) {
  Groups groups;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return norm(push(all[group.front()].label) - push(all[i].label)) < alike;
    });
    if (same == groups.end())
      groups.push_back({i});
    else
      same->push_back(i);
  }
  return groups;
}

Action mean_action(const std::vector<Action>& labels) {
  std::vector<Demonstrated> all;
  for (const Action& label : labels) all.push_back({label, {}, {false, false}});
  return Motion(all, one_group(all), false, false).act({}, 0);
}

Motion::Motion(const std::vector<Demonstrated>& all, const Groups& groups, bool takes, bool second) : takes_(takes) {
  const Positions on_table = spread(all, groups, all_in(Frame::table)),
                  about_taken = spread(all, groups, all_in(Frame::taken));
  second = second && std::all_of(all.begin(), all.end(), [](const auto& d) { return d.places.second_m.has_value(); });
  const Positions about_second = second ? spread(all, groups, all_in(Frame::second)) : Positions{};
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const bool follows =
        about_taken[i] < on_table[i] || (about_taken[i] == on_table[i] && mostly_on_target(all, i / 2));
    frames_[i] = follows ? Frame::taken : Frame::table;
    double least = follows ? about_taken[i] : on_table[i];
    if (second && about_second[i] < least) {
      frames_[i] = Frame::second;
      least = about_second[i];
    }
    if (i >= 2) spread_m_ = std::max(spread_m_, least);
  }
  for (const auto& group : groups) means_.push_back(means(all, group, frames_));
}

Action Motion::act(const Places& places, std::size_t group) const {
  const Means& mean = means_[group];
  const Positions origin = origins(frames_, {places.taken_m, places.second_m.value_or(mean.second_m)});
  Positions p = mean.positions;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] += origin[i];
  if (takes_) p[0] = places.taken_m.x, p[1] = places.taken_m.y;
  return executable({{{p[0], p[1]}, mean.rotations[0]}, {{p[2], p[3]}, mean.rotations[1]}});
}

Motion::Positions Motion::origins(const Frames& frames, const Places& places) {
  Positions origin{};
  for (std::size_t i = 0; i < origin.size(); ++i) {
    if (frames[i] == Frame::table) continue;
    const Vec2 of_frame = frames[i] == Frame::taken ? places.taken_m : *places.second_m;
    origin[i] = i % 2 == 0 ? of_frame.x : of_frame.y;
  }
  return origin;
}

Motion::Positions Motion::positions(const Demonstrated& one, const Frames& frames) {
  const Vec2 p = one.label.pose0.position_m, q = one.label.pose1.position_m;
  const Positions origin = origins(frames, one.places);
  return {p.x - origin[0], p.y - origin[1], q.x - origin[2], q.y - origin[3]};
}

Motion::Means Motion::means(const std::vector<Demonstrated>& all, const std::vector<std::size_t>& group,
                            const Frames& frames) {
  Means mean;
  const auto count = static_cast<double>(group.size());
  for (const std::size_t member : group) {
    const Demonstrated& d = all[member];
    const Positions values = positions(d, frames);
    for (std::size_t i = 0; i < values.size(); ++i) mean.positions[i] += values[i] / count;
    add(mean.rotations[0], d.label.pose0.rotation);
    add(mean.rotations[1], d.label.pose1.rotation);
    mean.second_m = mean.second_m + 1 / count * d.places.second_m.value_or(Vec2{});
  }
  return mean;
}

Motion::Positions Motion::spread(const std::vector<Demonstrated>& all, const Groups& groups, const Frames& frames) {
  Positions squares{};
  for (const auto& group : groups) {
    const Means mean = means(all, group, frames);
    for (const std::size_t member : group) {
      const Positions values = positions(all[member], frames);
      for (std::size_t i = 0; i < values.size(); ++i) squares[i] += std::pow(values[i] - mean.positions[i], 2);
    }
  }
  for (double& value : squares) {
    value = std::sqrt(value / static_cast<double>(all.size()));
    if (value < least_spread) value = 0;
  }
  return squares;
}

}  // namespace lgabench
