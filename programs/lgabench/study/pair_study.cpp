#include <lgabench/study/pair_study.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <lgabench/abstraction/disputed.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::study {
namespace {

constexpr std::size_t pairs_of_a_row = 4;
constexpr double enough = .8;  // power

// All pairs of a product; the first ones have few words in common.
std::vector<AskedPair> shuffled(const FeatureSet& set, RandomStream& random) {
  const std::size_t types = set.object_types.size(), textures = set.textures.size();
  const std::vector<int> a = random.permutation(static_cast<int>(types));
  const std::vector<int> b = random.permutation(static_cast<int>(textures));
  std::vector<AskedPair> pairs;
  for (std::size_t i = 0; i < types * textures; ++i)  // one diagonal after another
    pairs.push_back({set.object_types[static_cast<std::size_t>(a[i % types])],
                     set.textures[static_cast<std::size_t>(b[(i + i / std::lcm(types, textures)) % textures])],
                     {}});
  return pairs;
}

Json item_of(const std::string& command, const std::vector<FeatureSet>& rows, const Scenario& scenario,
             RandomStream random) {
  const auto& commands = scenario.commands;
  const Selection& truth = std::find_if(commands.begin(), commands.end(), [&](const ScenarioCommand& one) {
                             return one.utterance == command;
                           })->truth;
  Json pairs = Json::array();
  const auto ask = [&pairs](const AskedPair& pair, Json more = Json::object()) {
    more.update({{"object_type", pair.object_type}, {"texture", pair.texture}});
    if (!contains(pairs, more)) pairs.push_back(std::move(more));  // rows overlap
  };
  for (const FeatureSet& row : rows) {
    const std::vector<AskedPair> all = shuffled(row, random);
    for (std::size_t i = 0; i < std::min(all.size(), pairs_of_a_row); ++i) ask(all[i]);
  }
  const auto control = [&](const FeatureSet& among, bool meant) {
    for (const AskedPair& pair : shuffled(among, random)) {
      const auto holds = [&pair](const FeatureSet& row) { return row.contains(pair.object_type, pair.texture); };
      if (truth.belongs(pair.object_type, pair.texture) == meant && std::none_of(rows.begin(), rows.end(), holds))
        return ask(pair, {{"settled", meant}});
    }
  };
  control(truth.target.sets.front(), true);
  control({scenario.space.object_types, scenario.space.textures}, false);
  return {{"scenario", scenario.id}, {"asked_as", command}, {"pairs", std::move(pairs)}};
}

}  // namespace

Json disputed_items(std::uint64_t seed) {
  std::vector<Scenario> scenarios;
  for (const std::string& id : scenario_ids()) scenarios.push_back(load_scenario(id));
  std::stable_sort(scenarios.begin(), scenarios.end(),  // the command alone before it among others
                   [](const Scenario& a, const Scenario& b) { return a.commands.size() < b.commands.size(); });
  Json items = Json::array();
  std::map<std::string, DisputedPairs> spaces;
  for (const Scenario& scenario : scenarios) spaces.try_emplace(scenario.space.id, disputed_pairs(scenario.space));
  for (const auto& [space, disputed] : spaces)
    for (const auto& [command, rows] : disputed) {
      const auto found =
          std::find_if(scenarios.begin(), scenarios.end(), [&, id = space, words = command](const Scenario& one) {
            const std::vector<std::string> all = one.utterances();
            return one.space.id == id && contains(all, words);
          });
      if (found == scenarios.end())
        throw InputError(fmt::format("disputed/{}.json: no scenario has the command \"{}\"", space, command));
      items.push_back(item_of(command, rows, *found, RandomStream(fmt::format("study/{}/{}", seed, command))));
    }
  return items;
}

double p_unsettled(const Said& said) {
  const int n = said[0] + said[1] + said[2], most = std::max(said[0], said[1]);
  return 2 * most <= n ? 1 : statistics::mcnemar(most, n - most);
}

double power(int people, int pairs, double share) {
  double chance = 0;
  for (int yes = people;
       yes >= 0 && p_unsettled({yes, people - yes, 0}) <= statistics::alpha / pairs && 2 * yes > people; --yes)
    chance += std::exp(std::lgamma(people + 1.) - std::lgamma(yes + 1.) - std::lgamma(people - yes + 1.) +
                       yes * std::log(share) + (people - yes) * std::log1p(-share));
  return chance;
}

int people_needed(int pairs) {
  constexpr int steady = 50;  // power goes down by a little where a person more does not lower what p can be
  int too_few = 0;
  for (int people = 1; people - too_few <= steady; ++people)
    if (power(people, pairs) < enough) too_few = people;
  return too_few + 1;
}

PairCount count_pairs(const Protocol& protocol) {
  PairCount count;
  for (const Item& item : protocol.sets[0])
    for (const AskedPair& pair : item.pairs) ++(pair.settled ? count.controls : count.disputed);
  return count;
}

std::string power_words(const Protocol& protocol) {
  const auto [disputed, controls] = count_pairs(protocol);
  const int n = protocol.planned, needed = people_needed(std::max(1, disputed));
  const statistics::Interval half = statistics::wilson(n / 2., n);
  return fmt::format(
      "{} disputed pairs and {} controls\n"
      "power: a pair that 80 % call meant is settled with probability {:.2f}; .80 needs {} people (exact binomial test "
      "against 50 %, Holm over the pairs, his first step); a share near 50 % has an interval of ± {:.2f}",
      disputed, controls, power(n, std::max(1, disputed)), needed, (half.high - half.low) / 2);
}

std::optional<double> krippendorff_alpha(const std::vector<std::vector<int>>& units) {
  std::vector<double> totals;
  double disagree = 0, all = 0, by_chance = 0;
  for (const std::vector<int>& unit : units) {
    const double n = std::accumulate(unit.begin(), unit.end(), 0);
    if (n < 2) continue;  // with nothing to agree with
    totals.resize(std::max(totals.size(), unit.size()));
    for (std::size_t value = 0; value < unit.size(); ++value) {
      totals[value] += unit[value];
      disagree += unit[value] * (n - unit[value]) / (n - 1);
    }
    all += n;
  }
  for (const double total : totals) by_chance += total * (all - total);
  if (by_chance == 0) return std::nullopt;
  return 1 - (all - 1) * disagree / by_chance;
}

}  // namespace lgabench::study
