#include <lgabench/record/test_scenes.hpp>

#include <array>

#include <lgabench/record/fields.hpp>

namespace lgabench {
namespace {

constexpr std::array words{"shared", "per_seed"};  // of TestScenes

}  // namespace

void to_json(Json& json, TestScenes scenes) { json = words.at(static_cast<std::size_t>(scenes)); }

void visit(const Slot& slot, TestScenes& scenes, const Form&) {
  std::string word = words.at(static_cast<std::size_t>(scenes));
  visit(slot, word, one_of(words));
  scenes = word == words[0] ? TestScenes::shared : TestScenes::per_seed;
}

TestScenes read_test_scenes(const JsonReader& reader) { return value_of<TestScenes>(reader); }

std::uint64_t scene_set(TestScenes scenes, std::uint64_t training_seed) {
  return scenes == TestScenes::per_seed ? training_seed : 0;
}

std::vector<std::uint64_t> scene_sets(TestScenes scenes, const std::vector<std::uint64_t>& training_seeds) {
  return scenes == TestScenes::per_seed ? training_seeds : std::vector<std::uint64_t>{0};
}

}  // namespace lgabench
