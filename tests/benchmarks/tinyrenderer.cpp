// PyBullet's software renderer, in a Python of its own: the meshes of a scene and ids, without shadows and textures.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include <common/objects.hpp>
#include <common/textures.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/scratch.hpp>
#include <tabletop/renderer.hpp>
#include <tabletop/sampler.hpp>

#include "benchmarks.hpp"

namespace lgabench {
namespace {

// The first test scene of `heart`, as tinyrenderer.py reads it.
std::string scene() {
  nlohmann::json objects = nlohmann::json::array();
  const Scene first = tabletop::sample_scene(load_scenario("heart"), {"cells", "test", "test", 0}, 0);
  for (const tabletop::VisibleObject& object : tabletop::visible_objects(first)) {
    const common::Mesh& mesh = common::object_model(object.object_type).mesh;
    nlohmann::json vertices = nlohmann::json::array();
    for (const Vec3& v : mesh.vertices_m) vertices.push_back({v.x, v.y, v.z});
    const auto& [p, q] = object.pose;
    const auto [red, green, blue] = common::texture(object.texture).pixels[0];
    objects.push_back({{"position", {p.x, p.y, p.z}},
                       {"rotation", {q.x, q.y, q.z, q.w}},
                       {"colour", {red / 255., green / 255., blue / 255.}},
                       {"vertices", vertices},
                       {"triangles", mesh.triangles}});
  }
  return objects.dump();
}

void draw_in_pybullet(benchmark::State& state) {
  const Scratch scratch("tinyrenderer");
  const fs::path path = scratch.path / "scene.json";
  write_file(path, scene());
  const std::string command =
      fmt::format("python3 '{}' '{}' {}", LGABENCH_TINYRENDERER, path.string(), state.max_iterations);
  double seconds = 0;
  FILE* child = popen(command.c_str(), "r");
  const bool answered = child && std::fscanf(child, "%lf", &seconds) == 1;
  const int status = child ? pclose(child) : -1;
  if (!answered)
    return state.SkipWithError(status == -1 || WEXITSTATUS(status) < 77 ? "tinyrenderer.py failed"
                                                                        : "no PyBullet for python3 here");
  for (auto _ : state) state.SetIterationTime(seconds);  // processor time of the child, which no clock here sees
}

}  // namespace

void register_tinyrenderer() {
  benchmark::RegisterBenchmark("picture/tinyrenderer", draw_in_pybullet)->UseManualTime();
}

}  // namespace lgabench
