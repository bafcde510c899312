#include <lgabench/statistics/claims.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/parallel.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/claims_field.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::statistics {
namespace {

// Both tests of a difference are judged in the same way, each on its own.
constexpr std::array tests{&ClaimedDifference::these, &ClaimedDifference::alike};
using Test = Tested ClaimedDifference::*;

Verdict worst(const std::vector<ClaimedDifference>& differences, Test test) {
  for (const Verdict verdict : {Verdict::reversed, Verdict::undecided, Verdict::not_tested})
    if (std::any_of(differences.begin(), differences.end(),
                    [&](const auto& d) { return (d.*test).verdict == verdict; }))
      return verdict;
  return differences.empty() ? Verdict::not_tested : Verdict::held;
}

// A test of a difference: by how much it is on its claim's side (below 0: on the other; 0: neither), and its p.
struct Side {
  Tested* tested;
  double ahead, p;
};

// Of an ordering.
Side side_of(Tested& tested) {
  const Interval& i = tested.change->interval;
  return {&tested, i.low > 0 ? i.low : std::min(i.high, 0.0), tested.change->p};
}

// The verdicts of a family of tests.
void judge(const std::vector<Side>& family) {
  std::vector<double> p;
  for (const Side& side : family) p.push_back(side.p);
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < family.size(); ++i) {
    auto& [tested, ahead, ignored] = family[i];
    tested->p_holm = adjusted[i];
    tested->verdict = adjusted[i] > alpha || ahead == 0 ? Verdict::undecided
                      : ahead > 0                       ? Verdict::held
                                                        : Verdict::reversed;
  }
}

// The rows compared for one claim in one arm at one number of demonstrations: a family of tests.
void judge_orderings(std::vector<ClaimedDifference>& differences) {
  for (const Test test : tests) {
    std::vector<Side> family;
    for (ClaimedDifference& d : differences)
      if (Tested& t = d.*test; t.change) family.push_back(side_of(t));
    judge(family);
  }
}

// All must be equivalent, so none needs a correction for the others (intersection-union).
void judge_equivalence(ClaimedDifference& d, double margin) {
  for (const Test test : tests) {
    Tested& t = d.*test;
    if (!t.change) continue;
    const Interval& i = t.change->interval;
    t.p_holm = t.change->p;
    t.verdict = i.low > -margin && i.high < margin   ? Verdict::held
                : i.low > margin || i.high < -margin ? Verdict::reversed
                                                     : Verdict::undecided;
  }
}

// Why none of the differences was tested.
std::string reasons(const std::vector<ClaimedDifference>& differences, Test test) {
  std::vector<std::string> all;
  for (const ClaimedDifference& d : differences)
    if (const std::string& reason = (d.*test).reason; !reason.empty() && !contains(all, reason)) all.push_back(reason);
  return all.empty() ? "no method's cell has been played" : fmt::format("{}", fmt::join(all, "; "));
}

// Arms that give only commands without demonstrations.
std::vector<std::string> unseen_arms(const Field& field) {
  std::set<std::string> seen;
  for (const CellResult* cell : field.cells())
    for (const auto& [arm, episodes] : cell->episodes)
      for (const Episode& e : episodes)
        if (cell->commands[e.command].seen) seen.insert(arm);
  std::vector<std::string> unseen;
  for (const std::string& arm : field.arms)
    if (seen.count(arm) == 0) unseen.push_back(arm);
  return unseen;
}

bool from_people(const CellResult& cell) {
  return std::all_of(cell.commands.begin(), cell.commands.end(), [&cell](const CommandResult& command) {
    return cell.failed || command.selection.value("provenance", "") == "human";
  });
}

// Whether people made every Selection of the row.
bool people_selected(const Field& field, const std::string& row, int n) {
  const Field::Policies* policies = field.find(row, n);
  return policies && std::all_of(policies->begin(), policies->end(), [](const auto& item) {
           return std::all_of(item.second.begin(), item.second.end(),
                              [](const auto& one) { return from_people(*one.second); });
         });
}

// All but the first, which is what the others are compared with: nothing shifts there.
std::vector<std::string> shifted_arms(const Field& field) {
  return field.arms.empty() ? field.arms : std::vector<std::string>(field.arms.begin() + 1, field.arms.end());
}

std::vector<std::string> arms_of(const PaperClaim& paper, const Field& field) {
  switch (paper.arms) {
    case PaperClaim::Arms::shifted:
      return shifted_arms(field);
    case PaperClaim::Arms::unseen:
      return unseen_arms(field);
    default:
      return field.arms;
  }
}

// Why no row of the run can be one of `above`: all of them need options that no row has. A mask of all instances, for
// one, shows two objects where training never did: the claim could not hold for a reason.
std::string missing_options(const PaperClaim& paper, const Field& field) {
  for (const ClaimedMethod& method : paper.above)
    if (method.options.empty() || !find_row(field, method).empty()) return "";
  const std::string text = paper.above.front().text();
  return "no row " + text.substr(text.find(" with ") + 1);
}

void test_ordering(Claim& claim, const PaperClaim& paper, const Field& field) {
  claim.reason = missing_options(paper, field);
  if (!claim.reason.empty()) return;
  for (const std::string& arm : arms_of(paper, field))
    for (const int n : field.demonstrations) {
      if (paper.demonstrations && n != *paper.demonstrations) continue;
      std::vector<ClaimedDifference> family;
      for (const ClaimedMethod& above : paper.above)
        for (const ClaimedMethod& below : paper.below)
          family.push_back(measured(field, claim.id, above, below, arm, n));
      judge_orderings(family);
      claim.differences.insert(claim.differences.end(), family.begin(), family.end());
    }
}

void test_equivalence(Claim& claim, const PaperClaim& paper, const Field& field) {
  const ClaimedMethod &above = paper.above.front(), &below = paper.below.front();
  for (const int n : field.demonstrations) {
    if (paper.demonstrations && n != *paper.demonstrations) continue;
    if (!people_selected(field, find_row(field, below), n)) continue;
    for (const std::string& arm : arms_of(paper, field)) {
      claim.differences.push_back(measured(field, claim.id, above, below, arm, n));
      judge_equivalence(claim.differences.back(), paper.margin);
    }
  }
  if (claim.differences.empty())
    claim.reason = "no human data" +
                   (paper.demonstrations ? fmt::format(" at {} demonstrations", *paper.demonstrations) : std::string());
}

// Seconds that each command took each participant; one command has one answer, however many cells it is in.
using Seconds = std::map<std::string, std::map<std::pair<std::string, std::string>, double>>;
Seconds seconds_of(const Field& field, const std::string& method) {
  Seconds seconds;
  for (const CellResult* cell : field.cells())  // whatever the options: what is learned takes the person no time
    if (cell->id == method && !cell->participant.empty() && !cell->failed)
      for (const CommandResult& command : cell->commands)
        seconds[cell->participant][{cell->scenario, command.utterance}] =
            command.selection.at("cost").at("human_seconds").get<double>();
  return seconds;
}

// Slow minus fast, of each participant: the mean over the commands that they answered in both ways. In a crossover
// nobody did: there it is the difference of their two means.
std::vector<double> slower_by(const Seconds& slow, const Seconds& fast, std::set<std::string>& scenarios) {
  const auto mean = [](const Seconds::mapped_type& commands) {
    double sum = 0;
    for (const auto& item : commands) sum += item.second;
    return sum / static_cast<double>(commands.size());
  };
  std::vector<double> paired, unpaired;
  std::set<std::string> of_paired, of_unpaired;
  for (const auto& [participant, commands] : slow) {
    const auto other = fast.find(participant);
    if (other == fast.end()) continue;
    Seconds::mapped_type both;
    for (const auto& [command, s] : commands)
      if (const auto same = other->second.find(command); same != other->second.end()) {
        both[command] = s - same->second;
        of_paired.insert(command.first);
      }
    if (!both.empty()) paired.push_back(mean(both));
    unpaired.push_back(mean(commands) - mean(other->second));
    for (const auto* some : {&commands, &other->second})
      for (const auto& item : *some) of_unpaired.insert(item.first.first);
  }
  scenarios = paired.empty() ? of_unpaired : of_paired;
  return paired.empty() ? unpaired : paired;
}

void test_seconds(Claim& claim, const PaperClaim& paper, const Field& field) {
  ClaimedDifference d;
  d.above = paper.above.front().id;
  d.below = paper.below.front().id;
  d.unit = "seconds";
  const Seconds slow = seconds_of(field, d.above), fast = seconds_of(field, d.below);
  std::set<std::string> scenarios;
  const std::vector<double> differences = slower_by(slow, fast, scenarios);
  if (slow.empty() || fast.empty()) {
    claim.reason = "no human data";
  } else {
    d.participants = static_cast<int>(differences.size());
    d.scenarios = static_cast<int>(scenarios.size());
    if (differences.size() < 2)
      d.these.reason =
          fmt::format("expected 2 or more participants who answered in both ways, got {}", differences.size());
    else
      d.these.change = paired_t(differences);
    d.alike.reason = "people are the sample, not scenarios";
    claim.differences = {d};
    judge_orderings(claim.differences);
  }
}

// A claim's verdicts, from those of its differences.
void conclude(Claim& claim, const Field& field) {
  claim.rehearsal = field.rehearsal && std::any_of(claim.differences.begin(), claim.differences.end(),
                                                   [](const auto& d) { return d.participants > 0; });
  const bool refused = !claim.reason.empty();  // before any row was looked at
  claim.verdict = worst(claim.differences, &ClaimedDifference::these);
  claim.alike = worst(claim.differences, &ClaimedDifference::alike);
  if (claim.verdict == Verdict::not_tested && !refused)
    claim.reason = reasons(claim.differences, &ClaimedDifference::these);
  if (claim.alike == Verdict::not_tested)
    claim.reason_alike = refused ? claim.reason : reasons(claim.differences, &ClaimedDifference::alike);
}

Claim test_claim(const PaperClaim& paper, const std::string& suite, const Field& field) {
  Claim claim;
  claim.id = paper.id;
  claim.statement = paper.statement;
  claim.layout = field.layout;
  claim.engine = field.engine;
  if (!paper.suite.empty() && paper.suite != suite) {
    claim.needs = paper.suite;
    claim.reason = fmt::format("needs a run of suite {}", paper.suite);
  } else if (paper.test == PaperClaim::Test::ordering)
    test_ordering(claim, paper, field);
  else if (paper.test == PaperClaim::Test::equivalence)
    test_equivalence(claim, paper, field);
  else
    test_seconds(claim, paper, field);
  conclude(claim, field);
  return claim;
}

Field only(const Field& field, const std::vector<std::string>& scenarios) {
  if (scenarios.empty()) return field;
  Field some;
  for (const CellResult* cell : field.cells())
    if (contains(scenarios, cell->scenario)) some.add(*cell);
  some.layout = field.layout;
  some.engine = field.engine;
  return some;
}

Claim measured_claim(const SuiteClaim& stated, const Field& all) {
  const Field field = only(all, stated.scenarios);
  Claim claim;
  claim.id = stated.id;
  claim.statement = stated.statement;
  claim.refuted_if = stated.refuted_if;
  claim.layout = all.layout;
  claim.engine = all.engine;
  const std::vector<int> every(field.demonstrations.begin(), field.demonstrations.end());
  for (const std::string& arm : stated.arms.empty() ? field.arms : stated.arms)
    for (const int n : stated.demonstrations.empty() ? every : stated.demonstrations) {
      if (!contains(field.arms, arm)) {
        ClaimedDifference missing;
        missing.above = stated.above;
        missing.below = stated.below;
        missing.arm = arm;
        missing.demonstrations = n;
        missing.these.reason = missing.alike.reason = "no arm " + arm;
        claim.differences.push_back(missing);
      } else {
        claim.differences.push_back(stated.test == SuiteClaim::Test::slope
                                        ? measured_slope(field, stated, arm, n)
                                        : measured(field, stated.id, claimed_method(stated.above),
                                                   claimed_method(stated.below), arm, n, stated.paired));
      }
    }
  return claim;
}

// Where a margin shifts it, p is from the interval's width, as if it were a normal distribution's.
Side side_of(const SuiteClaim& stated, Tested& tested) {
  using Kind = SuiteClaim::Test;
  if (stated.test == Kind::ordering || stated.test == Kind::slope) return side_of(tested);
  const Change& change = *tested.change;
  const double ahead =
      stated.margin - (stated.test == Kind::equivalence ? std::abs(change.difference) : change.difference);
  const double error = (change.interval.high - change.interval.low) / (2 * z_95);
  if (error <= 0) return {&tested, ahead, ahead == 0 ? 1. : 0.};
  return {&tested, ahead, std::erfc(std::abs(ahead) / error / std::sqrt(2.0))};
}

// As the run's record has them, or else the installation, of a run that is older than they are.
std::vector<SuiteClaim> own_claims(const RunResults& run) {
  if (!run.record.claims.is_null()) return read_suite_claims(run.record.claims, "run.json: /claims");
  const fs::path file = installed_suite(run.suite);
  const Json installed = file.empty() ? Json() : claims_beside(file);
  return installed.is_null() ? std::vector<SuiteClaim>() : read_suite_claims(installed, file.string());
}

// Each on the field; their differences, all together, are a family of tests.
std::vector<Claim> test_own(const std::vector<SuiteClaim>& stated, const Field& field) {
  std::vector<Claim> claims(stated.size());
  in_parallel(stated.size(), [&](std::size_t i) { claims[i] = measured_claim(stated[i], field); });
  for (const Test test : tests) {
    std::vector<Side> family;
    for (std::size_t i = 0; i < stated.size(); ++i)
      for (ClaimedDifference& d : claims[i].differences)
        if (Tested& t = d.*test; t.change) family.push_back(side_of(stated[i], t));
    judge(family);
  }
  for (Claim& claim : claims) conclude(claim, field);
  return claims;
}

Claim difference_in(const Field& field, const std::string& above, const std::string& below) {
  Claim claim;
  claim.id = "A-B";
  claim.statement = fmt::format("{} above {}", display_name(above), display_name(below));
  claim.layout = field.layout;
  claim.engine = field.engine;
  for (const std::string& row : {above, below})
    if (field.rows.count(row) == 0) claim.reason = fmt::format("no row {}", row);
  for (const std::string& arm : field.arms)
    for (const int n : field.demonstrations) {
      if (!field.find(above, n) || !field.find(below, n)) continue;
      std::vector<ClaimedDifference> alone{measured_rows(field, claim.id, above, below, arm, n)};
      judge_orderings(alone);
      claim.differences.push_back(std::move(alone.front()));
    }
  conclude(claim, field);
  return claim;
}

// The run's cells by (layout, engine).
std::map<std::pair<std::string, std::string>, Field> fields_of(const RunResults& run) {
  std::map<std::pair<std::string, std::string>, Field> fields;
  for (const CellResult& cell : run.cells) fields[{cell.layout, cell.engine}].add(cell);
  return fields;
}

}  // namespace

std::string to_string(Verdict verdict) {
  constexpr const char* words[] = {"held", "reversed", "undecided", "not tested"};
  return words[static_cast<int>(verdict)];
}

std::string claims_title(const std::vector<Claim>& claims) {
  return !claims.empty() && !claims.front().refuted_if.empty() ? "The suite's claims" : "The paper's claims";
}

std::vector<Claim> test_claims(const RunResults& run) {
  const auto fields = fields_of(run);
  if (const std::vector<SuiteClaim> stated = own_claims(run); !stated.empty()) {
    std::vector<Claim> claims;
    for (const auto& item : fields)
      for (Claim& claim : test_own(stated, item.second)) claims.push_back(std::move(claim));
    return claims;
  }
  const std::vector<PaperClaim> paper = paper_claims();
  std::vector<std::pair<const Field*, const PaperClaim*>> tests;
  for (const auto& item : fields)
    for (const PaperClaim& claim : paper) tests.emplace_back(&item.second, &claim);
  std::vector<Claim> claims(tests.size());
  in_parallel(tests.size(),
              [&](std::size_t i) { claims[i] = test_claim(*tests[i].second, run.suite, *tests[i].first); });
  return claims;
}

std::vector<Claim> test_difference(const RunResults& run, const std::string& above, const std::string& below) {
  const auto fields = fields_of(run);
  std::set<std::string> rows;
  for (const auto& item : fields)
    for (const auto& row : item.second.rows) rows.insert(row.first);
  for (const std::string& row : {above, below})
    if (rows.count(row) == 0) throw InputError(fmt::format("no row {}, the run has: {}", row, fmt::join(rows, ", ")));
  std::vector<Claim> claims;
  for (const auto& item : fields) claims.push_back(difference_in(item.second, above, below));
  return claims;
}

}  // namespace lgabench::statistics
