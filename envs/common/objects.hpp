// The object types of all environments: procedural shapes, one convex decomposition for physics, one mesh for pictures.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <common/outline.hpp>
#include <lgabench/core/physics_world.hpp>

namespace lgabench::common {

/// Triangles for the renderer, counter-clockwise seen from outside; flat shading takes each triangle's own normal.
/// Every convex piece is closed in itself; pieces may overlap, so some faces lie inside the object.
struct Mesh {
  std::vector<Vec3> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Adds a convex piece between two horizontal polygons with parallel edges: bottom and top, then one side an edge.
void append(Mesh& mesh, const Polygon& bottom, const Polygon& top, double z_low, double z_high);

/// Body frame: origin at the type's centre in xy, z = 0 on its underside. In the picture, local -x is up, +y is right;
/// the long axis is along y at yaw 0.
struct ObjectModel {
  std::string type;
  BodyModel body;  // convex pieces and mass
  Mesh mesh;
  std::vector<Polygon> outline;  // convex polygons whose union covers the shape seen from above
  Vec2 size_m;                   // of the bounding box at yaw 0, which is centred
  double height_m = 0;
  double radius_m = 0;  // of the disc about the centre that covers the outline
  Vec2 grasp_m;         // where suction takes hold: on material, at least .01 from an edge where the type allows
};

/// The model of an object type, that many times its usual size; lives as long as the program. Its mass is that of its
/// volume, within the limits of all types. @throws InputError for an unknown type.
const ObjectModel& object_model(const std::string& type, double scale = 1);

/// object_model() of a thing that stands as it would in life: bottles, cans and boxes upright, all others as
/// object_model().
const ObjectModel& standing_model(const std::string& type, double scale = 1);

/// All object types that can be made, in the order of the household space, which begins with the tabletop's.
const std::vector<std::string>& object_types();

/// What a picture shows of an object.
struct VisibleObject {
  std::string object_type, texture;
  Pose pose;                 // of the body's frame
  std::uint8_t instance_id;  // 1..255
  double scale = 1;          // of its type's size
};

/// What every renderer asks of its objects. @throws InputError for an instance id that is 0 or given twice, or a pose
/// that is not finite.
void expect_drawable(const std::vector<VisibleObject>& objects);

/// The area of the table that a type's usual shape covers, seen from above.
double covered_area_m2(const std::string& type);

/// Outlines moved to a pose on the table.
std::vector<Polygon> placed_outline(const ObjectModel& model, Vec2 position_m, double yaw_rad);

}  // namespace lgabench::common
