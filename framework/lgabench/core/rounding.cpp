#include <lgabench/core/rounding.hpp>

#include <fmt/format.h>

#include <cmath>

namespace lgabench {
namespace {

double rounded(double value, int digits) {
  const double unit = std::pow(10, digits);
  return std::round(value * unit + std::copysign(1e-7, value)) / unit + 0.;  // + 0: no negative zero
}

}  // namespace

std::string fixed(double value, int digits) { return fmt::format("{:.{}f}", rounded(value, digits), digits); }

std::string signed_text(double value, int digits) {
  const double shown = rounded(value, digits);
  return shown == 0 ? fixed(0, digits) : fmt::format("{:+.{}f}", shown, digits);
}

}  // namespace lgabench
