#include <lgabench/leaderboard/verification.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <ctime>
#include <limits>
#include <map>
#include <set>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/leaderboard/fresh_commands.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::leaderboard {
namespace {

constexpr std::size_t most_words = 200;  // of a text that a page may show

void expect_chosen(const JsonReader& line, const Entry& entry, const std::vector<std::size_t>& chosen) {
  std::vector<std::string> keys;
  int episodes = 0;
  for (const std::size_t i : chosen) {
    keys.push_back(entry.cells[i].key);
    episodes += entry.cells[i].episodes();
  }
  if (line.at("cells").strings() != keys) line.at("cells").fail("the cells that the nonce chooses");
  line.at("episodes").integer(episodes, episodes);
}

void expect_replay(const JsonReader& line, const Entry& entry, const std::string& hash) {
  const std::size_t count = line.at("cells").strings().size();
  expect_chosen(line, entry, chosen_cells(entry, hash, line.at("nonce").string(), count));
  const auto cells = static_cast<long long>(count);
  const long long identical = line.at("bit_identical").integer(0, cells);
  const long long flips =
      line.at("flips").integer(0, identical == cells ? 0 : line.at("episodes").json().get<long long>());
  if (line.has("only_recorded")) {
    const long long worse = line.at("only_recorded").integer(0, flips), changed = cells - identical;
    if (line.has("worse") || line.has("better")) {
      const long long taken = line.at("worse").integer(0, std::min(worse, changed));
      line.at("better").integer(0, std::min(flips - worse, changed - taken));
    }
  }
  const bool passed = line.at("passed").boolean();
  const statistics::Reproduction verdict = replay_verdict(entry, line.json());
  if (passed && verdict == statistics::Reproduction::differs) line.at("passed").fail("false, by its counts");
  if (!passed && verdict == statistics::Reproduction::identical)
    line.at("passed").fail("true: all of its cells are identical");
}

// Lines of 0.2.0 lack /successes: they say nothing of other arms than the first, and cannot be vouched for.
void expect_fresh(const JsonReader& line, const Entry& entry) {
  for (const char* number : {"low", "difference", "high"})
    if (const double value = line.at(number).number(); !(value >= -2 && value <= 2))
      line.at(number).fail("a difference of two rates");
  const bool passed = line.at("passed").boolean();
  if (!line.has("successes")) return;
  const std::vector<std::size_t> chosen = fresh_cells(entry, line.at("nonce").string());
  expect_chosen(line, entry, chosen);
  std::vector<PlayedCell> played;
  for (const std::size_t i : chosen) played.push_back(entry.cells[i]);
  const Units units(entry.setting, played);
  const std::vector<JsonReader> cells = line.at("successes").elements();
  if (cells.size() != units.size()) line.at("successes").fail("an object for each cell");
  if (line.has("persons")) line.at("persons").integer(2, entry.setting.episodes);
  auto cell = cells.begin();
  for (const PlayedCell& one : units) {
    cell->only(entry.setting.scenario(one.place.scenario).arms);
    for (const auto& [arm, letters] : one.outcomes) cell->at(arm).integer(0, static_cast<long long>(letters.size()));
    ++cell;
  }
  const std::vector<FreshEstimate> estimates = fresh_estimates(entry, {&line.json()});
  const bool differs = std::any_of(estimates.begin(), estimates.end(), [](const auto& one) { return one.differs(); });
  if (passed == differs) line.at("passed").fail(differs ? "false, by its successes" : "true, by its successes");
  const FreshEstimate& mean = estimates.back();
  for (const auto& [number, value] : {std::pair("difference", mean.difference), {"low", mean.low}, {"high", mean.high}})
    if (std::abs(line.at(number).number() - value) > 1e-9) line.at(number).fail(fmt::format("{:.6f}", value));
}

struct Sum {
  double difference = 0, variance = 0;
  void add(double weight, double a_difference, double a_variance) {
    difference += weight * a_difference;
    variance += weight * weight * a_variance;
  }
};

// What a line would give its entry, were it vouched for; "" where the entry, of that tier, has that already.
std::string said(const Entry& entry, Tier now, bool is_fresh, const Json& line) {
  const bool passed = line.at("passed");
  if (line.at("kind") == "commands")
    return !passed ? "differs on fresh commands" : entry.fresh_commands() > 0 ? "" : "agrees on fresh commands";
  if (line.at("kind") == "fresh") return !passed ? "differs on fresh scenes" : is_fresh ? "" : "agrees on fresh scenes";
  if (!passed) return "a replay differed";
  const Tier tier = tier_of(entry, line);
  return tier <= now ? "" : to_string(tier);
}

// Of the share of successes of one out of so many persons, who have their episodes in turn; no less than their scenes
// alone make it.
double variance_of_persons(const std::string& letters, int persons, double of_an_episode) {
  std::vector<double> shares(static_cast<std::size_t>(persons), 0);
  const double scenes = static_cast<double>(letters.size()) / persons;
  for (std::size_t i = 0; i < letters.size(); ++i) shares[i % shares.size()] += is_success(letters[i]) / scenes;
  const double mean = successes(letters) / static_cast<double>(letters.size());
  double sum = 0;
  for (const double share : shares) sum += (share - mean) * (share - mean);
  return std::max(sum / (persons - 1), of_an_episode / scenes);
}

}  // namespace

Processor processor_of(const Json& line) {
  return read_processor(JsonReader(line.at("machine"), "verifications.jsonl", "/machine"));
}

statistics::Reproduction replay_verdict(const Entry& entry, const Json& line) {
  if (line.at("bit_identical") == line.at("cells").size()) return statistics::Reproduction::identical;
  if (owe_same_bits(entry.processor(), processor_of(line), false)) return statistics::Reproduction::differs;
  const int flips = line.at("flips");
  statistics::PooledAgreement all;
  // A line of 0.2.0 does not say which way episodes went, and one before 0.5 not in which cells.
  all.only_recorded = line.value("only_recorded", flips / 2);
  all.only_recomputed = flips - all.only_recorded;
  all.worse = line.value("worse", all.only_recorded);
  all.better = line.value("better", all.only_recomputed);
  all.p_holm = statistics::mcnemar(all.worse, all.better);
  return statistics::verdict_of(flips, line.at("episodes"), {all});
}

void expect_verification(const JsonReader& line, const Entry& entry, const std::string& hash) {
  line.only({"kind",
             "nonce",
             "cells",
             "bit_identical",
             "flips",
             "only_recorded",
             "worse",
             "better",
             "episodes",
             "passed",
             "by",
             "when",
             "program",
             "build",
             "machine",
             "confinement",
             "scene_seed",
             "demonstrations",
             "training_seed",
             "difference",
             "low",
             "high",
             "successes",
             "persons",
             "commands",
             "exact",
             "lga_exact",
             "published",
             "published_exact"});
  const std::string kind = line.at("kind").string(), nonce = line.at("nonce").string();
  if (kind != "replay" && kind != "fresh" && kind != "commands") line.at("kind").fail("replay, fresh or commands");
  if (nonce.size() != 32 || nonce.find_first_not_of("0123456789abcdef") != std::string::npos)
    line.at("nonce").fail("32 hexadecimal digits");
  for (const char* text : {"by", "program", "confinement"})
    if (line.at(text).string().size() > most_words) line.at(text).fail(fmt::format("at most {} bytes", most_words));
  expect_date(line.at("when"));
  read_processor(line.at("machine"));
  if (kind == "commands") return expect_fresh_commands(line);
  if (line.at("cells").strings().empty())
    line.at("cells").fail("at least one cell: without any, it says nothing about the entry");
  for (const char* count : {"bit_identical", "flips", "episodes"})
    line.at(count).integer(0, std::numeric_limits<int>::max());
  if (kind == "replay")
    expect_replay(line, entry, hash);
  else
    expect_fresh(line, entry);
}

void expect_date(const JsonReader& reader) {
  const std::string text = reader.string();
  std::tm time{};
  const char* end = ::strptime(text.c_str(), "%Y-%m-%d", &time);
  if (end == nullptr || *end != '\0' || text.size() != 10) reader.fail("a date, as 2026-01-31");
}

std::vector<std::size_t> fresh_cells(const Entry& entry, const std::string& nonce) {
  const Setting& setting = entry.setting;
  const bool learning = learns(entry.identity.row);
  const auto pick = [&](const char* what, std::size_t count) {
    return static_cast<std::size_t>(std::stoull(sha256(nonce + what).substr(0, 8), nullptr, 16)) % count;
  };
  const int n = learning ? setting.demonstrations[pick("demonstrations", setting.demonstrations.size())] : 0;
  const bool seeds = learning || setting.test_scenes == TestScenes::per_seed;
  const std::uint64_t seed = seeds ? setting.seeds[pick("seed", setting.seeds.size())] : 0;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < entry.cells.size(); ++i)
    if (entry.cells[i].place.demonstrations == n && entry.cells[i].place.seed == seed) chosen.push_back(i);
  return chosen;
}

std::vector<FreshEstimate> fresh_estimates(const Entry& entry, const std::vector<const Json*>& lines) {
  const Units units(entry);
  std::map<std::string, std::map<std::string, std::pair<int, int>>> played;  // cell -> arm -> successes, units
  int persons = 0;
  for (const Json* line : lines) {
    persons = line->value("persons", 0);
    const std::set<std::string> cells = line->at("cells");
    auto cell = line->at("successes").begin();
    for (const PlayedCell& one : units) {
      if (cells.count(one.key) == 0) continue;
      for (const auto& [arm, successes] : cell->items()) {
        auto& [won, of] = played[one.key][arm];
        won += successes.get<int>();
        of += static_cast<int>(one.outcomes.at(arm).size());
      }
      ++cell;
    }
  }
  std::map<std::string, int> cells_of_arm;
  for (const auto& cell : played)
    for (const auto& arm : cell.second) ++cells_of_arm[arm.first];
  std::map<std::string, Sum> sums;
  Sum mean;
  for (const PlayedCell& cell : units) {
    const auto fresh = played.find(cell.key);
    if (fresh == played.end()) continue;
    for (const auto& [arm, counts] : fresh->second) {
      const std::string& letters = cell.outcomes.at(arm);
      const auto share = [](double won, double of) { return std::pair(won / of, (won + 1) / (of + 2)); };
      const auto before = share(successes(letters), static_cast<double>(letters.size()));
      const auto now = share(counts.first, counts.second);
      double variance = before.second * (1 - before.second) / (static_cast<double>(letters.size()) + 2) +
                        now.second * (1 - now.second) / (counts.second + 2.);
      if (persons > 0)
        variance = variance_of_persons(letters, persons, before.second * (1 - before.second)) *
                   (1. / persons + static_cast<double>(letters.size()) / counts.second / persons);
      sums[arm].add(1. / cells_of_arm.at(arm), now.first - before.first, variance);
      mean.add(1. / static_cast<double>(played.size() * fresh->second.size()), now.first - before.first, variance);
    }
  }
  if (sums.size() > 1) sums[""] = mean;
  std::vector<FreshEstimate> estimates;
  std::vector<double> p;
  const auto add = [&](const std::string& arm, const Sum& sum) {
    const double margin = statistics::z_95 * std::sqrt(sum.variance);
    estimates.push_back({arm, sum.difference, sum.difference - margin, sum.difference + margin, 1});
    p.push_back(std::erfc(std::abs(sum.difference) / std::sqrt(2 * sum.variance)));
  };
  for (const auto& [arm, sum] : sums)
    if (!arm.empty()) add(arm, sum);
  if (sums.size() > 1) add("", mean);
  const std::vector<double> adjusted = statistics::holm(p);
  for (std::size_t i = 0; i < estimates.size(); ++i) estimates[i].p_holm = adjusted[i];
  return estimates;
}

double smallest_found(const std::vector<FreshEstimate>& estimates) {
  const boost::math::normal normal;
  const FreshEstimate& mean = estimates.back();
  const double error = (mean.high - mean.low) / (2 * statistics::z_95);
  return error * (boost::math::quantile(normal, 1 - .05 / 2 / static_cast<double>(estimates.size())) +
                  boost::math::quantile(normal, .8));
}

std::vector<std::string> claims(const Entry& entry) {
  constexpr std::size_t most = 3;
  std::vector<std::string> all;
  const Tier tier = entry.tier();
  const bool is_fresh = entry.fresh() > 0;
  for (const Json& line : entry.verifications) {
    const std::string what = entry.counts(line) ? "" : said(entry, tier, is_fresh, line);
    std::string claim = fmt::format("claimed by {}: {}", line.at("by").get<std::string>(), what);
    if (!what.empty() && !contains(all, claim)) all.push_back(std::move(claim));
  }
  if (!entry.withdrawn.is_null() && !entry.is_withdrawn()) all.emplace_back("claimed: withdrawn");
  if (all.size() > most) {
    const std::size_t more = all.size() - most;
    all.resize(most);
    all.push_back(fmt::format("{} more claims", more));
  }
  return all;
}

}  // namespace lgabench::leaderboard
