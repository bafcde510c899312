#include <lgabench/report/paper.hpp>

#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench::report {

PaperValues paper_values(const std::string& suite) {
  PaperValues values;
  if (suite != "q1") return values;
  const fs::path file = data_directory() / "paper" / "reference_results.json";
  const Json json = read_json(file);
  const JsonReader figure = JsonReader(json, file.string()).at("figure_3a_success_vs_demonstrations");
  const auto demonstrations = figure.at("demonstrations").elements();
  for (const auto& item : figure.json().items()) {
    if (item.key() == "demonstrations") continue;
    const JsonReader means = figure.at(item.key()).at("mean");
    const auto rates = means.elements();
    if (rates.size() != demonstrations.size()) means.fail("a value for each number of demonstrations");
    for (std::size_t i = 0; i < rates.size(); ++i)
      values[item.key()][static_cast<int>(demonstrations[i].integer(1, 1000000))] = rates[i].number();
  }
  return values;
}

}  // namespace lgabench::report
