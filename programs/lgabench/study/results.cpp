#include <lgabench/study/results.hpp>

#include <algorithm>
#include <cmath>

namespace lgabench::study {
namespace {

SetQuality quality_of(const StudyResults& results, Condition condition) {
  std::vector<Quality> all;
  for (const PersonResult& person : results.people)
    for (const Trial* trial : person.counted[index(condition)]) {
      if (!person.excluded.empty()) continue;
      Selection selection = trial->selection;
      selection.provenance = Provenance::human;
      all.push_back(quality(selection, *trial->item->truth));
    }
  return mean_quality(all)["target"];
}

std::vector<CommandResult> commands_of(const StudyResults& results) {
  std::vector<CommandResult> all;
  const Protocol& protocol = *results.record->protocol;
  std::vector<const std::vector<Item>*> lists;
  for (const auto& set : protocol.sets) lists.push_back(&set);
  lists.push_back(&protocol.spares);
  for (const auto* items : lists) {
    for (const Item& item : *items) {
      CommandResult command;
      command.item = &item;
      std::vector<double> differences;
      for (const PersonResult& person : results.people) {
        if (!person.excluded.empty()) continue;
        std::array<std::optional<double>, 2> s;
        for (const Condition condition : conditions)
          for (const Trial* trial : person.counted[index(condition)])
            if (trial->item == &item) s[index(condition)] = trial->raw_s;
        for (const std::size_t c : {0, 1})
          if (s[c]) command.seconds[c].push_back(*s[c]);
        if (s[0] && s[1]) differences.push_back(*s[0] - *s[1]);
      }
      if (!protocol.crossover() && differences.size() >= 2) command.change = statistics::paired_t(differences);
      if (protocol.crossover() && command.seconds[0].size() >= 2 && command.seconds[1].size() >= 2)
        command.change = statistics::welch_t(command.seconds[0], command.seconds[1]);
      all.push_back(std::move(command));
    }
  }
  std::vector<double> p;
  for (const CommandResult& command : all)
    if (command.change) p.push_back(command.change->p);
  const std::vector<double> adjusted = statistics::holm(p);
  std::size_t next = 0;
  for (CommandResult& command : all)
    if (command.change) command.p_holm = adjusted[next++];
  return all;
}

std::vector<ScaleResult> tlx_of(const StudyResults& results) {
  std::vector<ScaleResult> all;
  if (results.record->protocol->tlx != Tlx::by_condition) return all;
  for (const char* scale : {"raw", "mental", "physical", "temporal", "performance", "effort", "frustration"})
    all.push_back({scale, {}, {}});
  for (const PersonResult& person : results.people) {
    if (!person.excluded.empty()) continue;
    const Json& human = person.session->tlx(Condition::human);
    const Json& edited = person.session->tlx(Condition::lga_hill);
    if (human.is_null() || edited.is_null()) continue;
    std::array<double, 2> sums{};
    std::size_t answered = 0;
    for (std::size_t i = 1; i < all.size(); ++i) {
      const Json &before = human.at(all[i].scale), &after = edited.at(all[i].scale);
      if (before.is_null() || after.is_null()) continue;
      all[i].values[0].push_back(before);
      all[i].values[1].push_back(after);
      sums[0] += all[i].values[0].back();
      sums[1] += all[i].values[1].back();
      ++answered;
    }
    if (answered + 1 != all.size()) continue;
    for (const std::size_t c : {0, 1}) all[0].values[c].push_back(sums[c] / static_cast<double>(answered));
  }
  std::vector<double> p;
  for (ScaleResult& row : all) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < row.values[0].size(); ++i) differences.push_back(row.values[0][i] - row.values[1][i]);
    if (differences.size() < 2) continue;
    row.change = statistics::paired_t(differences);
    p.push_back(row.change->p);
  }
  const std::vector<double> adjusted = statistics::holm(p);
  std::size_t next = 0;
  for (ScaleResult& row : all)
    if (row.change) row.p_holm = adjusted[next++];
  return all;
}

void count_pairs(StudyResults& results) {
  std::vector<double> p;
  std::vector<std::vector<int>> units;
  for (const Item& item : results.record->protocol->sets[0])
    for (std::size_t i = 0; i < item.pairs.size(); ++i) {
      PairResult pair{&item, &item.pairs[i]};
      for (const PersonResult& person : results.people)
        for (const Trial* trial : person.counted[index(Condition::human)])
          if (trial->item == &item && person.excluded.empty()) ++pair.said[static_cast<std::size_t>(trial->answers[i])];
      if (!pair.pair->settled && pair.people() > 0) p.push_back(p_unsettled(pair.said));
      if (!pair.pair->settled) units.emplace_back(pair.said.begin(), pair.said.end());
      results.pairs.push_back(pair);
    }
  const std::vector<double> adjusted = statistics::holm(p);
  std::size_t next = 0;
  for (PairResult& pair : results.pairs)
    if (!pair.pair->settled && pair.people() > 0) pair.p_holm = adjusted[next++];
  results.agreement = krippendorff_alpha(units);
}

// Mean log seconds of a period's trials that count.
double mean_log(const PersonResult& person, int period) {
  double sum = 0;
  int n = 0;
  for (const auto& trials : person.counted)
    for (const Trial* trial : trials)
      if (trial->period == period) {
        sum += std::log(trial->raw_s);
        ++n;
      }
  return sum / n;
}

void count_trials(StudyResults& results, const PersonResult& person) {
  constexpr double apart_s = 2;
  const Protocol& protocol = *results.record->protocol;
  for (const Trial& trial : person.session->all()) {
    if (trial.practice) {
      ++results.practice;
      continue;
    }
    results.interrupted += trial.state == Trial::interrupted;
    results.too_long += trial.state == Trial::finished && !counts(protocol, trial);
    if (trial.state != Trial::finished) continue;
    results.disagree += !trial.edits_agree;
    results.clocks_apart += !person.session->simulated() && std::abs(trial.server_s - trial.raw_s) > apart_s;
  }
}

void compare(StudyResults& results) {
  std::array<std::vector<double>, 2> raw, active, by_first;
  std::vector<double> differences, active_differences;
  std::vector<CrossoverPerson> crossed;
  for (const PersonResult& person : results.people) {
    if (!person.excluded.empty()) continue;
    for (const Condition condition : conditions) {
      raw[index(condition)].push_back(person.mean_s(condition));
      active[index(condition)].push_back(person.mean_s(condition, &Trial::active_s));
    }
    differences.push_back(raw[0].back() - raw[1].back());
    active_differences.push_back(active[0].back() - active[1].back());
    const Assignment& assignment = person.session->assignment();
    by_first[index(assignment.conditions[0])].push_back(differences.back());
    crossed.push_back({assignment.conditions[0] == Condition::human, assignment.sets[0] == 0,
                       mean_log(person, 0) - mean_log(person, 1)});
  }
  for (const std::size_t c : {0, 1}) {
    if (!raw[c].empty()) {
      results.seconds[c] = statistics::spread(raw[c]);
      results.active_s[c] = statistics::spread(active[c]);
    }
    if (!by_first[c].empty()) results.by_first[c] = statistics::spread(by_first[c]);
  }
  if (differences.size() >= 2) {
    results.primary = statistics::paired_t(differences);
    results.active = statistics::paired_t(active_differences);
  }
  if (results.record->protocol->crossover()) results.log_model = crossover_model(crossed);
}

}  // namespace

double PersonResult::mean_s(Condition condition, double Trial::*seconds) const {
  double sum = 0;
  for (const Trial* trial : counted[index(condition)]) sum += trial->*seconds;
  return sum / static_cast<double>(counted[index(condition)].size());
}

int StudyResults::used() const {
  return static_cast<int>(
      std::count_if(people.begin(), people.end(), [](const PersonResult& p) { return p.excluded.empty(); }));
}

std::vector<statistics::Change> crossover_model(const std::vector<CrossoverPerson>& people) {
  std::vector<std::vector<double>> rows;
  std::vector<double> differences;
  for (const CrossoverPerson& person : people) {
    rows.push_back({person.human_first ? 1. : -1., 1, person.first_set_first ? 1. : -1.});
    differences.push_back(person.difference);
  }
  return statistics::least_squares(rows, differences);
}

StudyResults results_of(const Record& record) {
  StudyResults results;
  results.record = &record;
  for (const Session& session : record.people) {
    PersonResult person;
    person.session = &session;
    for (const Trial& trial : session.all())
      if (counts(*record.protocol, trial)) person.counted[index(trial.condition)].push_back(&trial);
    person.excluded = why_left_out(*record.protocol, session);
    count_trials(results, person);
    results.people.push_back(std::move(person));
  }
  if (record.protocol->of_pairs()) {
    count_pairs(results);
    return results;
  }
  compare(results);
  results.commands = commands_of(results);
  results.tlx = tlx_of(results);
  for (const Condition condition : conditions) results.phi[index(condition)] = quality_of(results, condition);
  return results;
}

}  // namespace lgabench::study
