// Pictures in perspective: triangles filled with their depth, exact at pixels' centres in double precision; rays for
// shadows on objects. No display.
#pragma once
#include <memory>
#include <vector>

#include <common/objects.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/scene.hpp>
#include <mobile/camera.hpp>

namespace lgabench::mobile {

using common::VisibleObject;

/// The scene's objects at rest on the table, before any action; in the scene's order.
std::vector<VisibleObject> visible_objects(const Scene& scene);

/// What a pixel shows first along its ray.
struct Surface {
  enum class Kind { nothing, floor, table_top, furniture, object } kind = Kind::nothing;
  std::uint8_t instance_id = 0;  // of an object
  Vec3 point_m;
};

/// One thread at a time. The picture depends on camera, view and objects alone: same bytes for the same poses.
class Renderer {
 public:
  /// @throws EngineError if Embree can't be started.
  explicit Renderer(const Camera& camera);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws what follows in that view; before the first call in the usual one. @throws InputError for a texture of the
  /// table that is unknown.
  void look(const View& view);
  /// The view's.
  const Camera& camera() const;

  /// Fills rgb, ids and the instance table (ordered as `objects`), with hard shadows; table, person, tray and bin are
  /// drawn, and have no id. @throws InputError for an unknown object type or texture, an instance id that is 0 or given
  /// twice, or a pose that is not finite. `shadows`: whether it has Observation::shadows.
  Observation render(const std::vector<VisibleObject>& objects, bool shadows = false);

  /// Ids alone, of the same bytes. @throws InputError likewise.
  std::vector<std::uint8_t> ids(const std::vector<VisibleObject>& objects);

  /// What a pixel of the last picture shows.
  Surface surface(int row, int column) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench::mobile
