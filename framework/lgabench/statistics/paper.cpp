#include <lgabench/statistics/paper.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/statistics/summary.hpp>

namespace lgabench::statistics {
namespace {

constexpr long long most_demonstrations = 1000000;

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
      const auto n = static_cast<int>(demonstrations[i].integer(1, most_demonstrations));
      values.rates[mean_scenario][item.key()][n] = means[i];
      values.errors[mean_scenario][item.key()][n] = errors[i];
    }
  }
}

// `ids`: our scenarios in the order of the figure's list.
void read_bars(const JsonReader& figure, const std::vector<std::string>& ids, int demonstrations, PaperValues& values) {
  for (const auto& item : figure.json().items()) {
    if (item.key() == "scenarios") continue;
    const std::vector<double> bars = rates(figure.at(item.key()), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) values.rates[ids[i]][item.key()][demonstrations] = bars[i];
  }
}

int demonstrations_of(const JsonReader& entry) {
  return static_cast<int>(entry.at("demonstrations").integer(1, most_demonstrations));
}

// The place of a member's value among `words`.
template <typename Enum, std::size_t n>
Enum choice(const JsonReader& value, const std::array<const char*, n>& words) {
  const auto found = std::find(words.begin(), words.end(), value.string());
  if (found == words.end()) value.fail(fmt::format("{}", fmt::join(words, ", ")));
  return static_cast<Enum>(found - words.begin());
}

std::vector<ClaimedMethod> read_methods(const JsonReader& list) {
  std::vector<ClaimedMethod> all;
  for (const std::string& row : list.strings()) {
    const std::vector<std::string> words = row_words(row);
    if (std::any_of(words.begin() + 1, words.end(), [](const auto& word) { return word.find('=') == word.npos; }))
      list.fail("rows: ID+OPTION=VALUE");
    all.push_back(claimed_method(row));
  }
  if (all.empty()) list.fail("a row or more");
  return all;
}

PaperClaim read_claim(const JsonReader& entry) {
  using Test = PaperClaim::Test;
  PaperClaim claim;
  claim.id = entry.at("id").string();
  claim.statement = entry.at("statement").string();
  if (entry.has("suite")) claim.suite = entry.at("suite").string();
  claim.test = choice<Test>(entry.at("test"), std::array{"ordering", "equivalence", "seconds"});
  claim.above = read_methods(entry.at("above"));
  claim.below = read_methods(entry.at("below"));
  if (claim.test != Test::ordering && claim.above.size() + claim.below.size() != 2)
    entry.fail("one row above and one below");
  if (claim.test == Test::seconds) return claim;
  claim.arms = choice<PaperClaim::Arms>(entry.at("arms"), std::array{"all", "shifted", "unseen"});
  if (entry.has("demonstrations")) claim.demonstrations = demonstrations_of(entry);
  if (claim.test == Test::equivalence) claim.margin = entry.at("margin").number();
  return claim;
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
  const fs::path folder = data_directory() / "paper", file = folder / "claims.json";
  const Json json = read_json(file);
  for (const JsonReader& entry : JsonReader(json, file.string()).at("figures").elements()) {
    if (entry.at("suite").string() != suite) continue;
    const fs::path published_file = folder / "reference_results.json";
    const Json published = read_json(published_file);
    const JsonReader reader(published, published_file.string());
    values.figure = entry.at("figure").string();
    values.title = entry.at("title").string();
    if (entry.has("near")) values.near = entry.at("near").strings();
    if (entry.has("curves"))
      read_curves(reader.at(entry.at("curves").string()), values);
    else
      read_bars(reader.at(entry.at("bars").string()), entry.at("scenarios").strings(), demonstrations_of(entry),
                values);
  }
  return values;
}

std::string ClaimedMethod::text() const {
  std::string text = id;
  for (const auto& [option, value] : options)
    text += fmt::format("{}{}={}", text == id ? " with " : ", ", option, value);
  return text;
}

ClaimedMethod claimed_method(const std::string& row) {
  const std::vector<std::string> words = row_words(row);
  ClaimedMethod method{words.front()};
  for (std::size_t i = 1; i < words.size(); ++i)
    method.options[words[i].substr(0, words[i].find('='))] = words[i].substr(words[i].find('=') + 1);
  return method;
}

std::vector<PaperClaim> paper_claims() {
  const fs::path file = data_directory() / "paper" / "claims.json";
  const Json json = read_json(file);
  std::vector<PaperClaim> all;
  for (const JsonReader& entry : JsonReader(json, file.string()).at("claims").elements())
    all.push_back(read_claim(entry));
  return all;
}

}  // namespace lgabench::statistics
