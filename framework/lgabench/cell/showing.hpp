// What a policy read of the first scenes of each arm, kept for a report's page.
#pragma once
#include <string>
#include <vector>

#include <lgabench/cell/evaluator.hpp>
#include <lgabench/record/shown.hpp>

namespace lgabench {

/// Scenes of each arm whose pictures are kept: enough to look at, at some 10 kB each.
constexpr int most_shown_scenes = 5;

/// Asks the policy, which outlives it, after its episodes.
class Showing {
 public:
  Showing(const Policy& policy, std::string plugin_id) : policy_(policy), id_(std::move(plugin_id)) {}
  /// Call when the policy's last act() was in that scene. A MethodError leaves the pictures out, with a line in the
  /// log.
  void played(const TestScene& test);
  const std::vector<ShownScene>& scenes() const { return scenes_; }

 private:
  const Policy& policy_;
  std::string id_;
  std::vector<ShownScene> scenes_;
};

}  // namespace lgabench
