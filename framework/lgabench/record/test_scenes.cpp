#include <lgabench/record/test_scenes.hpp>

namespace lgabench {
namespace {

constexpr const char *of_all = "shared", *of_each = "per_seed";

}  // namespace

void to_json(Json& json, TestScenes scenes) { json = scenes == TestScenes::per_seed ? of_each : of_all; }

TestScenes read_test_scenes(const JsonReader& reader) {
  const std::string word = reader.string();
  if (word != of_all && word != of_each) reader.fail("shared or per_seed");
  return word == of_each ? TestScenes::per_seed : TestScenes::shared;
}

std::uint64_t scene_set(TestScenes scenes, std::uint64_t training_seed) {
  return scenes == TestScenes::per_seed ? training_seed : 0;
}

std::vector<std::uint64_t> scene_sets(TestScenes scenes, const std::vector<std::uint64_t>& training_seeds) {
  return scenes == TestScenes::per_seed ? training_seeds : std::vector<std::uint64_t>{0};
}

}  // namespace lgabench
