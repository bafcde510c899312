#include <lgabench/leaderboard/verification.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <limits>

namespace lgabench::leaderboard {
namespace {

void expect_date(const JsonReader& reader) {
  const std::string text = reader.string();
  std::tm time{};
  const char* end = ::strptime(text.c_str(), "%Y-%m-%d", &time);
  if (end == nullptr || *end != '\0' || text.size() != 10) reader.fail("a date, as 2026-01-31");
}

// Cells and episodes of a replay are those that its nonce chooses.
void expect_chosen(const JsonReader& line, const Entry& entry) {
  const std::vector<std::string> said = line.at("cells").strings();
  std::vector<std::string> chosen;
  int episodes = 0;
  for (const std::size_t i : chosen_cells(entry, line.at("nonce").string(), said.size())) {
    chosen.push_back(entry.cells[i].key);
    episodes += entry.cells[i].episodes();
  }
  if (said != chosen) line.at("cells").fail("the cells that the nonce chooses");
  line.at("episodes").integer(episodes, episodes);
}

void expect_replay(const JsonReader& line, const Entry& entry) {
  expect_chosen(line, entry);
  const auto cells = static_cast<long long>(line.at("cells").json().size());
  const long long identical = line.at("bit_identical").integer(0, cells);
  const long long flips =
      line.at("flips").integer(0, identical == cells ? 0 : line.at("episodes").json().get<long long>());
  if (line.has("only_recorded")) line.at("only_recorded").integer(0, flips);
  const bool passed = line.at("passed").boolean();
  const report::Reproduction verdict = replay_verdict(entry, line.json());
  if (passed && verdict == report::Reproduction::differs) line.at("passed").fail("false, by its counts");
  if (!passed && verdict == report::Reproduction::identical)
    line.at("passed").fail("true: all of its cells are identical");
}

void expect_fresh(const JsonReader& line) {
  double at[3];
  std::size_t i = 0;
  for (const char* number : {"low", "difference", "high"}) {
    at[i] = line.at(number).number();
    if (!(at[i] >= -2 && at[i] <= 2)) line.at(number).fail("a difference of two rates");
    ++i;
  }
  if (at[0] >= at[2] || at[1] < at[0] || at[1] > at[2]) line.at("difference").fail("between /low and /high");
  if (line.at("passed").boolean() != (at[0] <= 0 && at[2] >= 0)) line.at("passed").fail("whether the interval holds 0");
}

// What a line would give its entry, were it vouched for; "" where the entry has that already.
std::string said(const Entry& entry, const Json& line) {
  const bool passed = line.at("passed");
  if (line.at("kind") == "fresh")
    return !passed ? "differs on fresh scenes" : entry.fresh() > 0 ? "" : "agrees on fresh scenes";
  if (!passed) return "a replay differed";
  const Tier tier = tier_of(entry, line);
  return tier <= entry.tier() ? "" : to_string(tier);
}

}  // namespace

report::Reproduction replay_verdict(const Entry& entry, const Json& line) {
  const std::size_t identical = line.at("bit_identical");
  report::CellAgreement all;
  all.episodes = line.at("episodes");
  if (identical == line.at("cells").size())
    all.agreement = report::Agreement::identical;
  else if (line.at("machine").at("processor") != entry.processor())
    all.agreement = report::Agreement::other_outcomes;
  const int flips = line.at("flips");
  // A line of 0.2.0 does not say which way episodes went: it keeps the rule of its time.
  all.only_recorded = line.value("only_recorded", flips / 2);
  all.only_recomputed = flips - all.only_recorded;
  return report::verdict_of({{"", all}});
}

void expect_verification(const JsonReader& line, const Entry& entry) {
  line.only({"kind",     "nonce",       "cells",      "bit_identical",  "flips",         "only_recorded",
             "episodes", "passed",      "by",         "when",           "program",       "build",
             "machine",  "confinement", "scene_seed", "demonstrations", "training_seed", "difference",
             "low",      "high"});
  const std::string kind = line.at("kind").string(), nonce = line.at("nonce").string();
  if (kind != "replay" && kind != "fresh") line.at("kind").fail("replay or fresh");
  if (nonce.size() != 32 || nonce.find_first_not_of("0123456789abcdef") != std::string::npos)
    line.at("nonce").fail("32 hexadecimal digits");
  for (const char* text : {"by", "program", "confinement"}) line.at(text).string();
  expect_date(line.at("when"));
  line.at("machine").at("processor").string();
  if (line.at("cells").strings().empty()) line.at("cells").fail("a cell or more: none says nothing of the entry");
  for (const char* count : {"bit_identical", "flips", "episodes"})
    line.at(count).integer(0, std::numeric_limits<int>::max());
  if (kind == "replay")
    expect_replay(line, entry);
  else
    expect_fresh(line);
}

std::vector<std::string> claims(const Entry& entry) {
  constexpr std::size_t most = 3;
  std::vector<std::string> all;
  for (const Json& line : entry.verifications) {
    const std::string what = entry.counts(line) ? "" : said(entry, line);
    std::string claim = fmt::format("claimed by {}: {}", line.at("by").get<std::string>(), what);
    if (!what.empty() && std::find(all.begin(), all.end(), claim) == all.end()) all.push_back(std::move(claim));
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
