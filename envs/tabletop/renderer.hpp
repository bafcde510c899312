// The top view that every engine shares: colours and ids, rasterised on the processor; rays (Embree) for shadows on
// objects. No display.
#pragma once
#include <memory>
#include <vector>

#include <common/objects.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/scene.hpp>
#include <lgabench/core/view.hpp>

namespace lgabench::tabletop {

using common::VisibleObject;

/// The scene's objects at rest on the table (z = 0, turned by yaw), before any action; in the scene's order.
std::vector<VisibleObject> visible_objects(const Scene& scene);

/// What is painted on the table: no instance, in the colours only.
enum class Ground { plain, goal_zones };

/// One thread at a time. The picture depends on objects, ground and view alone: same bytes for the same poses,
/// whatever was drawn before.
class Renderer {
 public:
  /// @throws EngineError if Embree can't be started.
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Fills rgb, ids and the instance table (ordered as `objects`), with hard shadows. A lit level
  /// surface shows its texture's colour as it is. What lies outside the picture or below the table is not seen.
  /// `shadows`: whether it has Observation::shadows.
  /// @throws InputError for an unknown object type or texture, an instance id that is 0 or given twice, or a pose that
  /// is not finite.
  Observation render(const std::vector<VisibleObject>& objects, Ground ground = Ground::plain, const View& view = {},
                     bool shadows = false);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench::tabletop
