#include <lgabench/harness/costs.hpp>

#include <algorithm>
#include <array>

namespace lgabench {
namespace {

// Milliseconds of training for each demonstration and pass, with two workers on two cores of an AMD EPYC (Zen 4). The
// first entry that fits a cell counts: that of its method, or of any, with that option.
struct Entry {
  const char *method, *option, *value;
  double learn_ms;
};
constexpr std::array<Entry, 15> table{{
    {"constant_action", "", "", 0},
    {"random_object", "", "", 0},
    {"oracle", "", "", 0},
    {"*", "policy", "centroid", 0},
    {"*", "picture", "rgb", .155},
    {"factorial", "input", "rgb", .155},
    {"gcbc_dart", "dart", "none", .155},
    {"gcbc_dart", "", "", .48},
    {"gcbc_seg", "", "", .155},
    {"lga_s", "", "", .145},
    {"lga_l", "", "", .085},
    {"lga", "", "", .065},
    {"lga_hill", "", "", .065},
    {"human", "", "", .065},
    {"factorial", "", "", .065},
}};
constexpr double other_learn_ms = .065;   // of a method that the table lacks
constexpr double network_plain = .83;     // beside batch normalisation (docs/performance.md)
constexpr double heat_map_s = .22;        // of a sample of its batches, of which there are as many for any data
constexpr double start_s = .1;            // processes, plugins, files
constexpr double demonstration_s = .001;  // clean; from the cache
constexpr double episode_s = .005;        // with the second try on the true mask

bool fits(const Entry& entry, const Cell& cell) {
  const std::string method = entry.method, option = entry.option;
  const Json& options = cell.method.options;
  return (method == "*" || method == cell.method.id) &&
         (option.empty() || (options.contains(option) && options.at(option) == entry.value));
}

// Elements of a scenario's list; 1 where a test's scenario has none.
double count(const Json& scenario, const char* list, bool (*counts)(const Json&)) {
  const Json all = scenario.is_object() ? scenario.value(list, Json::array()) : Json::array();
  return static_cast<double>(std::max<std::ptrdiff_t>(1, std::count_if(all.begin(), all.end(), counts)));
}

}  // namespace

double usual_seconds(const Cell& cell, bool* of_its_own) {
  const auto entry = std::find_if(table.begin(), table.end(), [&](const Entry& e) { return fits(e, cell); });
  if (of_its_own) *of_its_own = entry != table.end();
  const Json& options = cell.method.options;
  double learn_ms = entry == table.end() ? other_learn_ms : entry->learn_ms;
  if (options.value("network", Json()) == "plain") learn_ms *= network_plain;
  const Json epochs = options.value("epochs", Json(750));
  const double passes = epochs.is_number() ? epochs.get<double>() : 750;
  const double demonstrations = cell.demonstrations * count(cell.scenario, "commands", [](const Json& c) {
                                  return !c.is_object() || c.value("seen", Json()) != false;
                                });
  const double episodes = cell.episodes * count(cell.scenario, "tests", [](const Json&) { return true; });
  const double learn_s = options.value("policy", Json()) == "heat_map" ? heat_map_s * std::min(demonstrations, 16.)
                                                                       : demonstrations * passes * learn_ms / 1000;
  return start_s + demonstrations * demonstration_s + learn_s + episodes * episode_s;
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
