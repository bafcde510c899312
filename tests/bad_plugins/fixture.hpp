// A method that selects nothing and learns nothing: the plugins for tests differ in their policy alone.
#pragma once
#include <memory>
#include <vector>

#include <lgabench/plugin/plugin.hpp>

namespace fixture {

using namespace lgabench;

template <class P>
class FixtureMethod : public Method {
 public:
  Needs needs(const Json&) const override {
    Needs needs;
    needs.targets = Needs::Targets::truth;
    return needs;
  }
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    services.log.epoch(1, static_cast<long long>(demonstrations.size()), 0.0);
    return std::make_unique<P>();
  }
};

// From one place on the table to another, without a turn (docs/protocol.md, section 2).
inline Action from_to(double x0, double y0, double x1, double y1) { return {x0, y0, 0, 0, 0, 1, x1, y1, 0, 0, 0, 1}; }

// Takes up what lies at the workspace's centre and puts it down there.
class StayPolicy : public Policy {
 public:
  Action act(const Observation&, const Instruction&) override { return from_to(.5, 0, .5, 0); }
};

}  // namespace fixture
