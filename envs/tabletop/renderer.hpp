// The top view that every engine shares: colours and ids in one pass, on the processor (Embree), no display.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <lgabench/core/observation.hpp>

namespace lgabench::tabletop {

struct VisibleObject {
  std::string object_type, texture;
  Pose pose;                 // of the body's frame
  std::uint8_t instance_id;  // 1..255
};

/// One thread. The picture depends on the objects alone: same bytes for the same poses, whatever was drawn before.
class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Fills rgb, ids and the instance table (ordered as `objects`), one ray a pixel and a hard shadow.
  Observation render(const std::vector<VisibleObject>& objects);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench::tabletop
