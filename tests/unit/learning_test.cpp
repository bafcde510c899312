// Inputs, loss, training and cloning methods.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/learning/cloning_options.hpp>
#include <lgabench/learning/network.hpp>
#include <lgabench/learning/sentence_embeddings.hpp>
#include <lgabench/learning/training.hpp>
#include <lgabench/plugin/loader.hpp>
#include <tabletop/two_poses.hpp>

#include "native_picture.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

using tabletop::TwoPoses;

// Length over which small pixel `small` of `count` lies on native pixel `pixel` of `native`, in native pixels.
double overlap(int small, int count, int pixel, int native) {
  const double scale = static_cast<double>(native) / count;
  return std::max(0.0, std::min(scale * (small + 1), pixel + 1.0) - std::max(scale * small, 1.0 * pixel));
}

TEST(Inputs, ASmallMaskPixelIsOneIfItTouchesAnyNativeOne) {
  RandomStream random("mask");
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::uint8_t> mask(rows * columns);
    std::vector<float> expected(input_pixels), small(input_pixels, -1);
    for (int k = 0; k < 40; ++k) {
      const int y = static_cast<int>(random.below(rows)), x = static_cast<int>(random.below(columns));
      mask[static_cast<std::size_t>(y * columns + x)] = 1;
      // In whole numbers: intervals [128 r, 128 (r+1)) and [36 y, 36 (y+1)) meet.
      for (int r = 0; r < input_rows; ++r)
        for (int c = 0; c < input_columns; ++c)
          if (128 * r < 36 * (y + 1) && 36 * y < 128 * (r + 1) && 256 * c < 72 * (x + 1) && 72 * x < 256 * (c + 1))
            expected[static_cast<std::size_t>(r * input_columns + c)] = 1;
    }
    shrink_mask(mask, native_size, input_size, small.data());
    ASSERT_EQ(small, expected) << "trial " << trial;
  }
}

TEST(Inputs, RgbIsTheAreaMeanOver255) {
  RandomStream random("rgb");
  std::vector<std::uint8_t> rgb(rows * columns * 3);
  for (auto& byte : rgb) byte = static_cast<std::uint8_t>(random.below(256));
  std::vector<float> small(3 * input_pixels);
  shrink_rgb(rgb, native_size, input_size, small.data());
  const double area = 128.0 / 36 * 256.0 / 72;
  for (int channel = 0; channel < 3; ++channel)
    for (const int r : {0, 1, 17, 35})
      for (const int c : {0, 8, 40, 71}) {
        double mean = 0;
        for (int y = 0; y < rows; ++y)
          for (int x = 0; x < columns; ++x)
            mean += overlap(r, input_rows, y, rows) * overlap(c, input_columns, x, columns) *
                    rgb[static_cast<std::size_t>((y * columns + x) * 3 + channel)] / area / 255;
        EXPECT_NEAR(small[static_cast<std::size_t>((r * input_columns + c) * 3 + channel)], mean, 1e-5)
            << channel << " " << r << " " << c;
      }
}

TEST(Inputs, RefusePicturesOfAnotherSize) {
  std::vector<float> out(3 * input_pixels);
  EXPECT_THROW(shrink_mask(std::vector<std::uint8_t>(rows * columns - 1), native_size, input_size, out.data()),
               InputError);
  EXPECT_THROW(shrink_rgb(std::vector<std::uint8_t>(rows * columns), native_size, input_size, out.data()), InputError);
}

TEST(Inputs, AreMadeByTheThreadThatAsks) {
  const auto threads = [] {
    return std::distance(fs::directory_iterator("/proc/self/task"), fs::directory_iterator());
  };
  const auto before = threads();
  const std::vector<std::uint8_t> rgb(rows * columns * 3, 100);
  std::vector<float> small(3 * input_pixels);
  for (int i = 0; i < 100; ++i) shrink_rgb(rgb, native_size, input_size, small.data());
  EXPECT_EQ(threads(), before) << "other cells have the other cores";
}

TEST(Losses, HaveTheGradientOfFiniteDifferences) {
  RandomStream random("loss");
  std::vector<float> output(12), label(12), gradient(12), unused(12);
  for (auto* values : {&output, &label})
    for (float& v : *values) v = static_cast<float>(random.gaussian());
  for (const Loss loss : {Loss::norm, Loss::squared}) {
    loss_and_gradient(loss, output.data(), label.data(), 12, .1, gradient.data());
    for (std::size_t i = 0; i < output.size(); ++i) {
      const float step = 0x1p-8f, here = output[i];
      output[i] = here + step;
      const double above = loss_and_gradient(loss, output.data(), label.data(), 12, 1, unused.data());
      output[i] = here - step;
      const double below = loss_and_gradient(loss, output.data(), label.data(), 12, 1, unused.data());
      output[i] = here;
      EXPECT_NEAR(gradient[i], .1 * (above - below) / (2 * step), 1e-5);
    }
  }
}

TEST(Losses, ArePlainNumbersAndTheNormsSubgradientAtZeroIsZero) {
  std::vector<float> output(12), label(12), gradient(12, NAN);
  EXPECT_EQ(loss_and_gradient(Loss::norm, output.data(), label.data(), 12, .5, gradient.data()), 0);
  for (const float number : gradient) EXPECT_EQ(number, 0);
  output[0] = 3;
  output[1] = 4;
  EXPECT_DOUBLE_EQ(loss_and_gradient(Loss::norm, output.data(), label.data(), 12, .5, gradient.data()), 5);
  EXPECT_FLOAT_EQ(gradient[0], .3f);  // 3/5, halved by the weight
  EXPECT_FLOAT_EQ(gradient[1], .4f);
  EXPECT_DOUBLE_EQ(loss_and_gradient(Loss::squared, output.data(), label.data(), 12, .5, gradient.data()), 25);
}

TEST(Network, StartsUniformWithinOneOverTheRootOfFanIn) {
  Network network({{1}, false, Architecture::plain}, 11);
  struct Range {
    int count, fan_in;
  };
  const std::vector<float> parameters = network.parameters();
  auto value = parameters.begin();
  for (const auto [count, fan_in] : {Range{2080, 64}, Range{32832, 512}, Range{18464, 576}, Range{1932, 160}}) {
    const double bound = 1 / std::sqrt(fan_in);
    double highest = 0, squares = 0;
    for (int i = 0; i < count; ++i, ++value) {
      highest = std::max(highest, std::abs(double{*value}));
      squares += double{*value} * *value;
    }
    EXPECT_LE(highest, bound);
    EXPECT_GT(highest, .99 * bound);
    EXPECT_NEAR(squares / count / (bound * bound / 3), 1, .1);  // a uniform's variance
  }
  EXPECT_EQ(value, parameters.end());
}

// The linear weights of `released`, which stand last: a matrix and its biases, as often as `outs` names one.
TEST(Network, ReleasedStartsWithOrthonormalLinearLayersWithoutBias) {
  struct Matrix {
    int outs, ins;
  };
  for (const auto& [shape, matrices] :
       {std::pair(NetworkShape{{1}, false, Architecture::released}, std::vector<Matrix>{{12, 160}}),
        std::pair(NetworkShape{{1, 3}, true, Architecture::released},
                  std::vector<Matrix>{{100, 160}, {100, 160}, {100, 584}, {12, 100}})}) {
    const std::vector<float> parameters = Network(shape, 11).parameters();
    EXPECT_EQ(parameters, Network(shape, 11).parameters());
    EXPECT_NE(parameters, Network(shape, 12).parameters());
    auto row = parameters.end();
    for (const auto [outs, ins] : matrices) row -= outs * (ins + 1);
    for (const auto [outs, ins] : matrices) {
      double sum = 0;
      for (int i = 0; i < outs; ++i)
        for (int j = 0; j <= i; ++j)
          EXPECT_NEAR(std::inner_product(row + i * ins, row + (i + 1) * ins, row + j * ins, 0.), i == j, 1e-6);
      for (auto weight = row; weight != row + outs * ins; ++weight) sum += *weight;
      EXPECT_LT(std::abs(sum), 4 * std::sqrt(outs))
          << "standard deviation of an orthonormal matrix's sum: root of outs";
      row += outs * ins;
      EXPECT_EQ(std::vector<float>(row, row + outs), std::vector<float>(static_cast<std::size_t>(outs)));
      row += outs;
    }
  }
}

// All samples the same: a variance of 0 in the last convolution, and in channels that are dead.
TEST(Network, StaysFiniteWhereABatchHasNoVariance) {
  for (const Architecture architecture : {Architecture::text, Architecture::released}) {
    const NetworkShape shape{{1}, false, architecture};
    Network network(shape, 1);
    std::vector<float> parameters = network.parameters();
    // All weights 0 leaves every convolution its bias, half of them below 0.
    for (std::size_t i = 0; i < 2048; ++i) parameters[i] = 0;
    network.set_parameters(parameters);
    Samples samples(shape.samples(), 10);
    for (float& label : samples.labels) label = .5f;
    for (int step = 0; step < 50; ++step) {
      ASSERT_TRUE(std::isfinite(network.backward(samples, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}))) << step;
      network.update(1e-3);
    }
    for (const float number : network.predict(samples)) EXPECT_TRUE(std::isfinite(number));
  }
}

// What training pictures share makes training faster, and is nothing to an action.
TEST(Network, ActsWithTheSameBitsWhateverTrainingPicturesShare) {
  const NetworkShape shape{{3}};
  Samples alike(shape.samples(), 4);
  for (std::size_t i = 0; i < alike.pictures[0].size(); ++i)
    alike.pictures[0][i] = i / 4 % 97 == 0 ? 1.f / static_cast<float>(1 + i % 13) : .3f;
  Network one(shape, 1), other(shape, 1);
  other.begin(alike);
  const std::vector<float> expected = one.predict(alike);
  EXPECT_EQ(other.predict(alike), expected);
}

TEST(Samples, UsualIsWhatMoreThanHalfOfThemHave) {
  Samples samples(NetworkShape{{1, 3}}.samples(), 7);
  RandomStream random("usual");
  for (std::size_t t = 0; t < 2; ++t) {
    std::vector<float> expected(samples.pictures[t].size() / 7);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      expected[i] = static_cast<float>(random.uniform());
      const std::vector<int> order = random.permutation(7);
      for (std::size_t row = 0; row < 7; ++row)
        samples.pictures[t][row * expected.size() + i] =
            order[row] < 4 ? expected[i] : static_cast<float>(random.uniform());
    }
    EXPECT_EQ(usual_picture(samples, t), expected);
  }
}

TEST(Samples, UsualIsThatOfTheUnalteredOnes) {
  Samples samples(NetworkShape{{1}}.samples(), 10);
  samples.unaltered = 3;
  const std::size_t numbers = samples.pictures[0].size() / 10;
  for (std::size_t i = 0; i < samples.pictures[0].size(); ++i) samples.pictures[0][i] = i < 3 * numbers ? .25f : .75f;
  EXPECT_EQ(usual_picture(samples, 0), std::vector<float>(numbers, .25f));
}

TEST(BatchOrder, IsAnotherPermutationInEveryPassAndForEverySeed) {
  std::set<std::vector<int>> orders;
  for (const std::uint64_t seed : {0u, 1u})
    for (int epoch = 1; epoch <= 5; ++epoch) {
      std::vector<int> order = batch_order(Batches::shuffled, seed, epoch, 50);
      EXPECT_EQ(order, batch_order(Batches::shuffled, seed, epoch, 50));
      orders.insert(order);
      std::sort(order.begin(), order.end());
      for (int i = 0; i < 50; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
    }
  EXPECT_EQ(orders.size(), 10u);
}

TEST(BatchOrder, DrawnIsUniformWithReplacement) {
  std::vector<int> counts(50);
  std::set<std::vector<int>> orders;
  int different = 0;
  for (int epoch = 1; epoch <= 200; ++epoch) {
    const std::vector<int> order = batch_order(Batches::drawn, 3, epoch, 50);
    ASSERT_EQ(order.size(), 50u);
    EXPECT_EQ(order, batch_order(Batches::drawn, 3, epoch, 50));
    EXPECT_NE(order, batch_order(Batches::drawn, 4, epoch, 50));
    orders.insert(order);
    for (const int sample : order) ++counts.at(static_cast<std::size_t>(sample));
    different += static_cast<int>(std::set<int>(order.begin(), order.end()).size());
  }
  EXPECT_EQ(orders.size(), 200u);
  EXPECT_NEAR(different / 200., 50 * (1 - std::pow(.98, 50)), 1);  // 31.8
  for (const int count : counts) EXPECT_NEAR(count, 200, 60);      // more than four standard deviations
}

struct Lines : TrainingLog {
  struct Line {
    int epochs;
    long long steps;
    double loss;
  };
  std::vector<Line> lines;
  void epoch(int epochs, long long steps, double loss) override { lines.push_back({epochs, steps, loss}); }
};

class Cloner : public CloningMethod {
 public:
  explicit Cloner(PolicyInputs seen) : seen_(std::move(seen)) {}
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }

 protected:
  PolicyInputs inputs(const Json&) const override { return seen_; }

 private:
  PolicyInputs seen_;
};

using Picture = PolicyInputs::Picture;
using Text = PolicyInputs::Text;
const char utterance[] = "Bring me the red heart.";

Instruction instruction() {
  Selection hearts;
  hearts.target = {{"heart"}, {"red"}};
  return {utterance, hearts};
}

// A red heart and a blue star, squares of 40 pixels at the given corners.
Observation scene(int heart_row, int heart_column, int star_row, int star_column) {
  Observation o;
  o.size = native_size;
  o.rgb.assign(rows * columns * 3, 80);
  o.ids.resize(rows * columns);
  o.instances = {{7, "star", "blue", 1600}, {3, "heart", "red", 1600}};
  const auto paint = [&o](std::uint8_t id, int row, int column, int channel) {
    for (int y = row; y < row + 40; ++y)
      for (int x = column; x < column + 40; ++x) {
        o.ids[static_cast<std::size_t>(y * columns + x)] = id;
        o.rgb[static_cast<std::size_t>((y * columns + x) * 3 + channel)] = 250;
      }
  };
  paint(7, star_row, star_column, 2);
  paint(3, heart_row, heart_column, 0);
  return o;
}

std::vector<Demonstration> demonstrations(int count, int steps_each = 1) {
  RandomStream random("demonstrations");
  std::vector<Demonstration> all;
  for (int i = 0; i < count; ++i) {
    Demonstration d{instruction(), {}};
    for (int k = 0; k < steps_each; ++k) {
      const int row = static_cast<int>(random.below(40)), column = static_cast<int>(random.below(216));
      const Vec2 centre{.25 + (row + 20) / 256.0, -.5 + (column + 20) / 256.0};
      d.steps.push_back(
          {scene(row, column, 80, static_cast<int>(random.below(216))), TwoPoses{{centre, {}}, {{.5, .3}, {}}}});
    }
    all.push_back(std::move(d));
  }
  return all;
}

struct Trained {
  std::unique_ptr<Policy> policy;
  std::vector<Lines::Line> log;
};

Trained learn(const PolicyInputs& seen, const std::vector<Demonstration>& data, int epochs, std::uint64_t seed = 0,
              const Json& changes = Json::object()) {
  Json options = {{"epochs", epochs}, {"batch_size", 10},      {"learning_rate", 1e-3},
                  {"loss", "norm"},   {"batches", "shuffled"}, {"network", "text"}};
  options.update(changes);
  const Scenario scenario = load_scenario("red_heart");
  RecordedLanguageModel lm(scenario, scenario.recorded);
  TruthAsHuman human(scenario.commands);
  Lines log;
  Services services{lm, human, options, seed, log, tabletop::two_poses()};
  auto policy = Cloner(seen).learn(data, services);
  return {std::move(policy), log.lines};
}

Action act(const Trained& trained, const Observation& observation) {
  return trained.policy->act(observation, instruction());
}

TEST(Options, ThatNameNothingKnownAreNeverTakenForADefault) {
  for (const auto& [option, known] : {std::pair{"network", "text, released, plain, spot"},
                                      {"loss", "norm, squared"},
                                      {"batches", "drawn, shuffled"},
                                      {"policy", "regression, centroid, heat_map, point"}}) {
    const auto with_another = [&, name = option] {
      learn({{Picture::mask}}, demonstrations(2), 1, 0, {{name, "resnet"}});
    };
    EXPECT_SAYS(message_of<InputError>(with_another),
                fmt::format("options: /{}: expected one of {}, got \"resnet\"", option, known));
  }
}

// Counts its calls; its one parameter is the sum of the learning rates.
struct Counting : Learner {
  struct Calls {
    int begun = 0, rows = 0;
    std::vector<std::size_t> batches;
    std::vector<double> rates;
  };
  Calls& calls;
  bool falls;
  std::vector<float> moved{0}, action = std::vector<float>(12, .25f);
  Counting(Calls& of, bool cosine) : calls(of), falls(cosine) {}

  TrainingOptions schedule(const TrainingOptions& asked, int samples) const override {
    TrainingOptions own = asked;
    own.cosine = falls;
    EXPECT_EQ(samples, calls.rows);
    return own;
  }
  void begin(const Samples& all) override { ++calls.begun, calls.rows = all.rows; }
  const std::vector<float>& predict(const Samples& samples) override {
    EXPECT_EQ(samples.rows, 1);
    return action;
  }
  double backward(const Samples&, const std::vector<int>& batch) override {
    EXPECT_EQ(calls.begun, 1);
    calls.batches.push_back(batch.size());
    return 1;
  }
  void update(double learning_rate) override { calls.rates.push_back(learning_rate), moved[0] += 1; }
  std::vector<float> parameters() const override { return moved; }
};

// A method with a learner of its own, and without the options of the paper's network.
struct WithCounting : CloningMethod {
  Counting::Calls& calls;
  bool cosine;
  WithCounting(Counting::Calls& of, bool falls) : calls(of), cosine(falls) {}
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }

 protected:
  std::unique_ptr<Learner> learner(const SampleShape& shape, const Services& services) const override {
    EXPECT_EQ(shape.pictures.size(), 1u);
    EXPECT_EQ(services.seed, 3u);
    return std::make_unique<Counting>(calls, cosine);
  }
};

TEST(Learners, OfAMethodsOwnAreShownTrainedLoggedAndPlayed) {
  const Json options = {{"epochs", 4}, {"batch_size", 10}, {"learning_rate", .5}, {"batches", "drawn"}};
  const Scenario scenario = load_scenario("red_heart");
  RecordedLanguageModel lm(scenario, scenario.recorded);
  TruthAsHuman human(scenario.commands);
  for (const int count : {3, 25})
    for (const bool cosine : {false, true}) {
      Counting::Calls calls;
      Lines log;
      Services services{lm, human, options, 3, log, tabletop::two_poses()};
      const auto policy = WithCounting(calls, cosine).learn(demonstrations(count), services);
      EXPECT_EQ(calls.rows, count);
      EXPECT_EQ(calls.batches, std::vector<std::size_t>(count == 3 ? 4 : 8, count == 3 ? 3 : 10));
      ASSERT_EQ(log.lines.size(), 1u);
      EXPECT_EQ(log.lines[0].loss, 1);
      for (std::size_t step = 0; step < calls.rates.size(); ++step) {
        const double part = static_cast<double>(step) / static_cast<double>(calls.rates.size());
        EXPECT_NEAR(calls.rates[step], cosine ? .25 * (1 + std::cos(pi * part)) : .5, 1e-12);
      }
      EXPECT_EQ(policy->act(scene(10, 100, 80, 30), instruction())[0], .25f);
      EXPECT_EQ(policy->seen_in_training(), false);
    }
}

TEST(Training, OverfitsTenDemonstrations) {
  const auto data = demonstrations(10);
  for (const PolicyInputs& seen : {PolicyInputs{{Picture::mask}}, PolicyInputs{{Picture::rgb}, Text::utterance}}) {
    const Trained trained = learn(seen, data, 400);
    EXPECT_GT(trained.log.front().loss, .1);
    EXPECT_LT(trained.log.back().loss, .05);
    for (const Demonstration& d : data) {
      const TwoPoses action = trained.policy->act(d.steps[0].observation, instruction());
      EXPECT_LT(norm(action.pose0.position_m - TwoPoses(d.steps[0].label).pose0.position_m), .1);
    }
  }
  EXPECT_TRUE(denormals_flushed());
}

TEST(Training, IsAFunctionOfTheSeed) {
  const auto data = demonstrations(12);
  const PolicyInputs seen{{Picture::mask, Picture::rgb}, Text::utterance};
  const Trained first = learn(seen, data, 20, 5), again = learn(seen, data, 20, 5), other = learn(seen, data, 20, 6);
  const Observation probe = scene(10, 100, 80, 30);
  EXPECT_EQ(act(first, probe), act(again, probe));
  EXPECT_NE(act(first, probe), act(other, probe));
  ASSERT_EQ(first.log.size(), again.log.size());
  for (std::size_t i = 0; i < first.log.size(); ++i) EXPECT_EQ(first.log[i].loss, again.log[i].loss);
}

TEST(Training, TakesWholeBatchesAndLogsEveryTenthPassAndTheLast) {
  const PolicyInputs seen{{Picture::mask}};
  const auto steps = [&](int count, int each, int epochs) {
    return learn(seen, demonstrations(count, each), epochs).log.back().steps;
  };
  EXPECT_EQ(steps(25, 1, 3), 6);  // two batches of ten a pass; five samples wait for another pass
  EXPECT_EQ(steps(3, 1, 4), 4);   // one batch of all
  EXPECT_EQ(steps(5, 6, 2), 6);   // every step of every demonstration is a sample
  std::vector<int> epochs;
  for (const auto& line : learn(seen, demonstrations(3), 23).log) epochs.push_back(line.epochs);
  EXPECT_EQ(epochs, (std::vector<int>{10, 20, 23}));
}

TEST(Training, TakesAsManyStepsWithCopiesUnlessItIsToldOtherwise) {
  const auto steps = [](int unaltered, int copies, bool equal) {
    Samples samples(SampleShape{}, unaltered * (1 + copies));
    samples.unaltered = unaltered;
    struct Counts : Learner {
      const std::vector<float>& predict(const Samples&) override { return none; }
      double backward(const Samples& all, const std::vector<int>& batch) override {
        for (const int row : batch) seen[row] = true, last = std::max(last, row), rows = all.rows;
        ++steps;
        return 1;
      }
      void update(double) override {}
      std::vector<float> parameters() const override { return {}; }
      std::vector<float> none;
      std::map<int, bool> seen;
      int steps = 0, last = 0, rows = 0;
    } learner;
    Lines log;
    TrainingOptions options;
    options.epochs = 200;
    options.equal_steps = equal;
    train(learner, samples, options, 0, log);
    EXPECT_EQ(learner.seen.size(), static_cast<std::size_t>(samples.rows)) << "every row is learned from";
    return learner.steps;
  };
  EXPECT_EQ(steps(25, 5, true), steps(25, 0, true));
  EXPECT_EQ(steps(3, 2, true), steps(3, 0, true));
  EXPECT_EQ(steps(20, 5, false), 6 * steps(20, 0, true));
}

// Three steps in two demonstrations, the second demonstration's twice.
TEST(Featurizer, CopiesFollowTheDemonstrationsStepByStep) {
  std::vector<Demonstration> data = demonstrations(2, 2);
  data[0].steps.pop_back();
  Featurizer featurizer({{Picture::rgb}}, tabletop::two_poses());
  std::vector<std::pair<int, int>> made;
  const Samples samples = featurizer.samples(data, 2, [&](Step& step, const Selection& selection, int row, int copy) {
    EXPECT_FALSE(selection.empty());
    made.emplace_back(row, copy);
    std::fill(step.observation.rgb.begin(), step.observation.rgb.end(), static_cast<std::uint8_t>(100 * copy + row));
    step.label[0] += 1;
  });
  EXPECT_EQ(made, (std::vector<std::pair<int, int>>{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}}));
  ASSERT_EQ(samples.rows, 9);
  EXPECT_EQ(samples.unaltered, 3);
  const Samples alone = featurizer.samples(data);
  EXPECT_TRUE(std::equal(alone.pictures[0].begin(), alone.pictures[0].end(), samples.pictures[0].begin()));
  EXPECT_NEAR(samples.picture(0, 8)[0], 102 / 255., 1e-6);
  for (int row = 0; row < 3; ++row)
    for (int copy = 1; copy <= 2; ++copy)
      EXPECT_NEAR(samples.label(row + 3 * copy)[0], samples.label(row)[0] + 1, 1e-5);
  EXPECT_EQ(data[0].steps[0].observation.rgb, demonstrations(2, 2)[0].steps[0].observation.rgb) << "given ones stay";
}

// Its loss falls by a hundredth of itself a pass, and from one pass on stays.
class Falling : public Learner {
 public:
  explicit Falling(int passes) : left_(passes) {}
  const std::vector<float>& predict(const Samples&) override { return actions_; }
  double backward(const Samples&, const std::vector<int>&) override { return loss_; }
  void update(double) override {
    if (left_-- > 0) loss_ *= .99;
  }
  std::vector<float> parameters() const override { return actions_; }

 private:
  int left_;
  double loss_ = 1;
  std::vector<float> actions_;
};

TEST(Training, EndsWhereItsLossNoLongerFalls) {
  struct Log : TrainingLog {
    void epoch(int epochs, long long, double) override { last = epochs; }
    int last = 0;
  };
  const Samples samples(SampleShape{}, 5);
  const auto epochs = [&samples](int falls, bool until_converged) {
    Falling learner(falls);
    Log log;
    TrainingOptions options;
    options.until_converged = until_converged;
    train(learner, samples, options, 0, log);
    return log.last;
  };
  EXPECT_EQ(epochs(200, false), 750);
  EXPECT_EQ(epochs(0, true), 100) << "no sooner than two windows";
  EXPECT_GT(epochs(200, true), 250);
  EXPECT_LT(epochs(200, true), 300);
  EXPECT_EQ(epochs(10000, true), 750) << "not longer either";
}

TEST(Training, OptionsChangeWhatIsLearned) {
  const auto data = demonstrations(10);
  const PolicyInputs seen{{Picture::mask}};
  const Observation probe = scene(10, 100, 80, 30);
  const Action usual = act(learn(seen, data, 5), probe);
  for (const Json& change :
       {Json{{"loss", "squared"}}, Json{{"network", "plain"}}, Json{{"network", "released"}},
        Json{{"batches", "drawn"}}, Json{{"learning_rate", 2e-3}}, Json{{"batch_size", 5}}, Json{{"epochs", 6}}})
    EXPECT_NE(act(learn(seen, data, 5, 0, change), probe), usual) << change;
}

TEST(Training, RefusesWhatItCannotLearnFrom) {
  const PolicyInputs mask{{Picture::mask}}, text{{Picture::rgb}, Text::utterance};
  EXPECT_THROW(learn(mask, {}, 1), MethodError);
  auto unknown = demonstrations(1);
  unknown[0].instruction.utterance = "\xff";  // no text, so no embedding
  EXPECT_THROW(learn(text, unknown, 1), InputError);
  EXPECT_THROW(learn(mask, demonstrations(1), 0), InputError);
  auto broken = demonstrations(2);
  broken[1].steps[0].label[0] = NAN;
  EXPECT_SAYS(message_of<MethodError>([&] { learn(mask, broken, 1); }), "training diverged: the loss of epoch 1 is ");
}

TEST(Policies, SeeWhatTheirInputsShowAndNothingElse) {
  const auto data = demonstrations(10);
  const Observation here = scene(10, 100, 80, 30), star_moved = scene(10, 100, 80, 150);
  Observation recoloured = here;
  for (auto& byte : recoloured.rgb) byte = static_cast<std::uint8_t>(255 - byte);

  const Trained mask = learn({{Picture::mask}}, data, 5);
  EXPECT_EQ(act(mask, star_moved), act(mask, here));  // zero by construction: the star is not in the mask
  EXPECT_EQ(act(mask, recoloured), act(mask, here));
  EXPECT_NE(act(mask, scene(30, 10, 80, 30)), act(mask, here));

  const Trained segmentation = learn({{Picture::segmentation}}, data, 5);
  EXPECT_NE(act(segmentation, star_moved), act(segmentation, here));
  EXPECT_EQ(act(segmentation, recoloured), act(segmentation, here));

  const Trained rgb = learn({{Picture::rgb}, Text::utterance}, data, 5);
  EXPECT_NE(act(rgb, recoloured), act(rgb, here));
  Instruction other = instruction();
  other.utterance = "Bring me the heart.";
  EXPECT_NE(rgb.policy->act(here, other), act(rgb, here));
}

TEST(Policies, MaskTheSelectionOfTheirInputsWhereThereIsOne) {
  const auto data = demonstrations(10);
  const Observation here = scene(10, 100, 80, 30), star_moved = scene(10, 100, 80, 150),
                    heart_moved = scene(30, 10, 80, 30);
  Selection stars;
  stars.target = {{"star"}, {"blue"}};
  const Trained trained = learn({{Picture::mask}, Text::none, {}, {{instruction().utterance, stars}}}, data, 5);
  EXPECT_NE(act(trained, star_moved), act(trained, here));
  EXPECT_EQ(act(trained, heart_moved), act(trained, here));
  Instruction other = instruction();
  other.utterance = "Bring me the moon.";
  EXPECT_THROW(trained.policy->act(here, other), MethodError) << "not silently the instruction's own";
}

TEST(Policies, TellWhetherTheirInputStoodInTraining) {
  const auto data = demonstrations(10);
  const Observation shown = data[3].steps[0].observation;
  Observation star_moved = shown, moved = shown;
  std::replace(star_moved.ids.begin(), star_moved.ids.end(), std::uint8_t{7}, std::uint8_t{0});
  std::rotate(moved.ids.begin(), moved.ids.begin() + 7, moved.ids.end());
  star_moved.rgb[0] ^= 1;
  for (const char* policy : {"regression", "centroid", "heat_map"}) {
    const Trained mask = learn({{Picture::mask}}, data, 1, 0, {{"policy", policy}});
    EXPECT_EQ(mask.policy->seen_in_training(), std::nullopt) << "of no action yet";
    act(mask, shown);
    EXPECT_EQ(mask.policy->seen_in_training(), true);
    act(mask, moved);
    EXPECT_EQ(mask.policy->seen_in_training(), false);
    act(mask, star_moved);
    EXPECT_EQ(mask.policy->seen_in_training(), true) << "the star is not in the mask";
  }
  const Trained both = learn({{Picture::mask, Picture::rgb}, Text::utterance}, data, 1);
  act(both, shown);
  EXPECT_EQ(both.policy->seen_in_training(), true);
  act(both, star_moved);
  EXPECT_EQ(both.policy->seen_in_training(), false) << "another picture";
  Instruction other = instruction();
  other.utterance = "Bring me the heart.";
  both.policy->act(shown, other);
  EXPECT_EQ(both.policy->seen_in_training(), false) << "another text";
}

// A second red heart, the first in reading order.
Observation with_another_heart(Observation o) {
  o.instances.push_back({9, "heart", "red", 400});
  for (int y = 0; y < 20; ++y) std::fill_n(o.ids.begin() + y * columns, 20, std::uint8_t{9});
  return o;
}

TEST(Policies, MayBeShownTheFirstInstanceAlone) {
  const auto data = demonstrations(10);
  const Observation one = scene(30, 100, 80, 30), two = with_another_heart(one);
  Observation first = two;
  std::replace(first.ids.begin(), first.ids.end(), std::uint8_t{3}, std::uint8_t{0});
  for (const char* policy : {"regression", "centroid"}) {
    const Trained all = learn({{Picture::mask}}, data, 5, 0, {{"policy", policy}});
    const Trained alone = learn({{Picture::mask}}, data, 5, 0, {{"policy", policy}, {"instances", "first"}});
    EXPECT_EQ(act(alone, two), act(alone, first)) << policy;
    EXPECT_NE(act(all, two), act(all, first)) << policy;
    EXPECT_EQ(act(alone, one), act(all, one)) << policy;
  }
}

TEST(Policies, OfCentroidsTakeTheMiddleOfTheMaskAndTrainNothing) {
  const auto data = demonstrations(10);
  const Trained centroid = learn({{Picture::mask, Picture::rgb}}, data, 5, 0, {{"policy", "centroid"}});
  EXPECT_TRUE(centroid.log.empty());
  const TwoPoses action = centroid.policy->act(scene(10, 100, 80, 30), instruction());
  EXPECT_NEAR(action.pose0.position_m.x, .25 + 30 / 256., 1e-6);
  EXPECT_NEAR(action.pose0.position_m.y, -.5 + 120 / 256., 1e-6);
  EXPECT_NEAR(action.pose1.position_m.y, .3, 1e-6);
  EXPECT_THROW(learn({{Picture::rgb}}, data, 5, 0, {{"policy", "centroid"}}), InputError);
}

TEST(Policies, OfCentroidsTellTheTargetFromWhatIsToBeAvoided) {
  auto data = demonstrations(10);
  Instruction around_stars = instruction();
  around_stars.selection.second = SecondSet{{{"star"}, {"blue"}}, "avoid"};
  for (Demonstration& d : data) d.instruction = around_stars;
  const Trained centroid = learn({{Picture::mask}}, data, 5, 0, {{"policy", "centroid"}});
  const TwoPoses action = centroid.policy->act(scene(60, 100, 0, 30), around_stars);  // of equals the first is taken
  EXPECT_NEAR(action.pose0.position_m.x, .25 + 80 / 256., 1e-6);
  EXPECT_NEAR(action.pose0.position_m.y, -.5 + 120 / 256., 1e-6);
}

// A heart to take and a star to avoid; what is both counts as the heart.
TEST(Policies, SeeWhatIsToBeAvoidedApartWhereTheMaskIsSigned) {
  Instruction around_stars = instruction();
  around_stars.selection.second = SecondSet{{{"star", "heart"}, {"blue", "red"}}, "avoid"};
  PolicyInputs seen{{Picture::mask}};
  for (const bool apart : {false, true}) {
    seen.signed_mask = apart;
    Featurizer featurizer(seen, tabletop::two_poses());
    Samples row(featurizer.shape(), 1);
    featurizer.write(scene(0, 100, 80, 30), around_stars, Phase::test, row, 0);
    const auto at = [&](int y, int x) {
      return row
          .pictures[0][static_cast<std::size_t>(y * input_rows / rows * input_columns + x * input_columns / columns)];
    };
    EXPECT_EQ(at(20, 120), 1) << "the heart";
    EXPECT_EQ(at(100, 50), apart ? -1 : 1) << "the star";
    EXPECT_EQ(at(60, 200), 0);
  }
  auto data = demonstrations(10);
  for (Demonstration& d : data) d.instruction = around_stars;
  const Observation probe = scene(60, 100, 0, 30);
  const auto taught = [&](const char* mask) {
    return learn({{Picture::mask}}, data, 5, 0, {{"mask", mask}}).policy->act(probe, around_stars);
  };
  EXPECT_NE(taught("signed"), taught("binary"));
}

// Of two roles in one small pixel the target's stays.
TEST(Inputs, ASmallPixelOfASignedMaskIsTheTargetsIfItTouchesIt) {
  std::vector<std::uint8_t> roles(rows * columns);
  roles[0] = second_role;
  roles[1] = target_role;
  roles[8] = second_role;
  std::vector<float> small(input_pixels), native(rows * columns);
  shrink_mask(roles, native_size, input_size, small.data());
  EXPECT_EQ(std::vector<float>(small.begin(), small.begin() + 4), (std::vector<float>{1, 0, -1, 0}));
  shrink_mask(roles, native_size, native_size, native.data());
  EXPECT_EQ(std::vector<float>(native.begin(), native.begin() + 3), (std::vector<float>{-1, 1, 0}));
  EXPECT_EQ(native[8], -1);
}

// Colours that `prepare` makes, different in training: both differ from the camera's, and know the Selection.
TEST(Policies, MayBeShownAPictureOfTheMethodsOwn) {
  const auto data = demonstrations(10);
  const Observation probe = scene(10, 100, 80, 30);
  std::map<Phase, int> calls;
  PolicyInputs own{{Picture::rgb}};
  own.prepare = [&calls](const Observation& observation, const Selection& selection, Phase phase) {
    ++calls[phase];
    EXPECT_EQ(selection.target.product().object_types, std::vector<std::string>{"heart"});
    Observation shown = observation;
    for (std::uint8_t& byte : shown.rgb) byte = static_cast<std::uint8_t>(255 - byte);
    return shown;
  };
  const Trained trained = learn(own, data, 5);
  EXPECT_EQ(calls, (std::map<Phase, int>{{Phase::training, 10}}));
  const Action shown = act(trained, probe);
  EXPECT_EQ(calls[Phase::test], 1);
  Observation inverted = probe;
  for (std::uint8_t& byte : inverted.rgb) byte = static_cast<std::uint8_t>(255 - byte);
  auto inverted_data = data;
  for (Demonstration& d : inverted_data)
    for (std::uint8_t& byte : d.steps[0].observation.rgb) byte = static_cast<std::uint8_t>(255 - byte);
  EXPECT_EQ(act(learn({{Picture::rgb}}, inverted_data, 5), inverted), shown);
  EXPECT_NE(act(learn({{Picture::rgb}}, data, 5), probe), shown);
}

// The heat map takes what a method shows, a text beside colours included, and needs a picture of it.
TEST(Policies, OfHeatMapsSeeAllInputs) {
  const auto data = demonstrations(3);
  const Json heat_map{{"policy", "heat_map"}};
  const Observation probe = scene(30, 100, 80, 30);
  Observation recoloured = probe;
  for (auto& byte : recoloured.rgb) byte = static_cast<std::uint8_t>(255 - byte);
  const Trained rgb = learn({{Picture::rgb}, Text::utterance}, data, 1, 0, heat_map);
  EXPECT_NE(act(rgb, probe), act(rgb, recoloured));
  EXPECT_EQ(rgb.log.back().steps, 300);
  Instruction other = instruction();
  other.utterance = "Bring me the heart.";
  rgb.policy->act(probe, other);
  EXPECT_EQ(rgb.policy->seen_in_training(), false);
  const Trained all = learn({{Picture::rgb, Picture::mask}}, data, 1, 0, heat_map);
  EXPECT_LT(
      norm(TwoPoses(all.policy->act(probe, instruction())).pose0.position_m - Vec2{.25 + 50 / 256., -.5 + 120 / 256.}),
      .05);
  EXPECT_THROW(learn({{}, Text::utterance}, data, 1, 0, heat_map), InputError);
}

TEST(Policies, OfAnUnknownNameAreRefused) {
  EXPECT_THROW(learn({{Picture::mask}}, demonstrations(1), 1, 0, {{"policy", "oracle"}}), InputError);
}

// A value that only looks like one was taken for the default.
TEST(CloningOptions, OfAnUnknownValueAreRefusedByName) {
  const auto refused = [](const char* option, const char* value) {
    Json options{{"epochs", 1}, {"batch_size", 10}, {"learning_rate", .001}, {"batches", "drawn"}};
    options[option] = value;
    return message_of<InputError>([&] {
      read_cloning_options(options);
      read_picture_option(options);
    });
  };
  EXPECT_SAYS(refused("batches", "sorted"), "options: /batches: expected one of drawn, shuffled");
  EXPECT_SAYS(refused("instances", "last"), "options: /instances: expected one of all, first");
  EXPECT_SAYS(refused("mask", "inverted"), "options: /mask: expected one of binary, signed");
  EXPECT_SAYS(refused("picture", "grey"), "options: /picture: expected one of none, rgb");
  EXPECT_SAYS(refused("policy", "oracle"), "options: /policy: expected one of regression, centroid, heat_map");
}

// What descriptors offer is what is read, and the defaults are the same: a descriptor that lacks an option is read as
// one that has it.
TEST(CloningOptions, AreThoseOfTheDescriptors) {
  const Json offered =
      parse_json("{" LGABENCH_CLONING_OPTIONS "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}", "options");
  Json usual;
  for (const auto& [name, option] : offered.items()) usual[name] = option.at("default");
  for (const auto& [name, option] : offered.items())
    for (const Json& value : option.value("values", Json::array())) {
      Json options = usual;
      options[name] = value;
      EXPECT_NO_THROW({
        read_cloning_options(options);
        read_picture_option(options);
        read_network_options(options);
      }) << name
         << " " << value;
    }
  const CloningOptions all = read_cloning_options(usual), none;
  EXPECT_EQ(all.instances, none.instances);
  EXPECT_EQ(all.signed_mask, none.signed_mask);
  EXPECT_EQ(all.policy, none.policy);
  EXPECT_FALSE(read_picture_option(usual));
}

TEST(Policies, OfAnyObjectDoNotSeeTheTypeThatIsLeftOut) {
  const auto data = demonstrations(10);
  PolicyInputs seen{{Picture::segmentation}};
  seen.left_out = "star";
  const Observation here = scene(60, 100, 0, 30), star_moved = scene(60, 100, 0, 150);  // of equals the first is taken
  for (const char* policy : {"regression", "centroid"}) {
    const Trained trained = learn(seen, data, 5, 0, {{"policy", policy}});
    EXPECT_EQ(act(trained, star_moved), act(trained, here)) << policy;
    EXPECT_NE(act(trained, scene(60, 10, 0, 30)), act(trained, here)) << policy;
  }
}

TEST(Policies, ActTheSameWhateverTheySawBefore) {
  const Trained trained = learn({{Picture::mask, Picture::rgb}, Text::utterance}, demonstrations(10), 5);
  const Observation probe = scene(10, 100, 80, 30);
  const Action first = act(trained, probe);
  act(trained, scene(0, 0, 80, 200));
  EXPECT_EQ(act(trained, probe), first);
}

TEST(SentenceEmbeddings, HoldEveryNameOfTheSpaces) {
  SentenceEmbeddings embeddings;
  for (const char* id : {"tabletop", "household", "household_mobile"}) {
    const FeatureSpace space = load_feature_space(id);
    for (const auto* names : {&space.object_types, &space.textures})
      for (const std::string& name : *names) EXPECT_TRUE(embeddings.holds(name)) << name;
  }
  EXPECT_FALSE(embeddings.holds("a name that no space has"));
}

TEST(ShippedMethods, AskForTheDataThatTheProtocolGivesThem) {
  const Catalogue catalogue = scan_plugins({shipped_plugin_directory()});
  const auto needs = [&](const char* id, const Json& overrides) {
    const PluginInfo& plugin = catalogue.find("method", id);
    return load_method(plugin)->needs(resolve_options(plugin, overrides));
  };
  EXPECT_EQ(needs("lga", Json::object()).targets, Needs::Targets::selected);
  EXPECT_EQ(needs("lga", Json::object()).noisy_per_clean, 0);
  const Needs recovery = needs("gcbc_dart", Json::object()), none = needs("gcbc_dart", {{"dart", "none"}});
  EXPECT_EQ(recovery.targets, Needs::Targets::truth);
  EXPECT_EQ(recovery.noisy_per_clean, 5);
  EXPECT_EQ(recovery.noise_max, .2);
  EXPECT_EQ(none.targets, Needs::Targets::truth);
  EXPECT_EQ(none.noisy_per_clean, 0);
  EXPECT_EQ(needs("gcbc_dart", {{"dart", "posthoc"}}).noisy_per_clean, 0) << "its noise needs no physics";
  EXPECT_EQ(needs("gcbc_seg", Json::object()).targets, Needs::Targets::truth);
  EXPECT_EQ(needs("gcbc_seg", Json::object()).noisy_per_clean, 0);
  EXPECT_EQ(needs("factorial", {{"scenes", "selected"}}).targets, Needs::Targets::selected);
  EXPECT_EQ(needs("factorial", {{"scenes", "truth"}}).targets, Needs::Targets::truth);
}

TEST(ShippedMethods, RefuseACentroidWhereTheySeeNoMask) {
  const Catalogue catalogue = scan_plugins({shipped_plugin_directory()});
  const auto refusal = [&](const char* id, const Json& overrides) -> std::string {
    try {
      resolve_options(catalogue.find("method", id), overrides);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  for (const char* id : {"lga", "lga_hill", "human", "lga_s", "factorial"})
    EXPECT_EQ(refusal(id, {{"policy", "centroid"}, {"instances", "first"}}), "") << id;
  for (const char* id : {"lga_l", "gcbc_dart", "gcbc_seg"})
    EXPECT_NE(refusal(id, {{"policy", "centroid"}}).find("needs a goal mask"), std::string::npos) << id;
  EXPECT_EQ(refusal("factorial", {{"policy", "centroid"}, {"input", "object_mask"}}), "");
  for (const char* id : {"lga", "lga_hill", "human", "lga_s", "lga_l", "gcbc_dart", "gcbc_seg", "factorial"})
    EXPECT_EQ(refusal(id, {{"policy", "heat_map"}}), "") << id;
  EXPECT_EQ(refusal("factorial", {{"policy", "heat_map"}, {"input", "rgb"}}), "");
  EXPECT_NE(refusal("lga_l", {{"policy", "heat_map"}, {"image", "none"}}).find("image=none needs"), std::string::npos);
  for (const char* id : {"lga", "lga_s", "factorial"}) {
    EXPECT_EQ(refusal(id, {{"mask", "signed"}}), "") << id;
    EXPECT_NE(refusal(id, {{"mask", "signed"}, {"policy", "centroid"}}).find("mask=signed needs"), std::string::npos);
  }
  EXPECT_NE(refusal("factorial", {{"mask", "signed"}, {"input", "rgb"}}).find("mask=signed needs"), std::string::npos);
  EXPECT_NE(refusal("factorial", {{"policy", "centroid"}, {"input", "rgb"}})
                .find(R"(one of ["mask","true_mask","object_mask"], which policy=centroid needs, got "rgb")"),
            std::string::npos);
}

// With a truth that is not what the language model selects, each input shows itself by what moves the action.
TEST(ShippedMethods, FactorialsInputsShowTheSelectionTheTruthOrThePicture) {
  const Catalogue catalogue = scan_plugins({shipped_plugin_directory()});
  const PluginInfo& plugin = catalogue.find("method", "factorial");
  const Scenario scenario = load_scenario("red_heart");
  Selection blue_stars;
  blue_stars.target = {{"star"}, {"blue"}};
  const auto data = demonstrations(10);
  const Observation here = scene(10, 100, 80, 30), star_moved = scene(10, 100, 80, 150),
                    heart_moved = scene(30, 10, 80, 30);
  const auto with_pallet = [](Observation o) {  // in place of the star
    for (Instance& instance : o.instances)
      if (instance.object_type == "star") instance.object_type = "pallet";
    return o;
  };
  struct Case {
    const char* input;
    bool star, heart, pallet, words;  // whether the action follows it
  };
  for (const auto& [input, star, heart, pallet, words] :
       {Case{"mask", false, true, false, false}, Case{"true_mask", true, false, false, false},
        Case{"object_mask", true, true, false, false}, Case{"object_mask_and_words", true, true, false, true},
        Case{"rgb", true, true, true, false}}) {
    const Json options = resolve_options(plugin, {{"epochs", 3}, {"input", input}});
    RecordedLanguageModel lm(scenario, scenario.recorded);
    TruthAsHuman human(scenario.commands);
    Lines log;
    Services services{lm, human, options, 0, log, tabletop::two_poses()};
    services.truth = [&blue_stars](const Command&) { return blue_stars; };
    auto method = load_method(plugin);
    EXPECT_EQ(method->select(scenario.command(0), scenario.space, services).provenance, Provenance::recorded);
    const auto policy = method->learn(data, services);
    method.reset();  // a policy outlives its method
    const auto action = [&](const Observation& o) { return policy->act(o, instruction()); };
    EXPECT_EQ(action(star_moved) != action(here), star) << input;
    EXPECT_EQ(action(heart_moved) != action(here), heart) << input;
    EXPECT_EQ(action(with_pallet(star_moved)) != action(with_pallet(here)), pallet) << input;
    if (std::string(input) == "true_mask") continue;  // which has a mask for what was selected alone
    Instruction other = instruction();
    other.utterance = "Bring me the heart.";
    EXPECT_EQ(policy->act(here, other) != action(here), words) << input;
  }
}

struct Shipped {
  const char* id;
  Provenance provenance;
  int queries;
  bool star, heart;  // whether its actions follow the distractor, and the target
};
void PrintTo(const Shipped& method, std::ostream* out) { *out << method.id; }

class ShippedMethods : public testing::TestWithParam<Shipped> {};

TEST_P(ShippedMethods, SelectLearnAndActThroughThePlugin) {
  const Catalogue catalogue = scan_plugins({shipped_plugin_directory()});
  const Scenario scenario = load_scenario("red_heart");
  const PluginInfo& plugin = catalogue.find("method", GetParam().id);
  const Json options = resolve_options(plugin, {{"epochs", 3}});
  RecordedLanguageModel lm(scenario, scenario.recorded);
  TruthAsHuman human(scenario.commands);
  Lines log;
  Services services{lm, human, options, 0, log, tabletop::two_poses()};
  const auto method = load_method(plugin);
  const Selection selection = method->select(scenario.command(0), scenario.space, services);
  EXPECT_EQ(selection.cost.lm_queries, GetParam().queries);
  EXPECT_EQ(selection.provenance, GetParam().provenance);
  if (selection.provenance != Provenance::none) {
    EXPECT_EQ(selection.target.product().object_types, std::vector<std::string>{"heart"});
    EXPECT_EQ(selection.target.product().textures == scenario.commands[0].truth.target.product().textures,
              selection.provenance == Provenance::truth)
        << "GPT-4's textures are not quite the true ones, and a simulated edit leaves them";
  }
  const auto policy = method->learn(demonstrations(10), services);
  const Observation probe = scene(10, 100, 80, 30), star_moved = scene(10, 100, 80, 150),
                    heart_moved = scene(30, 10, 80, 30);
  const auto action = [&](const Observation& o) { return policy->act(o, instruction()); };
  EXPECT_EQ(action(probe) != action(star_moved), GetParam().star);
  EXPECT_EQ(action(probe) != action(heart_moved), GetParam().heart);
}

// Of gcbc_dart with this option, on ten demonstrations of one step: batches of ten rows.
long long steps_of_a_pass(const char* dart, std::uint64_t seed, std::vector<double>* losses = nullptr) {
  const Catalogue catalogue = scan_plugins({shipped_plugin_directory()});
  const PluginInfo& plugin = catalogue.find("method", "gcbc_dart");
  const Scenario scenario = load_scenario("heart");
  const Json options = resolve_options(plugin, {{"epochs", 1}, {"dart", dart}});
  RecordedLanguageModel lm(scenario, scenario.recorded);
  TruthAsHuman human(scenario.commands);
  Lines log;
  Services services{lm, human, options, seed, log, tabletop::two_poses()};
  load_method(plugin)->learn(demonstrations(10), services);
  if (losses) losses->push_back(log.lines.back().loss);
  return log.lines.back().steps;
}

TEST(GcbcDart, PosthocTrainsOnFiveNoisyCopiesBesideEachDemonstration) {
  std::vector<double> losses;
  EXPECT_EQ(steps_of_a_pass("none", 0), 1);
  EXPECT_EQ(steps_of_a_pass("posthoc", 0, &losses), 6);
  EXPECT_EQ(steps_of_a_pass("posthoc", 0, &losses), 6);
  EXPECT_EQ(losses[0], losses[1]);
}

// rgb makes LGA's input that of LGA-S: the same actions to the bit.
TEST(ShippedMethodsOptions, PictureGivesTheMasksMethodsTheInputOfLgaS) {
  const Catalogue catalogue = scan_plugins({shipped_plugin_directory()});
  const Scenario scenario = load_scenario("red_heart");
  RecordedLanguageModel lm(scenario, scenario.recorded);
  TruthAsHuman human(scenario.commands);
  Lines log;
  const Observation probe = scene(10, 100, 80, 30);
  const auto action = [&](const char* id, Json overrides) {
    overrides["epochs"] = 3;
    const PluginInfo& plugin = catalogue.find("method", id);
    const Json options = resolve_options(plugin, overrides);
    Services services{lm, human, options, 0, log, tabletop::two_poses()};
    return load_method(plugin)->learn(demonstrations(10), services)->act(probe, instruction());
  };
  const Action both = action("lga_s", Json::object());
  for (const char* id : {"lga", "lga_hill", "human"}) {
    EXPECT_EQ(action(id, {{"picture", "rgb"}}), both) << id;
    EXPECT_NE(action(id, Json::object()), both) << id;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedMethods,
                         testing::Values(Shipped{"lga", Provenance::recorded, 112, false, true},
                                         Shipped{"lga_hill", Provenance::simulated_edit, 112, false, true},
                                         Shipped{"human", Provenance::truth, 0, false, true},
                                         Shipped{"lga_s", Provenance::recorded, 112, true, true},
                                         Shipped{"lga_l", Provenance::recorded, 112, true, true},
                                         Shipped{"gcbc_dart", Provenance::none, 0, true, true},
                                         Shipped{"gcbc_seg", Provenance::none, 0, true, true}),
                         [](const auto& instance) { return std::string(instance.param.id); });

}  // namespace
}  // namespace lgabench
