#include <lgabench/statistics/claims_field.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/contains.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/statistics/paired.hpp>
#include <lgabench/statistics/pairs.hpp>

namespace lgabench::statistics {
namespace {

constexpr std::size_t scenarios_needed = 6;  // for a test over scenarios

// The policy based on the participant's answers, or the one based on nobody's; nullptr where it did not
// finish.
const CellResult* finished(const Field::People& people, const std::string& participant) {
  auto it = people.find(participant);
  if (it == people.end()) it = people.find("");
  return it == people.end() || it->second->failed ? nullptr : it->second;
}

// Whose answers the one or the other of two rows is based on; "" alone where both are based on nobody's.
std::set<std::string> participants(const Field::People& one, const Field::People& other) {
  std::set<std::string> names;
  for (const Field::People* people : {&one, &other})
    for (const auto& item : *people) names.insert(item.first);
  if (names.size() > 1) names.erase("");
  return names;
}

// A method's option, or an error that was made in what it selected.
Json value_of(const CellResult& cell, const std::string& option) {
  if (cell.options.contains(option)) return cell.options.at(option);
  if (option == "missing") return cell.configuration.selection_errors.missing;
  if (option == "added") return cell.configuration.selection_errors.added;
  if (option == "names") return cell.configuration.reading.names;
  if (option == "segments") return cell.configuration.reading.segments;
  return nullptr;
}

bool is_method(const CellResult& cell, const ClaimedMethod& method) {
  if (cell.id != method.id) return false;
  for (const auto& [option, text] : method.options) {
    const Json value = value_of(cell, option), wanted = json_or_null(text);
    if (value.is_null() || (option_text(value) != text && !(value.is_number() && value == wanted))) return false;
  }
  const std::vector<std::string> words = row_words(cell.method);  // the id, then the options that the row's name tells
  return std::all_of(words.begin() + 1, words.end(), [&method](const std::string& word) {
    return method.options.count(word.substr(0, word.find('='))) != 0;
  });
}

// Student's t on the scenarios' differences.
Tested over_scenarios(const std::vector<std::pair<std::string, double>>& by_scenario) {
  Tested tested;
  if (by_scenario.size() < scenarios_needed) {
    tested.reason = "none, six needed";
    return tested;
  }
  std::vector<double> differences;
  for (const auto& item : by_scenario) differences.push_back(item.second);
  tested.change = paired_t(differences);
  return tested;
}

// What pairs of policies come to, where a difference of 1 stands for `reach`.
void sum_up(ClaimedDifference& d, const PairedRow& pairs, const std::set<long long>& seeds, const std::string& stream,
            double reach = 1) {
  d.by_scenario = pairs.by_scenario();
  for (auto& item : d.by_scenario) item.second *= reach;
  d.scenarios = pairs.scenarios();
  d.scenes = pairs.scenes();
  d.seeds = static_cast<int>(seeds.size());
  d.policies = pairs.policies();
  d.participants = pairs.participants();
  Change& change = d.these.change.emplace(pairs.change(stream));
  change.difference *= reach;
  change.interval.low *= reach;
  change.interval.high *= reach;
  d.alike = over_scenarios(d.by_scenario);
}

}  // namespace

void Field::add(const CellResult& cell) {
  layout = cell.layout;
  engine = cell.engine;
  if (cell.is_reference()) return;
  if (cell.rehearsal) rehearsal = true;
  for (const std::string& arm : cell.arms_in_means())
    if (!contains(arms, arm)) arms.push_back(arm);
  demonstrations.insert(cell.demonstrations);
  rows[cell.method][cell.demonstrations][{cell.scenario, cell.training_seed}][cell.participant] = &cell;
}

const Field::Policies* Field::find(const std::string& row, int n) const {
  const auto by_number = rows.find(row);
  if (by_number == rows.end()) return nullptr;
  const auto policies = by_number->second.find(n);
  return policies == by_number->second.end() ? nullptr : &policies->second;
}

std::vector<const CellResult*> Field::cells() const {
  std::vector<const CellResult*> all;
  for (const auto& [row, by_number] : rows)
    for (const auto& [n, policies] : by_number)
      for (const auto& [which, people] : policies)
        for (const auto& [participant, cell] : people) all.push_back(cell);
  return all;
}

std::string find_row(const Field& field, const ClaimedMethod& method) {
  for (const auto& [row, by_number] : field.rows)
    for (const auto& [n, policies] : by_number)
      for (const auto& [which, people] : policies)
        if (is_method(*people.begin()->second, method)) return row;
  return "";
}

bool has_arm(const CellResult& cell, const std::string& arm) {
  const std::vector<std::string> arms = cell.arms_in_means();
  return contains(arms, arm);
}

ClaimedDifference measured(const Field& field, const std::string& claim, const ClaimedMethod& above,
                           const ClaimedMethod& below, const std::string& arm, int n, bool paired) {
  ClaimedDifference missing;
  missing.arm = arm;
  missing.demonstrations = n;
  if (paired) missing.unit = paired_unit;
  for (const auto& [row, method] : {std::pair(&missing.above, &above), {&missing.below, &below}}) {
    *row = find_row(field, *method);
    const bool found = field.find(*row, n) != nullptr;
    if (row->empty()) *row = method->id;  // another row may have that very name
    if (!found && missing.these.reason.empty()) missing.these.reason = fmt::format("no row {}", method->text());
  }
  missing.alike.reason = missing.these.reason;
  return missing.these.reason.empty() ? measured_rows(field, claim, missing.above, missing.below, arm, n, paired)
                                      : missing;
}

ClaimedDifference measured_rows(const Field& field, const std::string& claim, const std::string& above,
                                const std::string& below, const std::string& arm, int n, bool paired) {
  ClaimedDifference d;
  d.above = above;
  d.below = below;
  d.arm = arm;
  d.demonstrations = n;
  if (paired) d.unit = paired_unit;
  const Field::Policies &high = *field.find(d.above, n), &low = *field.find(d.below, n);
  Field::Policies all = high;
  all.insert(low.begin(), low.end());
  PairedRow pairs;
  BothRows both;
  std::set<long long> seeds;
  int wanted = 0;
  const auto people = [](const Field::Policies& row, const Field::Policies::key_type& which) {
    const auto found = row.find(which);
    return found == row.end() ? Field::People() : found->second;
  };
  // People are asked about some commands: a scenario that they were never asked about is not compared.
  const auto asked = [](const Field::Policies& row, const std::string& scenario) {
    bool people_of_row = false, here = false;
    for (const auto& [which, whose] : row) {
      people_of_row = people_of_row || whose.rbegin()->first != "";
      here = here || which.first == scenario;
    }
    return here || !people_of_row;
  };
  for (const auto& item : all) {
    if (!asked(low, item.first.first) || !asked(high, item.first.first)) continue;
    if (!has_arm(*item.second.begin()->second, arm)) continue;
    const Field::People a = people(low, item.first), b = people(high, item.first);
    for (const std::string& participant : participants(a, b)) {
      ++wanted;
      const CellResult *first = finished(a, participant), *second = finished(b, participant);
      if (!first || !second) continue;
      pairs.add(item.first.first, pair_policies(*first, *second, arm), participant);
      auto& [firsts, seconds] = both[{item.first.second, participant}];
      firsts.push_back(first);
      seconds.push_back(second);
    }
    seeds.insert(item.first.second);
  }
  if (pairs.policies() < wanted || wanted == 0) {
    d.these.reason = d.alike.reason = fmt::format("{} of {} policies finished in both rows", pairs.policies(), wanted);
    return d;
  }
  if (paired) pairs = both_on_pairs(both, arm);
  if (pairs.policies() == 0) {
    d.these.reason = d.alike.reason = fmt::format("no pairs of scenes in arm {}", arm);
    return d;
  }
  sum_up(d, pairs, seeds,
         fmt::format("claims{}/{}/{}/{}/{}/{}/{}/{}", paired ? "/paired" : "", claim, field.layout, field.engine,
                     d.above, d.below, arm, n));
  return d;
}

ClaimedDifference measured_slope(const Field& field, const SuiteClaim& claim, const std::string& arm, int n) {
  constexpr double per = .1;
  ClaimedDifference d;
  d.above = claim.above;
  d.below = claim.below;
  d.arm = arm;
  d.demonstrations = n;
  d.unit = fmt::format("success per {} of {}", per, claim.option);
  std::vector<double> weights = slope_weights(claim.levels);
  double reach = 0;
  for (double& weight : weights) reach += std::abs(weight *= per);  // the most that the two can differ by

  std::vector<const Field::Policies*> above, below;  // of each level
  for (const auto& [row, levels] : {std::pair(claim.above, &above), {claim.below, &below}})
    for (const double level : claim.levels) {
      ClaimedMethod method = claimed_method(row);
      method.options[claim.option] = fmt::format("{}", level);
      levels->push_back(field.find(find_row(field, method), n));
      if (!levels->back() && d.these.reason.empty()) d.these.reason = "no row " + method.text();
    }
  d.alike.reason = d.these.reason;
  if (!d.these.reason.empty()) return d;

  Field::Policies all;
  for (const auto* levels : {&above, &below})
    for (const Field::Policies* policies : *levels) all.insert(policies->begin(), policies->end());
  PairedRow pairs;
  std::set<long long> seeds;
  int wanted = 0;
  for (const auto& item : all) {
    if (!has_arm(*item.second.begin()->second, arm)) continue;
    ++wanted;
    seeds.insert(item.first.second);
    const auto cell = [&](const Field::Policies* policies) -> const CellResult* {
      const auto people = policies->find(item.first);
      return people == policies->end() ? nullptr : finished(people->second, "");
    };
    PolicyPair slopes;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const CellResult *first = cell(below[i]), *second = cell(above[i]), *of_all = cell(above.front());
      if (!first || !second || !of_all) break;
      pair_policies(*of_all, *second, arm);  // the same scenes at each level
      PolicyPair pair = pair_policies(*first, *second, arm);
      const std::vector<double> differences = pair.differences();
      if (i == 0) {
        slopes = pair;
        slopes.first.assign(differences.size(), 0);
        slopes.second = slopes.first;
      }
      for (std::size_t scene = 0; scene < differences.size(); ++scene)
        slopes.second[scene] += weights[i] * differences[scene] / reach;
      if (i + 1 == weights.size()) pairs.add(item.first.first, slopes);
    }
  }
  if (pairs.policies() < wanted || pairs.policies() < 2) {
    d.these.reason = d.alike.reason =
        pairs.policies() < wanted ? fmt::format("{} of {} policies finished at all levels", pairs.policies(), wanted)
                                  : "a slope needs two policies or more";
    return d;
  }
  sum_up(d, pairs, seeds, fmt::format("claims/{}/{}/{}/{}/{}", claim.id, field.layout, field.engine, arm, n), reach);
  return d;
}

}  // namespace lgabench::statistics
