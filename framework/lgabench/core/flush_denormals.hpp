// Subnormal numbers are slow (Adam's moments decay into them: 20 times the time of a step) and are flushed to zero.
#pragma once
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace lgabench {

#if defined(__SSE2__)
constexpr unsigned flush_bits = 0x8040;  // MXCSR: flush-to-zero, denormals-are-zero
/// Denormals are zero from now on in the calling thread; threads started later inherit it.
inline void flush_denormals() { _mm_setcsr(_mm_getcsr() | flush_bits); }
inline bool denormals_flushed() { return (_mm_getcsr() & flush_bits) == flush_bits; }
#else
inline void flush_denormals() {}
inline bool denormals_flushed() { return true; }
#endif

}  // namespace lgabench
