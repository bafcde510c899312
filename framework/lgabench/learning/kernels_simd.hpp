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

typedef float Vector __attribute__((vector_size(lanes * sizeof(float))));
// In memory, anywhere. No variable has this type: a template's argument loses the attributes, the alignment with them.
typedef float Anywhere __attribute__((vector_size(lanes * sizeof(float)), aligned(sizeof(float)), may_alias));

inline Vector load(const float* from) { return *reinterpret_cast<const Anywhere*>(from); }
inline void store(float* to, Vector value) { *reinterpret_cast<Anywhere*>(to) = value; }

// sum[r][v] += a[r * row_stride + k * step_stride] * b[k * b_stride + v * lanes ..], over k = at(0), at(1) ...
template <int Rows, int Vectors, class At>
LGABENCH_INLINE inline void multiply_add(Vector (&sum)[Rows][Vectors], const float* a, std::ptrdiff_t row_stride,
                                         std::ptrdiff_t step_stride, const float* b, std::ptrdiff_t b_stride, int steps,
                                         const At& at) {
  for (int step = 0; step < steps; ++step) {
    const std::ptrdiff_t k = at(step);
    Vector right[Vectors];
    for (int v = 0; v < Vectors; ++v) right[v] = load(b + k * b_stride + v * lanes);
    for (int r = 0; r < Rows; ++r)
      for (int v = 0; v < Vectors; ++v) sum[r][v] += a[r * row_stride + k * step_stride] * right[v];
  }
}
constexpr auto each = [](int step) LGABENCH_INLINE { return std::ptrdiff_t{step}; };

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
  const int tiles = (count + most_rows - 1) / most_rows, least = tiles > 0 ? count / tiles : 0;
  for (int t = 0, first = 0, larger = count - least * tiles; t < tiles; ++t) {
    const int rows = least + (t < larger ? 1 : 0);
    with_rows(rows, first, use);
    first += rows;
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

// Visits the parts of a window, where windows that lie `step` numbers apart share places of the input: what they
// share is added in the order of 16 lanes, which take blocks of 32 numbers, and window after window within a block.
// Narrower vectors keep that order by taking a block's later part first.
template <class Use>
LGABENCH_INLINE inline void for_parts(int segment, int step, const Use& use) {
  constexpr int of_16_lanes = most_vectors * 16;
  const bool in_parts = most_vectors * lanes < of_16_lanes && step < of_16_lanes;
  const int block = in_parts ? of_16_lanes : segment, part = in_parts ? step : segment;
  for (int begin = 0; begin < segment; begin += block)
    for (int first = (begin + block < segment ? begin + block : segment) - part; first >= begin; first -= part)
      for_vectors(part, [&](auto vectors, int at) LGABENCH_INLINE { use(vectors, first + at); });
}

const float* row(const Layer& l, const float* in, int y) { return in + y * l.columns * l.channels; }
int step_of(const Layer& l) { return l.stride * l.channels; }  // from a position's numbers to the next one's

void forward(const Layer& l, const float* in, const float* weights, const float* bias, float* out, bool relu,
             const Span* spans) {
  const int width = l.out_columns(), segment = l.segment(), step = step_of(l);
  for (int y = 0; y < l.out_rows(); ++y) {
    const Span span = spans ? spans[y] : Span{0, width};
    for_vectors(l.out_channels, [&](auto vectors, int channel) LGABENCH_INLINE {
      for_tiles(span.end - span.begin, [&](auto rows, int tile) LGABENCH_INLINE {
        constexpr int n = decltype(rows)::value, m = decltype(vectors)::value;
        const int first = span.begin + tile;
        Vector sum[n][m];
        for (int r = 0; r < n; ++r)
          for (int v = 0; v < m; ++v) sum[r][v] = load(bias + channel + v * lanes);
        for (int k = 0; k < l.kernel; ++k)
          multiply_add<n, m>(sum, row(l, in, y * l.stride + k) + first * step, step, 1,
                             weights + k * segment * l.out_channels + channel, l.out_channels, segment, each);
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
}

void weight_gradient(const Layer& l, const float* const* in, const float* gradient, float* weight_gradient,
                     int pictures, const Span* spans) {
  const int width = l.out_columns(), segment = l.segment(), step = step_of(l);
  for (int k = 0; k < l.kernel; ++k)
    for_vectors(l.out_channels, [&](auto vectors, int channel) LGABENCH_INLINE {
      for_tiles(segment, [&](auto rows, int first) LGABENCH_INLINE {
        constexpr int n = decltype(rows)::value, m = decltype(vectors)::value;
        Vector sum[n][m] = {};
        const float* right = gradient + channel;
        for (int picture = 0; picture < pictures; ++picture)
          for (int y = 0; y < l.out_rows(); ++y, right += width * l.out_channels) {
            const Span span = spans ? spans[y] : Span{0, width};
            multiply_add<n, m>(sum, row(l, in[picture], y * l.stride + k) + first + span.begin * step, 1, step,
                               right + span.begin * l.out_channels, l.out_channels, span.end - span.begin, each);
          }
        for (int r = 0; r < n; ++r)
          for (int v = 0; v < m; ++v)
            store(weight_gradient + (k * segment + first + r) * l.out_channels + channel + v * lanes, sum[r][v]);
      });
    });
}

// For layers of so many out channels, or of any with 0: a constant saves the addresses.
template <int Channels>
void input_gradient_of(const Layer& l, const float* gradient, const float* transposed, float* in_gradient,
                       const OpenChannels* open) {
  const int width = l.out_columns(), segment = l.segment(), step = step_of(l),
            out_channels = Channels > 0 ? Channels : l.out_channels;
  struct Columns {
    Span where;
    const int* channels;  // to add
    int count;
  };
  for (int y = 0; y < l.out_rows(); ++y) {
    const Span whole = open ? open->whole[y] : Span{0, width};
    const int *const channels = open ? open->channels : nullptr, count = open ? open->count : 0;
    const Columns all[] = {{{0, whole.begin}, channels, count},
                           {whole, every_channel, out_channels},
                           {{whole.end, width}, channels, count}};
    for (int k = 0; k < l.kernel; ++k) {
      float* const to = in_gradient + (y * l.stride + k) * l.columns * l.channels;
      for_parts(segment, step, [&](auto vectors, int part) LGABENCH_INLINE {
        for (const Columns& columns : all)
          for_tiles(columns.where.end - columns.where.begin, [&](auto rows, int tile) LGABENCH_INLINE {
            constexpr int n = decltype(rows)::value, m = decltype(vectors)::value;
            const int first = columns.where.begin + tile;
            Vector sum[n][m] = {};
            multiply_add<n, m>(sum, gradient + (y * width + first) * out_channels, out_channels, 1,
                               transposed + k * out_channels * segment + part, segment, columns.count,
                               [&](int i) LGABENCH_INLINE { return std::ptrdiff_t{columns.channels[i]}; });
            for (int r = 0; r < n; ++r)
              for (int v = 0; v < m; ++v) {
                float* const at = to + (first + r) * step + part + v * lanes;
                store(at, load(at) + sum[r][v]);
              }
          });
      });
    }
  }
}

void input_gradient(const Layer& l, const float* gradient, const float* transposed, float* in_gradient,
                    const OpenChannels* open) {
  (l.out_channels == 16 ? input_gradient_of<16> : input_gradient_of<0>)(l, gradient, transposed, in_gradient, open);
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

// A gradient, as the ReLU whose outputs are `out` lets it through.
template <bool Relu>
LGABENCH_INLINE inline Vector opened(const float* gradient, const float* out) {
  const Vector zero = {};
  const Vector value = load(gradient);
  if constexpr (Relu) return load(out) > zero ? value : zero;
  return value;
}

// Sums of each channel over rows, of m vectors number by number: term(row, v) gives one. Four sums, each of every
// fourth row, hide the latency of an addition and round less than one.
template <int m, class Term>
LGABENCH_INLINE inline void sum_terms(Vector (&sum)[m], int rows, const Term& term) {
  constexpr int strands = 4;
  Vector strand[strands][m] = {};
  int r = 0;
  for (; r + strands <= rows; r += strands)
    for (int s = 0; s < strands; ++s)
      for (int v = 0; v < m; ++v) strand[s][v] += term(r + s, v);
  for (int s = 0; r < rows; ++r, ++s)
    for (int v = 0; v < m; ++v) strand[s][v] += term(r, v);
  for (int v = 0; v < m; ++v) sum[v] = (strand[0][v] + strand[1][v]) + (strand[2][v] + strand[3][v]);
}

void moments(const float* values, int rows, int channels, float* mean, float* squares) {
  for_vectors(channels, [&](auto vectors, int channel) LGABENCH_INLINE {
    constexpr int m = decltype(vectors)::value;
    const float* const first = values + channel;
    Vector sum[m], centre[m];
    sum_terms<m>(sum, rows, [&](int r, int v) LGABENCH_INLINE { return load(first + r * channels + v * lanes); });
    for (int v = 0; v < m; ++v) {
      centre[v] = sum[v] / static_cast<float>(rows);
      store(mean + channel + v * lanes, centre[v]);
    }
    sum_terms<m>(sum, rows, [&](int r, int v) LGABENCH_INLINE {
      const Vector distance = load(first + r * channels + v * lanes) - centre[v];
      return distance * distance;
    });
    for (int v = 0; v < m; ++v) store(squares + channel + v * lanes, sum[v]);
  });
}

void normalise(const float* values, const float* mean, const float* factor, const float* shift, float* out, int rows,
               int channels, bool relu) {
  for_vectors(channels, [&](auto vectors, int channel) LGABENCH_INLINE {
    constexpr int m = decltype(vectors)::value;
    Vector centre[m], by[m], plus[m];
    for (int v = 0; v < m; ++v) {
      centre[v] = load(mean + channel + v * lanes);
      by[v] = load(factor + channel + v * lanes);
      plus[v] = load(shift + channel + v * lanes);
    }
    for (int r = 0; r < rows; ++r)
      for (int v = 0; v < m; ++v) {
        const int at = r * channels + channel + v * lanes;
        const Vector zero = {};
        const Vector value = (load(values + at) - centre[v]) * by[v] + plus[v];
        store(out + at, relu ? (value > zero ? value : zero) : value);
      }
  });
}

template <bool Relu>
LGABENCH_INLINE inline void norm_gradient_of(const float* values, const float* mean, const float* inverse,
                                             const float* scale, const float* out, float* gradient, int rows,
                                             int channels, float* scale_gradient, float* shift_gradient) {
  for_vectors(channels, [&](auto vectors, int channel) LGABENCH_INLINE {
    constexpr int m = decltype(vectors)::value;
    Vector centre[m], sum[m], along[m], less[m], slope[m], factor[m];
    for (int v = 0; v < m; ++v) centre[v] = load(mean + channel + v * lanes);
    const auto let_through = [&](int r, int v) LGABENCH_INLINE {
      const int at = r * channels + channel + v * lanes;
      return opened<Relu>(gradient + at, out + at);
    };
    const auto distance = [&](int r, int v)
                              LGABENCH_INLINE { return load(values + r * channels + channel + v * lanes) - centre[v]; };
    sum_terms<m>(sum, rows, let_through);
    sum_terms<m>(along, rows, [&](int r, int v) LGABENCH_INLINE { return let_through(r, v) * distance(r, v); });
    for (int v = 0; v < m; ++v) {
      const int c = channel + v * lanes;
      const Vector shrink = load(inverse + c);
      store(shift_gradient + c, sum[v]);
      store(scale_gradient + c, along[v] * shrink);
      less[v] = sum[v] / static_cast<float>(rows);
      slope[v] = along[v] * shrink * shrink / static_cast<float>(rows);
      factor[v] = load(scale + c) * shrink;
    }
    for (int r = 0; r < rows; ++r)
      for (int v = 0; v < m; ++v) {
        const Vector change = let_through(r, v) - less[v] - distance(r, v) * slope[v];
        store(gradient + r * channels + channel + v * lanes, factor[v] * change);
      }
  });
}

void norm_gradient(const float* values, const float* mean, const float* inverse, const float* scale, const float* out,
                   float* gradient, int rows, int channels, float* scale_gradient, float* shift_gradient) {
  (out ? norm_gradient_of<true> : norm_gradient_of<false>)(values, mean, inverse, scale, out, gradient, rows, channels,
                                                           scale_gradient, shift_gradient);
}

// a * b + c, rounded once where the processor can: written out, since a compiler may choose another product to fuse.
LGABENCH_INLINE inline float fused(float a, float b, float c) {
#ifdef __FP_FAST_FMAF
  return __builtin_fmaf(a, b, c);
#else
  return a * b + c;
#endif
}

void adam(const AdamCoefficients& c, const float* __restrict gradients, float* __restrict mean,
          float* __restrict variance, float* __restrict parameters, std::size_t count) {
  const auto [b1, b2, epsilon, c1, c2, rate, root] = c;
  for (std::size_t i = 0; i < count; ++i) {
    const float g = gradients[i];
    mean[i] = fused(b1, mean[i], c1 * g);
    variance[i] = fused(b2, variance[i], c2 * g * g);
    parameters[i] -= rate * mean[i] / fused(__builtin_sqrtf(variance[i]), root, epsilon);
  }
}

constexpr Kernels kernels_of(const char* name) {
  return {name,     forward, weight_gradient, input_gradient, relu_gradient,
          sum_rows, moments, normalise,       norm_gradient,  adam};
}

}  // namespace
}  // namespace lgabench
