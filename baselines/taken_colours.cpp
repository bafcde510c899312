// Neither language nor names: a mask of the segment whose colours are nearest to those of something that the command's
// demonstrations took. A rule to beat where names are read from pictures. Only the place to bring things to is told
// apart by its name.
#include <algorithm>
#include <array>
#include <map>

#include <lgabench/core/stations.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

// Shares of a segment's pixels in 4 x 4 x 4 bins of red, green and blue.
using Colours = std::array<double, 64>;

Colours colours_of(const Observation& seen, std::uint8_t id) {
  Colours shares{};
  double pixels = 0;
  for (std::size_t i = 0; i < seen.ids.size(); ++i) {
    if (seen.ids[i] != id) continue;
    const std::uint8_t* const rgb = &seen.rgb[3 * i];
    ++shares[static_cast<std::size_t>(rgb[0] / 64 * 16 + rgb[1] / 64 * 4 + rgb[2] / 64)];
    ++pixels;
  }
  for (double& share : shares) share /= std::max(pixels, 1.);
  return shares;
}

// What two have in common, 0 to 1.
double likeness(const Colours& a, const Colours& b) {
  double common = 0;
  for (std::size_t i = 0; i < a.size(); ++i) common += std::min(a[i], b[i]);
  return common;
}

// Names for a mask of one segment: its own, and another for all others.
struct Names {
  Instance chosen, other;

  explicit Names(const FeatureSpace& space) {
    chosen.object_type = space.object_types.at(0);
    chosen.texture = other.texture = space.textures.at(0);
    other.object_type = space.object_types.at(1);
  }
  void give(Observation& seen, Selection& selection, std::optional<std::uint8_t> id) const {
    for (Instance& one : seen.instances) {
      one.object_type = (one.id == id ? chosen : other).object_type;
      one.texture = chosen.texture;
    }
    selection.target = FeatureSet{{chosen.object_type}, {chosen.texture}};
  }
};

class ActsOnTheLikest : public Policy {
 public:
  ActsOnTheLikest(std::unique_ptr<Policy> policy, std::map<std::string, std::vector<Colours>> taken, Names names)
      : policy_(std::move(policy)), taken_(std::move(taken)), names_(std::move(names)) {}

  void reset() override { policy_->reset(); }
  Action act(const Observation& observation, const Instruction& instruction) override {
    std::optional<std::uint8_t> likest;
    double most = -1;
    for (const Instance& one : observation.instances) {
      if (one.pixels == 0 || is_place(one.object_type)) continue;
      const Colours colours = colours_of(observation, one.id);
      for (const Colours& taken : taken_[instruction.utterance])
        if (const double like = likeness(colours, taken); like > most) {
          most = like;
          likest = one.id;
        }
    }
    Observation seen = observation;
    Instruction told = instruction;
    names_.give(seen, told.selection, likest);
    return policy_->act(seen, told);
  }
  std::optional<bool> seen_in_training() const override { return policy_->seen_in_training(); }
  Shown shown() const override { return policy_->shown(); }

 private:
  std::unique_ptr<Policy> policy_;
  std::map<std::string, std::vector<Colours>> taken_;  // by utterance
  Names names_;
};

class OfColours : public CloningMethod {
 public:
  Needs needs(const Json&) const override { return {Needs::Targets::truth}; }
  Selection select(const Command&, const FeatureSpace& space, Services&) override {
    space_ = space;
    return {};
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    const Names names(space_);
    std::map<std::string, std::vector<Colours>> colours;
    std::vector<Demonstration> shown = demonstrations;
    for (Demonstration& one : shown) {
      std::optional<std::uint8_t> id;
      const auto give = [&](Step& step) { names.give(step.observation, one.instruction.selection, id); };
      for (Step& step : one.steps) {
        id = taken(step, services.actions);
        if (id) colours[one.instruction.utterance].push_back(colours_of(step.observation, *id));
        give(step);
      }
      id = taken(one, services.actions);
      for (Step& step : one.recovery) give(step);
    }
    return std::make_unique<ActsOnTheLikest>(CloningMethod::learn(shown, services), std::move(colours), names);
  }

 private:
  FeatureSpace space_;
};

}  // namespace

LGABENCH_METHOD("taken_colours", "0.1",
                "Behaviour cloning on a mask of the segment whose colours are likest what was taken, without names",
                OfColours, "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
