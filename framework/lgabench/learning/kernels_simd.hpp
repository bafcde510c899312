// Every kernel, for vectors of LGABENCH_LANES numbers: included once for each instruction set, by a file that is
// compiled for it. Nothing here is shared between those files: an inline function of a header, compiled twice, would be
// linked once, and perhaps as the one that the processor cannot run.
#include <lgabench/learning/kernels.hpp>

#define LGABENCH_INLINE __attribute__((always_inline))

namespace lgabench {
namespace {

constexpr int lanes = LGABENCH_LANES;
// Numbers of one product that are kept in registers: rows x vectors.
constexpr int most_rows = LGABENCH_TILE_ROWS, most_vectors = 2;

typedef float Vector __attribute__((vector_size(lanes * sizeof(float)), aligned(sizeof(float)), may_alias));

inline Vector load(const float* from) { return *reinterpret_cast<const Vector*>(from); }
inline void store(float* to, Vector value) { *reinterpret_cast<Vector*>(to) = value; }

// sum[r][v] += a[r * row_stride + k * step_stride] * b[k * b_stride + v * lanes ..], over k.
template <int Rows, int Vectors>
LGABENCH_INLINE inline void multiply_add(Vector (&sum)[Rows][Vectors], const float* a, std::ptrdiff_t row_stride,
                                         std::ptrdiff_t step_stride, const float* b, std::ptrdiff_t b_stride,
                                         int steps) {
  for (int k = 0; k < steps; ++k, a += step_stride, b += b_stride) {
    Vector right[Vectors];
    for (int v = 0; v < Vectors; ++v) right[v] = load(b + v * lanes);
    for (int r = 0; r < Rows; ++r)
      for (int v = 0; v < Vectors; ++v) sum[r][v] += a[r * row_stride] * right[v];
  }
}

// A number as a type, so that a lambda may use it as a constant.
template <int N>
struct Constant {
  static constexpr int value = N;
};

// Calls use(Constant<rows>, first) for tiles of nearly equal size, none above most_rows, that cover 0 .. count.
template <int Rows = most_rows, class Use>
LGABENCH_INLINE inline void with_rows(int rows, int first, const Use& use) {
  if constexpr (Rows > 0) {
    if (rows == Rows)
      use(Constant<Rows>(), first);
    else
      with_rows<Rows - 1>(rows, first, use);
  }
}
template <class Use>
LGABENCH_INLINE inline void for_tiles(int count, const Use& use) {
  const int tiles = (count + most_rows - 1) / most_rows;
  for (int t = 0; t < tiles; ++t) {
    const int first = count * t / tiles;
    with_rows(count * (t + 1) / tiles - first, first, use);
  }
}

// Calls use(Constant<vectors>, first) for whole vectors that cover 0 .. count, which holds at least one; where they do
// not fill it, the last overlaps the one before.
template <class Use>
LGABENCH_INLINE inline void for_vectors(int count, const Use& use) {
  int first = 0;
  for (; count - first >= most_vectors * lanes; first += most_vectors * lanes) use(Constant<most_vectors>(), first);
  for (; first < count; first += lanes) use(Constant<1>(), first + lanes < count ? first : count - lanes);
}

const float* row(const Layer& l, const float* in, int y) { return in + y * l.columns * l.channels; }
int step_of(const Layer& l) { return l.stride * l.channels; }  // from a position's numbers to the next one's

void forward(const Layer& l, const float* in, const float* weights, const float* bias, float* out, bool relu) {
  const int width = l.out_columns(), segment = l.segment(), step = step_of(l);
  for (int y = 0; y < l.out_rows(); ++y)
    for_vectors(l.out_channels, [&](auto vectors, int channel) LGABENCH_INLINE {
      for_tiles(width, [&](auto rows, int first) LGABENCH_INLINE {
        constexpr int n = decltype(rows)::value, m = decltype(vectors)::value;
        Vector sum[n][m];
        for (int r = 0; r < n; ++r)
          for (int v = 0; v < m; ++v) sum[r][v] = load(bias + channel + v * lanes);
        for (int k = 0; k < l.kernel; ++k)
          multiply_add<n, m>(sum, row(l, in, y * l.stride + k) + first * step, step, 1,
                             weights + k * segment * l.out_channels + channel, l.out_channels, segment);
        for (int r = 0; r < n; ++r)
          for (int v = 0; v < m; ++v) {
            const Vector zero = {};
            const Vector value = sum[r][v];
            store(out + (y * width + first + r) * l.out_channels + channel + v * lanes,
                  relu ? (value > zero ? value : zero) : value);
          }
      });
    });
}

void weight_gradient(const Layer& l, const float* const* in, const float* gradient, float* weight_gradient,
                     int pictures) {
  const int width = l.out_columns(), segment = l.segment(), step = step_of(l);
  for (int k = 0; k < l.kernel; ++k)
    for_vectors(l.out_channels, [&](auto vectors, int channel) LGABENCH_INLINE {
      for_tiles(segment, [&](auto rows, int first) LGABENCH_INLINE {
        constexpr int n = decltype(rows)::value, m = decltype(vectors)::value;
        Vector sum[n][m] = {};
        const float* right = gradient + channel;
        for (int picture = 0; picture < pictures; ++picture)
          for (int y = 0; y < l.out_rows(); ++y, right += width * l.out_channels)
            multiply_add<n, m>(sum, row(l, in[picture], y * l.stride + k) + first, 1, step, right, l.out_channels,
                               width);
        for (int r = 0; r < n; ++r)
          for (int v = 0; v < m; ++v)
            store(weight_gradient + (k * segment + first + r) * l.out_channels + channel + v * lanes, sum[r][v]);
      });
    });
}

void input_gradient(const Layer& l, const float* gradient, const float* transposed, float* in_gradient) {
  const int width = l.out_columns(), segment = l.segment(), step = step_of(l);
  for (int y = 0; y < l.out_rows(); ++y)
    for (int k = 0; k < l.kernel; ++k) {
      float* const to = in_gradient + (y * l.stride + k) * l.columns * l.channels;
      for_vectors(segment, [&](auto vectors, int part) LGABENCH_INLINE {
        for_tiles(width, [&](auto rows, int first) LGABENCH_INLINE {
          constexpr int n = decltype(rows)::value, m = decltype(vectors)::value;
          Vector sum[n][m] = {};
          multiply_add<n, m>(sum, gradient + (y * width + first) * l.out_channels, l.out_channels, 1,
                             transposed + k * l.out_channels * segment + part, segment, l.out_channels);
          for (int r = 0; r < n; ++r)
            for (int v = 0; v < m; ++v) {
              float* const at = to + (first + r) * step + part + v * lanes;
              store(at, load(at) + sum[r][v]);
            }
        });
      });
    }
}

void relu_gradient(const float* __restrict out, float* __restrict gradient, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) gradient[i] = out[i] > 0 ? gradient[i] : 0;
}

void sum_rows(const float* values, float* sums, int rows, int channels) {
  for_vectors(channels, [&](auto vectors, int channel) LGABENCH_INLINE {
    constexpr int m = decltype(vectors)::value;
    Vector sum[m] = {};
    for (int r = 0; r < rows; ++r)
      for (int v = 0; v < m; ++v) sum[v] += load(values + r * channels + channel + v * lanes);
    for (int v = 0; v < m; ++v) store(sums + channel + v * lanes, sum[v]);
  });
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
  return {name, forward, weight_gradient, input_gradient, relu_gradient, sum_rows, adam};
}

}  // namespace
}  // namespace lgabench
