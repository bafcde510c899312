// The scenes of every shipped scenario: published results name them by their hashes, and a change here makes those
// results incomparable.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>

#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <tabletop/sampler.hpp>

namespace lgabench::tabletop {
namespace {

std::string hash_of(const Scenario& scenario, const SceneRequest& request) {
  constexpr int scenes = 40;
  std::string all;
  for (int i = 0; i < scenes; ++i) all += hex(sample_scene(scenario, request, i).hash());
  return sha256(all).substr(0, 16);
}

TEST(SceneHashes, AreThoseRecorded) {
  std::istringstream recorded(read_file(LGABENCH_SCENE_HASHES));
  int kinds = 0;
  for (std::string line; std::getline(recorded, line);) {
    if (line.rfind('#', 0) == 0) continue;
    std::istringstream words(line);
    std::string id, layout, split, arm, hash;
    words >> id >> layout >> split >> arm >> hash;
    const std::uint64_t seed = split == "train" ? 1 : 0;
    EXPECT_EQ(hash_of(load_scenario(id), {layout, split, arm, seed}), hash) << line;
    ++kinds;
  }
  EXPECT_GT(kinds, 200);
}

}  // namespace
}  // namespace lgabench::tabletop
