#include <lgabench/report/claims.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include <lgabench/report/names.hpp>
#include <lgabench/report/pairs.hpp>

namespace lgabench::report {
namespace {

constexpr double refuse_up_to = 0.05, margin = 0.10;

// The cells of one (layout, engine), by row, demonstrations, then scenario and training seed.
struct Field {
  std::string layout, engine;
  std::vector<std::string> arms;  // as the scenarios list them
  std::set<int> demonstrations;   // of the methods
  // By scenario and training seed, then participant ("" where nobody was asked).
  using People = std::map<std::string, const CellResult*>;
  using Policies = std::map<std::pair<std::string, long long>, People>;
  std::map<std::string, std::map<int, Policies>> rows;

  const Policies* find(const std::string& row, int n) const {
    const auto by_number = rows.find(row);
    if (by_number == rows.end()) return nullptr;
    const auto policies = by_number->second.find(n);
    return policies == by_number->second.end() ? nullptr : &policies->second;
  }
};

bool has_arm(const CellResult& cell, const std::string& arm) {
  return std::find(cell.arms.begin(), cell.arms.end(), arm) != cell.arms.end();
}

// The policy that stands on the participant's answers, or the one that stands on nobody's; nullptr where it did not
// finish.
const CellResult* finished(const Field::People& people, const std::string& participant) {
  auto it = people.find(participant);
  if (it == people.end()) it = people.find("");
  return it == people.end() || it->second->failed ? nullptr : it->second;
}

// Whose answers the one or the other of two rows stands on; "" alone where both stand on nobody's.
std::set<std::string> participants(const Field::People& one, const Field::People& other) {
  std::set<std::string> names;
  for (const Field::People* people : {&one, &other})
    for (const auto& item : *people) names.insert(item.first);
  if (names.size() > 1) names.erase("");
  return names;
}

// `above` against `below`, every policy of the one with its pair; not tested where one lacks its pair, since whoever
// fails on hard scenarios would gain by it.
ClaimedDifference measured(const Field& field, const std::string& claim, const std::string& above,
                           const std::string& below, const std::string& arm, int n) {
  ClaimedDifference d;
  d.above = above, d.below = below, d.arm = arm, d.demonstrations = n;
  const Field::Policies *high = field.find(above, n), *low = field.find(below, n);
  for (const auto& [row, policies] : {std::pair(above, high), {below, low}})
    if (!policies && d.reason.empty()) d.reason = fmt::format("no row {}", row);
  if (!d.reason.empty()) return d;

  Field::Policies all = *high;
  all.insert(low->begin(), low->end());
  PairedRow pairs;
  int wanted = 0;
  const auto people = [](const Field::Policies& row, const Field::Policies::key_type& which) {
    const auto found = row.find(which);
    return found == row.end() ? Field::People() : found->second;
  };
  for (const auto& item : all) {
    if (!has_arm(*item.second.begin()->second, arm)) continue;
    const Field::People a = people(*low, item.first), b = people(*high, item.first);
    for (const std::string& participant : participants(a, b)) {
      ++wanted;
      const CellResult *first = finished(a, participant), *second = finished(b, participant);
      if (first && second) pairs.add(item.first.first, pair_policies(*first, *second, arm), participant);
    }
  }
  if (pairs.policies() < wanted || wanted == 0) {
    d.reason = fmt::format("{} of {} policies finished in both rows", pairs.policies(), wanted);
    return d;
  }
  d.scenarios = pairs.scenarios();
  d.policies = pairs.policies();
  d.participants = pairs.participants();
  d.change =
      pairs.change(fmt::format("claims/{}/{}/{}/{}/{}/{}/{}", claim, field.layout, field.engine, above, below, arm, n));
  return d;
}

Verdict worst(const std::vector<ClaimedDifference>& differences) {
  for (const Verdict verdict : {Verdict::reversed, Verdict::undecided, Verdict::not_tested})
    if (std::any_of(differences.begin(), differences.end(), [&](const auto& d) { return d.verdict == verdict; }))
      return verdict;
  return differences.empty() ? Verdict::not_tested : Verdict::held;
}

// The rows compared for one claim in one arm at one number of demonstrations: a family of tests.
void judge_orderings(std::vector<ClaimedDifference>& family) {
  std::vector<double> p;
  for (const ClaimedDifference& d : family)
    if (d.change) p.push_back(d.change->p);
  const std::vector<double> adjusted = holm(p);
  std::size_t tested = 0;
  for (ClaimedDifference& d : family) {
    if (!d.change) continue;
    d.p_holm = adjusted[tested++];
    const bool beyond_chance = d.p_holm <= refuse_up_to;
    d.verdict = beyond_chance && d.change->interval.low > 0    ? Verdict::held
                : beyond_chance && d.change->interval.high < 0 ? Verdict::reversed
                                                               : Verdict::undecided;
  }
}

// All must be equivalent, so none needs a correction for the others (intersection-union).
void judge_equivalence(ClaimedDifference& d) {
  if (!d.change) return;
  const Interval& i = d.change->interval;
  d.p_holm = d.change->p;
  d.verdict = i.low > -margin && i.high < margin   ? Verdict::held
              : i.low > margin || i.high < -margin ? Verdict::reversed
                                                   : Verdict::undecided;
}

void conclude(Claim& claim) {
  claim.verdict = worst(claim.differences);
  if (claim.verdict != Verdict::not_tested || !claim.reason.empty()) return;
  std::vector<std::string> reasons;
  for (const ClaimedDifference& d : claim.differences)
    if (!d.reason.empty() && std::find(reasons.begin(), reasons.end(), d.reason) == reasons.end())
      reasons.push_back(d.reason);
  claim.reason = reasons.empty() ? "no method's cell has been played" : fmt::format("{}", fmt::join(reasons, "; "));
}

using Baselines = std::function<std::vector<std::string>(const std::string& arm, int n)>;

void test_orderings(Claim& claim, const Field& field, const std::vector<std::string>& arms,
                    const std::vector<std::string>& above, const Baselines& baselines) {
  for (const std::string& arm : arms)
    for (const int n : field.demonstrations) {
      std::vector<ClaimedDifference> family;
      for (const std::string& row : above)
        for (const std::string& baseline : baselines(arm, n))
          family.push_back(measured(field, claim.id, row, baseline, arm, n));
      judge_orderings(family);
      claim.differences.insert(claim.differences.end(), family.begin(), family.end());
    }
  conclude(claim);
}

// GCBC-DART, and of LGA-L's two rows the one that did better; both rows where one is missing, which then says so.
std::vector<std::string> shifted_baselines(const Field& field, const std::string& arm, int n) {
  const std::vector<std::string> rows{"lga_l", "lga_l+image=rgb"};
  std::vector<double> success;
  for (const std::string& row : rows)
    if (const Field::Policies* policies = field.find(row, n)) {
      PairedRow itself;
      for (const auto& [which, people] : *policies)
        for (const auto& [participant, cell] : people)
          if (!cell->failed && has_arm(*cell, arm))
            itself.add(which.first, pair_policies(*cell, *cell, arm), participant);
      if (itself.policies() > 0) success.push_back(itself.first_success());
    }
  if (success.size() < rows.size()) return {"gcbc_dart", rows[0], rows[1]};
  return {"gcbc_dart", success[1] > success[0] ? rows[1] : rows[0]};
}

// Arms that give only commands without demonstrations.
std::vector<std::string> unseen_arms(const Field& field) {
  std::vector<std::string> unseen;
  for (const std::string& arm : field.arms) {
    bool seen = false;
    for (const auto& [row, by_number] : field.rows)
      for (const auto& [n, policies] : by_number)
        for (const auto& [which, people] : policies)
          for (const auto& [participant, cell] : people)
            if (!cell->failed && has_arm(*cell, arm))
              for (const PlayedEpisode& e : cell->episodes.at(arm)) seen = seen || cell->commands[e.command].seen;
    if (!seen) unseen.push_back(arm);
  }
  return unseen;
}

bool from_people(const CellResult& cell) {
  return std::all_of(cell.commands.begin(), cell.commands.end(), [&cell](const CommandResult& command) {
    return cell.failed || command.selection.value("provenance", "") == "human";
  });
}

// Whether people made every Selection of the row human.
bool people_selected(const Field& field, int n) {
  const Field::Policies* policies = field.find("human", n);
  return policies && std::all_of(policies->begin(), policies->end(), [](const auto& item) {
           return std::all_of(item.second.begin(), item.second.end(),
                              [](const auto& one) { return from_people(*one.second); });
         });
}

void test_equivalence(Claim& claim, const Field& field) {
  constexpr int n = 50;
  if (people_selected(field, n))
    for (const std::string& arm : field.arms) {
      claim.differences.push_back(measured(field, claim.id, "lga", "human", arm, n));
      judge_equivalence(claim.differences.back());
    }
  if (claim.differences.empty()) claim.reason = "no human data at 50 demonstrations";
  conclude(claim);
}

// Of each participant, the seconds that each command took; one command has one answer, however many cells it is in.
using Seconds = std::map<std::string, std::map<std::pair<std::string, std::string>, double>>;
Seconds seconds_of(const Field& field, const std::string& method) {
  Seconds seconds;
  for (const auto& [row, by_number] : field.rows) {
    if (row.substr(0, row.find('+')) != method) continue;  // what is learned from an answer takes the person no time
    for (const auto& [n, policies] : by_number)
      for (const auto& [which, people] : policies)
        for (const auto& [participant, cell] : people)
          if (!participant.empty() && !cell->failed)
            for (const CommandResult& command : cell->commands)
              seconds[participant][{which.first, command.utterance}] =
                  command.selection.at("cost").at("human_seconds").get<double>();
  }
  return seconds;
}

// Seconds a command, of each participant on the mean over those that they answered in both ways.
void test_seconds(Claim& claim, const Field& field) {
  const Seconds human = seconds_of(field, "human"), edited = seconds_of(field, "lga_hill");
  ClaimedDifference d;
  d.above = "human", d.below = "lga_hill", d.unit = "seconds";
  std::vector<double> differences;
  std::set<std::string> scenarios;
  for (const auto& [participant, commands] : human) {
    const auto other = edited.find(participant);
    if (other == edited.end()) continue;
    double sum = 0;
    int both = 0;
    for (const auto& [command, s] : commands)
      if (const auto same = other->second.find(command); same != other->second.end()) {
        sum += s - same->second;
        ++both;
        scenarios.insert(command.first);
      }
    if (both > 0) differences.push_back(sum / both);
  }
  if (human.empty() || edited.empty()) {
    claim.reason = "no human data";
  } else {
    d.participants = static_cast<int>(differences.size());
    d.scenarios = static_cast<int>(scenarios.size());
    if (differences.size() < 2)
      d.reason = fmt::format("{} participants answered a command in both ways, expected 2 or more", differences.size());
    else
      d.change = paired_t(differences);
    claim.differences = {d};
    judge_orderings(claim.differences);
  }
  conclude(claim);
}

// All but the first, which is what the others are compared with: nothing shifts there.
std::vector<std::string> shifted_arms(const Field& field) {
  return field.arms.empty() ? field.arms : std::vector<std::string>(field.arms.begin() + 1, field.arms.end());
}

std::vector<Claim> test_field(const std::string& suite, const Field& field) {
  const auto claim = [&field](const char* id, const char* statement) {
    return Claim{id, statement, field.layout, field.engine, Verdict::not_tested, "", {}};
  };
  Claim c1 = claim("C1", "LGA above GCBC-SEG and GCBC-DART, at every number of demonstrations"),
        c2 = claim("C2", "LGA within 0.10 of Human at 50 demonstrations"),
        c3 = claim("C3",
                   "LGA and LGA-S above GCBC-DART and the better LGA-L under covariate shift, in each shifted arm"),
        c4 = claim("C4", "LGA and LGA-S above GCBC-DART and the better LGA-L on unseen commands"),
        c5 = claim("C5", "LGA-HILL takes people fewer seconds than Human");
  const Baselines shifted = [&field](const std::string& arm, int n) { return shifted_baselines(field, arm, n); };
  const auto needs = [&suite](Claim& c, const char* wanted) {
    if (suite == wanted) return true;
    c.reason = fmt::format("needs a run of suite {}", wanted);
    return false;
  };
  if (needs(c1, "q1"))
    test_orderings(c1, field, field.arms, {"lga"}, [](const std::string&, int) {
      return std::vector<std::string>{"gcbc_seg", "gcbc_dart"};
    });
  if (needs(c2, "q1")) test_equivalence(c2, field);
  if (needs(c3, "q2")) test_orderings(c3, field, shifted_arms(field), {"lga", "lga_s"}, shifted);
  if (needs(c4, "q3")) test_orderings(c4, field, unseen_arms(field), {"lga", "lga_s"}, shifted);
  test_seconds(c5, field);
  return {c1, c2, c3, c4, c5};
}

}  // namespace

std::string to_string(Verdict verdict) {
  constexpr const char* words[] = {"held", "reversed", "undecided", "not tested"};
  return words[static_cast<int>(verdict)];
}

std::vector<Claim> test_claims(const RunResults& run) {
  std::map<std::pair<std::string, std::string>, Field> fields;
  for (const CellResult& cell : run.cells) {
    Field& field = fields[{cell.layout, cell.engine}];
    field.layout = cell.layout;
    field.engine = cell.engine;
    if (cell.is_reference()) continue;
    for (const std::string& arm : cell.arms)
      if (std::find(field.arms.begin(), field.arms.end(), arm) == field.arms.end()) field.arms.push_back(arm);
    field.demonstrations.insert(cell.demonstrations);
    field.rows[cell.method][cell.demonstrations][{cell.scenario, cell.training_seed}][cell.participant] = &cell;
  }
  std::vector<Claim> claims;
  for (const auto& item : fields)
    for (Claim& claim : test_field(run.suite, item.second)) claims.push_back(std::move(claim));
  return claims;
}

}  // namespace lgabench::report
