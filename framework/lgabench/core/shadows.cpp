#include <lgabench/core/shadows.hpp>

#include <algorithm>
#include <array>

namespace lgabench {

std::vector<std::uint16_t> shadows_of(const std::vector<std::uint16_t>& shadows, const std::vector<Instance>& before,
                                      const std::vector<Instance>& now) {
  std::array<std::size_t, 256> row{};
  row.fill(most_shadows);
  for (std::size_t k = 0; k < std::min(before.size(), most_shadows); ++k) row.at(before[k].id) = k;
  std::vector<std::uint16_t> all(shadows.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < std::min(now.size(), most_shadows); ++k)
      if (row.at(now[k].id) < most_shadows)
        all[i] |= static_cast<std::uint16_t>((shadows[i] >> row.at(now[k].id) & 1U) << k);
  return all;
}

}  // namespace lgabench
