// Every kernel, for vectors of LGABENCH_LANES numbers: included once for each instruction set, by a file that is
// compiled for it. Nothing here is shared between those files: an inline function of a header, compiled twice, would be
// linked once, and perhaps as the one that the processor cannot run.
#include <lgabench/learning/kernels.hpp>

namespace lgabench {
namespace {

constexpr int lanes = LGABENCH_LANES;
// Numbers of one product that are kept in registers: rows x vectors.
constexpr int most_rows = LGABENCH_TILE_ROWS, most_vectors = 2;

typedef float Vector __attribute__((vector_size(lanes * sizeof(float)), aligned(sizeof(float)), may_alias));

inline Vector load(const float* from) { return *reinterpret_cast<const Vector*>(from); }
inline void store(float* to, Vector value) { *reinterpret_cast<Vector*>(to) = value; }

// sum[r][v] += a[r * RowStride + k * StepStride] * b[k * BStride + v * lanes ..], over k.
template <int Rows, int Vectors, int RowStride, int StepStride, int BStride>
__attribute__((always_inline)) inline void multiply_add(Vector (&sum)[Rows][Vectors], const float* a, const float* b,
                                                        int steps) {
  for (int k = 0; k < steps; ++k, a += StepStride, b += BStride) {
    Vector right[Vectors];
    for (int v = 0; v < Vectors; ++v) right[v] = load(b + v * lanes);
    for (int r = 0; r < Rows; ++r)
      for (int v = 0; v < Vectors; ++v) sum[r][v] += a[r * RowStride] * right[v];
  }
}

// A number as a type, so that a lambda may use it as a constant.
template <int N>
struct Constant {
  static constexpr int value = N;
};

// Calls use(Constant<rows>, first) for tiles of nearly equal size, none above most_rows, that cover 0 .. count.
template <int Rows = most_rows, class Use>
__attribute__((always_inline)) inline void with_rows(int rows, int first, const Use& use) {
  if constexpr (Rows > 0) {
    if (rows == Rows)
      use(Constant<Rows>(), first);
    else
      with_rows<Rows - 1>(rows, first, use);
  }
}
template <class Use>
__attribute__((always_inline)) inline void for_tiles(int count, const Use& use) {
  const int tiles = (count + most_rows - 1) / most_rows;
  for (int t = 0; t < tiles; ++t) {
    const int first = count * t / tiles;
    with_rows(count * (t + 1) / tiles - first, first, use);
  }
}

constexpr int vectors_of(int width) { return width / lanes < most_vectors ? width / lanes : most_vectors; }

template <int Kind>
struct LayerKernels {
  static constexpr Layer layer = layers[Kind];
  static constexpr int out_channels = layer.out_channels, segment = layer.segment();
  static constexpr int step = layer.stride * layer.channels;  // from a position's numbers to the next one's

  static int positions(int columns) { return layer.columns ? layer.out_columns() : columns; }
  static const float* row(const float* in, int y) { return in + y * layer.columns * layer.channels; }

  static void forward(const float* in, const float* weights, const float* bias, float* out, bool relu, int columns) {
    constexpr int vectors = vectors_of(out_channels);
    const int width = positions(columns);
    for (int y = 0; y < layer.out_rows(); ++y)
      for (int channel = 0; channel < out_channels; channel += vectors * lanes)
        for_tiles(width, [&](auto rows, int first) {
          constexpr int n = decltype(rows)::value;
          Vector sum[n][vectors];
          for (int r = 0; r < n; ++r)
            for (int v = 0; v < vectors; ++v) sum[r][v] = load(bias + channel + v * lanes);
          for (int k = 0; k < layer.kernel; ++k)
            multiply_add<n, vectors, step, 1, out_channels>(sum, row(in, y * layer.stride + k) + first * step,
                                                            weights + k * segment * out_channels + channel, segment);
          for (int r = 0; r < n; ++r)
            for (int v = 0; v < vectors; ++v) {
              const Vector zero = {};
              const Vector value = sum[r][v];
              store(out + (y * width + first + r) * out_channels + channel + v * lanes,
                    relu ? (value > zero ? value : zero) : value);
            }
        });
  }

  static void weight_gradient(const float* const* in, const float* gradient, float* weight_gradient, int pictures,
                              int columns) {
    constexpr int vectors = vectors_of(out_channels);
    const int width = positions(columns);
    for (int k = 0; k < layer.kernel; ++k)
      for (int channel = 0; channel < out_channels; channel += vectors * lanes)
        for_tiles(segment, [&](auto rows, int first) {
          constexpr int n = decltype(rows)::value;
          Vector sum[n][vectors] = {};
          const float* right = gradient + channel;
          for (int picture = 0; picture < pictures; ++picture)
            for (int y = 0; y < layer.out_rows(); ++y, right += width * out_channels)
              multiply_add<n, vectors, 1, step, out_channels>(sum, row(in[picture], y * layer.stride + k) + first,
                                                              right, width);
          for (int r = 0; r < n; ++r)
            for (int v = 0; v < vectors; ++v)
              store(weight_gradient + (k * segment + first + r) * out_channels + channel + v * lanes, sum[r][v]);
        });
  }

  static void input_gradient(const float* gradient, const float* transposed, float* in_gradient, int columns) {
    constexpr int vectors = vectors_of(segment);
    const int width = positions(columns);
    for (int y = 0; y < layer.out_rows(); ++y)
      for (int k = 0; k < layer.kernel; ++k) {
        float* const to = in_gradient + (y * layer.stride + k) * layer.columns * layer.channels;
        for (int part = 0; part < segment; part += vectors * lanes)
          for_tiles(width, [&](auto rows, int first) {
            constexpr int n = decltype(rows)::value;
            Vector sum[n][vectors] = {};
            multiply_add<n, vectors, out_channels, 1, segment>(sum, gradient + (y * width + first) * out_channels,
                                                               transposed + k * out_channels * segment + part,
                                                               out_channels);
            for (int r = 0; r < n; ++r)
              for (int v = 0; v < vectors; ++v) {
                float* const at = to + (first + r) * step + part + v * lanes;
                store(at, load(at) + sum[r][v]);
              }
          });
      }
  }

  static constexpr Kernels::OfLayer all() {
    if constexpr (layer.channels < 16)
      return {forward, weight_gradient, nullptr};
    else
      return {forward, weight_gradient, input_gradient};
  }
};

void relu_gradient(const float* __restrict out, float* __restrict gradient, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) gradient[i] = out[i] > 0 ? gradient[i] : 0;
}

void sum_rows(const float* values, float* sums, int rows, int channels) {
  for (int channel = 0; channel < channels; channel += lanes) {
    Vector sum = {};
    for (int r = 0; r < rows; ++r) sum += load(values + r * channels + channel);
    store(sums + channel, sum);
  }
}

void adam(const AdamCoefficients& c, const float* __restrict gradients, float* __restrict mean,
          float* __restrict variance, float* __restrict parameters, std::size_t count) {
  const auto [b1, b2, epsilon, c1, c2, rate, root] = c;
  for (std::size_t i = 0; i < count; ++i) {
    const float g = gradients[i];
    mean[i] = b1 * mean[i] + c1 * g;
    variance[i] = b2 * variance[i] + c2 * g * g;
    parameters[i] -= rate * mean[i] / (__builtin_sqrtf(variance[i]) * root + epsilon);
  }
}

constexpr Kernels kernels_of(const char* name) {
  return {name,
          {LayerKernels<mask_convolution>::all(), LayerKernels<rgb_convolution>::all(),
           LayerKernels<convolution2>::all(), LayerKernels<convolution3>::all(), LayerKernels<text_linear>::all(),
           LayerKernels<tower_head>::all(), LayerKernels<text_head>::all()},
          relu_gradient,
          sum_rows,
          adam};
}

}  // namespace
}  // namespace lgabench
