// What is called millions of times takes no memory from the heap once it has been called; acting takes that of the
// action and its likes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <numeric>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/learning/network.hpp>
#include <tabletop/two_poses.hpp>

namespace {
long long allocations = 0;  // of this program and its libraries
}

// Not inlined: compilers take pairs of malloc() and delete for mistakes.
__attribute__((noinline)) void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
__attribute__((noinline)) void operator delete(void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace lgabench {
namespace {

TEST(Allocations, ATrainingStepMakesNone) {
  for (const Architecture architecture : {Architecture::text, Architecture::released, Architecture::plain}) {
    const NetworkShape shape{{1, 3}, true, architecture};
    Samples samples(shape.samples(), 20);
    for (std::size_t t = 0; t < samples.pictures.size(); ++t)
      for (std::size_t i = 0; i < samples.pictures[t].size(); ++i)
        samples.pictures[t][i] = i % 7 == 0 && i % 50 > 25 ? 1.f : t == 0 ? 0.f : .5f;
    Network network(shape, 1);
    std::vector<int> batch(10);
    const auto step = [&](int first) {
      std::iota(batch.begin(), batch.end(), first);
      network.backward(samples, batch);
      network.update(1e-3);
    };
    step(0);
    network.begin(samples);  // so that the first convolution is made both ways
    step(0);
    const long long before = allocations;
    for (int i = 0; i < 20; ++i) step(i % 11);
    EXPECT_EQ(allocations, before);
  }
}

struct MaskCloner : CloningMethod {
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }
};

struct Silent : TrainingLog {
  void epoch(int, long long, double) override {}
};

class Acting : public testing::TestWithParam<const char*> {};

TEST_P(Acting, OnTheGoalMaskTakesMemoryForActionsAlone) {
  Observation seen;
  seen.size = tabletop::Workspace::picture;
  seen.rgb.resize(3 * seen.size.pixels());
  seen.ids.resize(seen.size.pixels());
  std::fill_n(seen.ids.begin() + 3000, 40, std::uint8_t{3});
  seen.instances = {{3, "heart", "red", 40}};
  Instruction instruction{"Bring me the red heart.", {}};
  instruction.selection.target = {{"heart"}, {"red"}};

  const Scenario scenario = load_scenario("red_heart");
  RecordedLanguageModel lm(scenario, scenario.recorded);
  TruthAsHuman human(scenario.commands);
  Silent log;
  const Json options = {{"epochs", 1},           {"batch_size", 10},  {"learning_rate", 1e-3}, {"loss", "norm"},
                        {"batches", "shuffled"}, {"network", "text"}, {"policy", GetParam()}};
  Services services{lm, human, options, 0, log, tabletop::two_poses()};
  const auto policy = MaskCloner().learn({{instruction, {{seen, tabletop::TwoPoses{}}}}}, services);

  const Action first = policy->act(seen, instruction);
  const long long before = allocations;
  const Action again = policy->act(seen, instruction);
  EXPECT_LE(allocations - before, std::string(GetParam()) == "regression" ? 1 : 4);
  EXPECT_EQ(again, first);
}

INSTANTIATE_TEST_SUITE_P(Policies, Acting, testing::Values("regression", "centroid", "heat_map"));

}  // namespace
}  // namespace lgabench
