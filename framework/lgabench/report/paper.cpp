#include <lgabench/report/paper.hpp>

#include <fmt/format.h>

#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/report/summary.hpp>

namespace lgabench::report {
namespace {

// The numbers of an array that must have `size`.
std::vector<double> rates(const JsonReader& list, std::size_t size) {
  std::vector<double> all;
  for (const JsonReader& rate : list.elements()) all.push_back(rate.number());
  if (all.size() != size) list.fail(fmt::format("{} numbers", size));
  return all;
}

void read_curves(const JsonReader& figure, PaperValues& values) {
  const auto demonstrations = figure.at("demonstrations").elements();
  for (const auto& item : figure.json().items()) {
    if (item.key() == "demonstrations") continue;
    const JsonReader curve = figure.at(item.key());
    const std::vector<double> means = rates(curve.at("mean"), demonstrations.size());
    const std::vector<double> errors = rates(curve.at("err"), demonstrations.size());
    for (std::size_t i = 0; i < means.size(); ++i) {
      const auto n = static_cast<int>(demonstrations[i].integer(1, 1000000));
      values.rates[mean_scenario][item.key()][n] = means[i];
      values.errors[mean_scenario][item.key()][n] = errors[i];
    }
  }
}

// `ids`: our scenarios in the order of the figure's list.
void read_bars(const JsonReader& figure, const std::vector<std::string>& ids, PaperValues& values) {
  constexpr int demonstrations = 50;  // section 4.2 and 4.3: "we train on 50 demonstrations"
  for (const auto& item : figure.json().items()) {
    if (item.key() == "scenarios") continue;
    const std::vector<double> bars = rates(figure.at(item.key()), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) values.rates[ids[i]][item.key()][demonstrations] = bars[i];
  }
}

std::optional<double> find_in(const PaperValues::Rates& rates, const std::string& scenario, const std::string& method,
                              int demonstrations) {
  const auto methods = rates.find(scenario);
  if (methods == rates.end()) return std::nullopt;
  const auto values = methods->second.find(method);
  if (values == methods->second.end()) return std::nullopt;
  const auto value = values->second.find(demonstrations);
  return value == values->second.end() ? std::nullopt : std::optional(value->second);
}

}  // namespace

std::optional<double> PaperValues::find(const std::string& scenario, const std::string& method,
                                        int demonstrations) const {
  return find_in(rates, scenario, method, demonstrations);
}

std::optional<double> PaperValues::error(const std::string& scenario, const std::string& method,
                                         int demonstrations) const {
  return find_in(errors, scenario, method, demonstrations);
}

PaperValues paper_values(const std::string& suite) {
  PaperValues values;
  if (suite != "q1" && suite != "q2" && suite != "q3") return values;
  const fs::path file = data_directory() / "paper" / "reference_results.json";
  const Json json = read_json(file);
  const JsonReader reader(json, file.string());
  if (suite == "q1") {
    values.figure = "3a";
    read_curves(reader.at("figure_3a_success_vs_demonstrations"), values);
  } else if (suite == "q2") {
    values.figure = "4a";
    read_bars(reader.at("figure_4a_observational_shift"), {"q2_heart", "q2_letter", "q2_bowl", "q2_block"}, values);
  } else {
    values.figure = "4b";
    read_bars(reader.at("figure_4b_linguistic_ambiguity"), {"q3_fruit", "q3_food", "q3_utensil"}, values);
  }
  return values;
}

}  // namespace lgabench::report
