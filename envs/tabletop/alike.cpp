#include <tabletop/alike.hpp>

#include <algorithm>

namespace lgabench::tabletop {
namespace {

bool same(const Features& a, const Features& b) { return a.type == b.type && a.texture == b.texture; }

bool all_share_alike(const std::vector<Features>& all) {
  const int first = shared(all.front(), all);
  return std::all_of(all.begin(), all.end(), [&](const Features& one) { return shared(one, all) == first; });
}

// Of the first's type and its texture, how many another one has too.
int kinds_shared(const std::vector<Features>& all) {
  const Features& first = all.front();
  const auto another = [&all](const auto& has) { return std::any_of(all.begin() + 1, all.end(), has); };
  return another([&](const Features& one) { return one.type == first.type; }) +
         another([&](const Features& one) { return one.texture == first.texture; });
}

std::vector<Features> crossed(const std::vector<Features>& there, const std::vector<Features>& fresh,
                              const std::function<bool(const Features&)>& may_be) {
  std::vector<Features> of = there, all;
  of.insert(of.end(), fresh.begin(), fresh.end());
  for (const Features& a : of)
    for (const Features& b : of) {
      const Features one{a.type, b.texture};
      const auto is_one = [&one](const Features& other) { return same(one, other); };
      if (std::none_of(there.begin(), there.end(), is_one) && std::none_of(all.begin(), all.end(), is_one) &&
          may_be(one))
        all.push_back(one);
    }
  return all;
}

// Of the best, each with equal odds.
struct Search {
  const std::vector<Features>& candidates;
  RandomStream& random;
  int best = -1;  // kinds_shared()
  std::uint32_t found = 0;
  std::vector<Features> chosen = {};

  void extend(std::vector<Features>& all, std::size_t from, int more) {
    if (more == 0) {
      const int kinds = kinds_shared(all);
      if (kinds < best || !all_share_alike(all)) return;
      if (kinds > best) found = 0;
      best = kinds;
      if (random.below(++found) == 0) chosen = all;
      return;
    }
    for (std::size_t i = from; i < candidates.size(); ++i) {
      all.push_back(candidates[i]);
      extend(all, i + 1, more - 1);
      all.pop_back();
    }
  }
};

}  // namespace

int shared(const Features& object, const std::vector<Features>& all) {
  int count = -2;  // with itself
  for (const Features& other : all) count += (other.type == object.type) + (other.texture == object.texture);
  return count;
}

std::optional<std::vector<Features>> sharing_alike(const std::vector<Features>& there,
                                                   const std::vector<Features>& fresh, std::pair<int, int> count,
                                                   const std::function<bool(const Features&)>& may_be,
                                                   RandomStream& random) {
  const std::vector<Features> candidates = crossed(there, fresh, may_be);
  Search best{candidates, random};
  for (const int more : random.permutation(count.second - count.first + 1)) {
    Search search{candidates, random};
    std::vector<Features> all = there;
    search.extend(all, 0, count.first + more);
    if (search.best > best.best) {
      best.best = search.best;
      best.chosen = search.chosen;
    }
  }
  if (best.chosen.empty()) return std::nullopt;
  return std::vector<Features>(best.chosen.begin() + static_cast<std::ptrdiff_t>(there.size()), best.chosen.end());
}

}  // namespace lgabench::tabletop
