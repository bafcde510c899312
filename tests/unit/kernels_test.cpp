// Every width of vectors gives the same bits: what makes a record of one processor right on another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include <lgabench/core/processor.hpp>
#include <lgabench/learning/heat_map_network.hpp>
#include <lgabench/learning/network.hpp>
#include <tabletop/two_poses.hpp>

#include "kernels_lanes.hpp"
#include "random_samples.hpp"

namespace lgabench {
namespace {

// All that this processor can run and that fuse products, the first of which is 16 lanes wide.
std::vector<const Kernels*> fusing_kernels() {
  std::vector<const Kernels*> all{&kernels_of_lanes<16>(), &kernels_of_lanes<8>(), &kernels_of_lanes<4>()};
  for (const Kernels* kernels : available_kernels())
    if (std::strcmp(kernels->name, "portable") != 0) all.push_back(kernels);
  return all;
}

class Widths : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_avx2()) GTEST_SKIP() << "this processor has no fused multiply-add";
  }

  // What train(kernels) returns has the same bits whatever the kernels.
  template <class Train>
  static void expect_the_same_bits(const Train& train) {
    const std::vector<float> first = train(*fusing_kernels().front());
    for (const Kernels* kernels : fusing_kernels()) {
      const std::vector<float> other = train(*kernels);
      ASSERT_EQ(other.size(), first.size());
      EXPECT_EQ(std::memcmp(other.data(), first.data(), first.size() * sizeof(float)), 0) << kernels->name;
    }
  }
};

TEST_F(Widths, TrainThePapersNetworksToTheSameBits) {
  std::vector<NetworkShape> shapes;
  for (const Architecture architecture : {Architecture::plain, Architecture::text, Architecture::released})
    shapes.push_back({{1, 3}, true, architecture});
  shapes.push_back({{4}, false, Architecture::text});
  shapes.push_back({{3, 1}, true, Architecture::plain, 12, true});
  for (const NetworkShape& shape : shapes)
    for (const bool alike : {false, true}) {
      const Samples samples = (alike ? mostly_alike : random_samples)(shape, 10);
      expect_the_same_bits([&](const Kernels& kernels) {
        Network network(shape, 3, Loss::norm, kernels);
        if (alike) network.begin(samples);
        for (int step = 0; step < 5; ++step) {
          network.backward(samples, all_rows(samples));
          network.update(1e-3);
        }
        return network.parameters();
      });
    }
}

// Something in a rectangle of an otherwise empty picture, as a mask or colours less the usual picture show it.
Numbers picture_of(int planes, RandomStream& random) {
  constexpr PictureSize padded = HeatMapNetwork::padded;
  Numbers picture(size(padded.rows * padded.columns * planes));
  const int top = 4 + static_cast<int>(random.below(20)), left = 4 + static_cast<int>(random.below(50));
  for (int y = top; y < top + 9; ++y)
    for (int x = left; x < left + 7; ++x)
      for (int plane = 0; plane < planes; ++plane)
        picture[(y * padded.columns + x) * planes + plane] = static_cast<float>(random.uniform(-.5, 1));
  return picture;
}

TEST_F(Widths, TrainHeatMapsToTheSameBits) {
  struct Case {
    int planes;
    bool text;
    std::size_t groups;
  };
  for (const auto& [planes, text, groups] : {Case{2, false, 1}, Case{5, true, 3}})
    expect_the_same_bits([planes = planes, text = text, groups = groups](const Kernels& kernels) {
      HeatMapNetwork network(Field(tabletop::two_poses()), planes, text, groups, 1, kernels);
      RandomStream random("widths");
      const std::vector<float> words(384, .05f);
      for (int step = 0; step < 5; ++step) {
        network.clear_gradients();
        for (int row = 0; row < 4; ++row) {
          const Numbers picture = picture_of(planes, random);
          std::vector<float> wanted(HeatMapNetwork::cells);
          wanted[random.below(wanted.size())] = 1;
          network.map(picture, nullptr, text ? words.data() : nullptr);
          network.teach(wanted, {.5, .1}, size(row) % groups, .25);
        }
        network.update(3e-3);
      }
      return network.parameters().values();
    });
}

// Channels that hold 0 outside some columns are passed over there without a trace, whatever the width.
TEST_F(Widths, PassOverClosedChannelsWithoutATrace) {
  constexpr Layer layer{6, 41, 16, 3, 1, 16};
  RandomStream random("closed");
  const auto numbers = [&](int count) {
    Numbers all(size(count));
    for (int i = 0; i < count; ++i) all[i] = static_cast<float>(random.uniform(-1, 1));
    return all;
  };
  const std::vector<Span> whole{{5, 30}, {0, 0}, {0, layer.out_columns()}, {38, 39}};
  const std::vector<int> channels{1, 4, 5, 6, 7, 8, 15};
  ASSERT_EQ(whole.size(), size(layer.out_rows()));
  Numbers gradient = numbers(layer.outputs());
  for (int i = 0; i < layer.outputs(); ++i) {
    const int channel = i % 16, column = i / 16 % layer.out_columns();
    const Span& in = whole[size(i / 16 / layer.out_columns())];
    const bool open = std::find(channels.begin(), channels.end(), channel) != channels.end();
    if (!open && (column < in.begin || column >= in.end)) gradient[i] = 0;
  }
  const Numbers weights = numbers(layer.weights());
  Numbers transposed(size(layer.weights()));
  transpose_weights(layer, weights, transposed);
  const OpenChannels open{whole.data(), channels.data(), static_cast<int>(channels.size())};
  for (const OpenChannels* given : {static_cast<const OpenChannels*>(nullptr), &open})
    expect_the_same_bits([&](const Kernels& kernels) {
      std::vector<float> in(size(layer.inputs()), 0), all(in);
      kernels.input_gradient(layer, gradient, transposed, in.data(), given);
      kernels.input_gradient(layer, gradient, transposed, all.data(), nullptr);
      EXPECT_EQ(in, all);
      return in;
    });
}

}  // namespace
}  // namespace lgabench
