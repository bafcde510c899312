#include <lgabench/harness/costs.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>

namespace lgabench {
namespace {

constexpr double network_plain = .83;     // beside batch normalisation (docs/performance.md)
constexpr double heat_map_s = .22;        // of a sample of its batches, of which there are as many for any data
constexpr double start_s = .1;            // processes, plugins, files
constexpr double demonstration_s = .001;  // clean; from the cache
constexpr double episode_s = .005;        // with the second try on the true mask

// Milliseconds of training for each demonstration and pass, of a method, or of any, with that value of an option; or
// for each of what the option `counts` says.
struct Entry {
  std::string method, option;
  Json value;
  double learn_ms;
  std::string counts;
};
struct Table {
  std::vector<Entry> entries;  // the first that fits a cell counts
  Entry others;                // of the method that others are taken for
};

const Table& measured() {
  static const Table table = [] {
    const fs::path file = data_directory() / "measured" / "costs.json";
    const Json json = read_json(file);
    const JsonReader reader(json, file.string());
    Table all;
    for (const JsonReader& entry : reader.at("entries").elements())
      all.entries.push_back({entry.at("method").string(), entry.has("option") ? entry.at("option").string() : "",
                             entry.has("value") ? entry.at("value").json() : Json(), entry.at("learn_ms").number(),
                             entry.has("counts") ? entry.at("counts").string() : ""});
    const JsonReader others = reader.at("others");
    all.others = {others.at("taken_for").string(), "", Json(), others.at("learn_ms").number(), ""};
    return all;
  }();
  return table;
}

bool fits(const Entry& entry, const Cell& cell) {
  const Json& options = cell.method.options;
  return (entry.method == "*" || entry.method == cell.method.id) &&
         (entry.option.empty() || (options.contains(entry.option) && options.at(entry.option) == entry.value));
}

// The entry that counts for a method's cell; none for a method that was not measured.
const Entry* entry_of(const Cell& cell) {
  const std::vector<Entry>& all = measured().entries;
  const auto entry = std::find_if(all.begin(), all.end(), [&](const Entry& e) { return fits(e, cell); });
  return entry == all.end() ? nullptr : &*entry;
}

// Elements of a scenario's list; 1 where a test's scenario has none.
double count(const Json& scenario, const char* list, bool (*counts)(const Json&)) {
  const auto all = scenario.find(list);
  const std::ptrdiff_t counted = all == scenario.end() ? 0 : std::count_if(all->begin(), all->end(), counts);
  return static_cast<double>(std::max<std::ptrdiff_t>(1, counted));
}

double demonstrations_of(const Cell& cell) {
  return cell.demonstrations * count(*cell.scenario, "commands",
                                     [](const Json& c) { return !c.is_object() || c.value("seen", Json()) != false; });
}

// Of an episode, on average: one of several steps may end after any.
double steps_of(const Cell& cell) {
  const std::string task = cell.scenario->at("task");
  return (find_task(find_environment(cell.environment), task).most_steps + 1) / 2.;
}

}  // namespace

std::string measured_on(const Cell& cell) {
  return cell.method.is_reference() || entry_of(cell) ? "" : measured().others.method;
}

double usual_seconds(const Cell& cell) {
  const Entry* const entry = entry_of(cell);
  const Json& options = cell.method.acts ? cell.method.acts->options : cell.method.options;
  double learn_ms = cell.method.is_reference() ? 0 : (entry ? *entry : measured().others).learn_ms;
  if (options.value("network", Json()) == "plain") learn_ms *= network_plain;
  const Json epochs = options.value("epochs", Json(750));
  const double passes = epochs.is_number() ? epochs.get<double>() : 750;
  const double demonstrations = demonstrations_of(cell);
  if (options.value("policy", Json()) == "heat_map")
    return least_seconds(cell) + heat_map_s * std::min(demonstrations, 16.);
  const bool counted = entry && !entry->counts.empty();
  return least_seconds(cell) + (counted ? options.value(entry->counts, 0.) : demonstrations * passes) * learn_ms / 1000;
}

double least_seconds(const Cell& cell) {
  const double episodes = cell.episodes * count(*cell.scenario, cell.scenario->contains("played") ? "played" : "tests",
                                                [](const Json&) { return true; });
  return start_s + steps_of(cell) * (demonstrations_of(cell) * demonstration_s + episodes * episode_s);
}

void Costs::learn(const Cell& cell, double seconds) {
  const double usual = usual_seconds(cell);
  for (Sum* sum : {&rows_[cell.method.name], &all_}) {
    sum->seconds += seconds;
    sum->usual += usual;
  }
}

double Costs::expected_seconds(const std::string& row, double usual) const {
  const auto known = rows_.find(row);
  const Sum& like = known == rows_.end() ? all_ : known->second;
  return like.usual > 0 ? usual * like.seconds / like.usual : usual;
}

}  // namespace lgabench
