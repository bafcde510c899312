#include <lgabench/learning/motion.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lgabench {
namespace {

constexpr double same_direction = .15;  // unit vectors that are one direction
constexpr double least_spread = 1e-3;   // m: less is none

// q and -q turn alike: the one on the sum's side is added. An angle's cosine and sine have no such twin.
void add_rotation(Action& sum, const Action& label, const std::vector<std::size_t>& rotation) {
  double dot = 0;
  for (const std::size_t i : rotation) dot += sum[i] * label[i];
  const double sign = rotation.size() == 4 && dot < 0 ? -1 : 1;
  for (const std::size_t i : rotation) sum[i] += sign * label[i];
}

}  // namespace

Vec2 place_of(const ActionSpace& actions, const Action& action, std::size_t place) {
  return {action[actions.places[place].down], action[actions.places[place].across]};
}

bool mostly_on_target(const std::vector<Demonstrated>& all, std::size_t place) {
  const auto on = std::count_if(all.begin(), all.end(), [&](const Demonstrated& d) { return d.on_target[place]; });
  return 2 * static_cast<std::size_t>(on) > all.size();
}

Groups one_group(const std::vector<Demonstrated>& all) {
  std::vector<std::size_t> everyone(all.size());
  std::iota(everyone.begin(), everyone.end(), 0);
  return {everyone};
}

Groups by_push(const ActionSpace& actions, const std::vector<Demonstrated>& all) {
  if (actions.places.size() < 2) return one_group(all);
  const auto push = [&](const Action& action) {
    const Vec2 way = place_of(actions, action, 1) - place_of(actions, action, 0);
    const double length = norm(way);
    return length > 0 ? 1 / length * way : Vec2{};
  };
  Groups groups;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return norm(push(all[group.front()].label) - push(all[i].label)) < same_direction;
    });
    if (same == groups.end())
      groups.push_back({i});
    else
      same->push_back(i);
  }
  return groups;
}

Action mean_action(const ActionSpace& actions, const std::vector<Action>& labels) {
  std::vector<Demonstrated> all;
  for (const Action& label : labels) all.push_back({label, {}, std::vector<bool>(actions.places.size())});
  return Motion(actions, all, one_group(all), false, false).act({}, 0);
}

Motion::Motion(const ActionSpace& actions, const std::vector<Demonstrated>& all, const Groups& groups, bool takes,
               bool second)
    : actions_(actions), takes_(takes), frames_(actions.size(), Frame::none) {
  const std::vector<double> as_it_is = spread(all, groups, all_in(Frame::none)),
                            about_taken = spread(all, groups, all_in(Frame::taken));
  second = second && std::all_of(all.begin(), all.end(), [](const auto& d) { return d.places.second_m.has_value(); });
  const std::vector<double> about_second = second ? spread(all, groups, all_in(Frame::second)) : about_taken;
  for (std::size_t place = 0; place < actions.places.size(); ++place)
    for (const std::size_t i : {actions.places[place].down, actions.places[place].across}) {
      const bool follows =
          about_taken[i] < as_it_is[i] || (about_taken[i] == as_it_is[i] && mostly_on_target(all, place));
      frames_[i] = follows ? Frame::taken : Frame::none;
      double least = follows ? about_taken[i] : as_it_is[i];
      if (second && about_second[i] < least) {
        frames_[i] = Frame::second;
        least = about_second[i];
      }
      if (place > 0) spread_m_ = std::max(spread_m_, least);
    }
  for (const auto& group : groups) means_.push_back(means(all, group, frames_));
}

Action Motion::act(const Places& places, std::size_t group) const {
  const Means& mean = means_[group];
  const Places offered{places.taken_m, places.second_m.value_or(mean.second_m)};
  Action action = mean.values;
  for (std::size_t i = 0; i < action.size(); ++i) action[i] += origin(i, frames_, offered);
  if (takes_) {
    action[actions_.places[0].down] = places.taken_m.x;
    action[actions_.places[0].across] = places.taken_m.y;
  }
  return executable(actions_, action);
}

void Motion::learned(Archive& archive) {
  archive(takes_);
  archive(frames_);
  std::uint64_t count = means_.size();
  archive(count);
  if (archive.reads()) means_.clear();
  for (std::uint64_t i = 0; i < count; ++i) {
    if (archive.reads()) means_.emplace_back();
    archive(means_[i].values);
    archive(means_[i].second_m);
    if (means_[i].values.size() != actions_.size()) Archive::fail();
  }
  if (frames_.size() != actions_.size() || means_.empty()) Archive::fail();
}

void name_motion(std::optional<Motion>& motion, std::optional<Action>& mean, const ActionSpace& actions,
                 Archive& archive) {
  bool there = motion.has_value();
  archive(there);
  if (there && archive.reads())
    motion.emplace(actions, archive);
  else if (there)
    motion->learned(archive);
  if (archive.reads()) mean.emplace();
  archive(*mean);
  if (mean->size() != actions.size()) Archive::fail();
}

Motion::Frames Motion::all_in(Frame frame) const {
  Frames frames(actions_.size(), Frame::none);
  for (const PicturePlace& place : actions_.places) frames[place.down] = frames[place.across] = frame;
  return frames;
}

double Motion::origin(std::size_t number, const Frames& frames, const Places& places) const {
  if (frames[number] == Frame::none) return 0;
  const Vec2 of_frame = frames[number] == Frame::taken ? places.taken_m : *places.second_m;
  const bool is_down = std::any_of(actions_.places.begin(), actions_.places.end(),
                                   [&](const PicturePlace& place) { return place.down == number; });
  return is_down ? of_frame.x : of_frame.y;
}

Motion::Means Motion::means(const std::vector<Demonstrated>& all, const std::vector<std::size_t>& group,
                            const Frames& frames) const {
  Means mean{Action(actions_.size())};
  const auto count = static_cast<double>(group.size());
  for (const std::size_t member : group) {
    const Demonstrated& d = all[member];
    Action sums = mean.values;
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += (d.label[i] - origin(i, frames, d.places)) / count;
    for (const auto& rotation : actions_.rotations) {
      for (const std::size_t i : rotation) sums[i] = mean.values[i];
      add_rotation(sums, d.label, rotation);
    }
    mean.values = sums;
    mean.second_m = mean.second_m + 1 / count * d.places.second_m.value_or(Vec2{});
  }
  return mean;
}

std::vector<double> Motion::spread(const std::vector<Demonstrated>& all, const Groups& groups,
                                   const Frames& frames) const {
  std::vector<double> squares(actions_.size());
  for (const auto& group : groups) {
    const Means mean = means(all, group, frames);
    for (const std::size_t member : group)
      for (std::size_t i = 0; i < squares.size(); ++i)
        squares[i] += std::pow(all[member].label[i] - origin(i, frames, all[member].places) - mean.values[i], 2);
  }
  for (double& value : squares) {
    value = std::sqrt(value / static_cast<double>(all.size()));
    if (value < least_spread) value = 0;
  }
  return squares;
}

}  // namespace lgabench
