#include <lgabench/leaderboard/labels.hpp>

#include <algorithm>
#include <set>

#include <lgabench/leaderboard/admission.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/reference_rows.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::leaderboard {

namespace {

// Of "option=value"; that itself where the board has none.
std::string words_for(const Labels& labels, const std::string& said) {
  const auto words = labels.values.find(said);
  return words == labels.values.end() ? said : words->second;
}

}  // namespace

Labels read_labels(const fs::path& board) {
  Labels labels;
  const fs::path file = board / labels_file;
  if (!fs::exists(fs::symlink_status(file))) return labels;
  const Json json = read_json(file, Links::refused);
  const JsonReader reader(json, file.string());
  reader.only({"note", "values", "rows"});
  if (reader.has("values")) {
    if (!reader.at("values").json().is_object()) reader.at("values").fail("an object");
    for (const auto& value : reader.at("values").json().items())
      labels.values[value.key()] = reader.at("values").at(value.key()).string();
  }
  if (reader.has("rows"))
    for (const JsonReader& row : reader.at("rows").elements()) {
      row.only({"id", "options", "label"});
      labels.rows.push_back({row.at("id").string(), row.at("label").string(), row.at("options").json()});
      if (!labels.rows.back().options.is_object()) row.at("options").fail("an object");
    }
  return labels;
}

std::string label_of(const Labels& labels, const Entry& entry, const std::vector<std::string>& telling) {
  const Competitor& row = entry.identity.row;
  const Labels::RowLabel* best = nullptr;
  for (const Labels::RowLabel& label : labels.rows) {
    bool fits = label.id == row.own_name();
    for (const auto& [option, value] : label.options.items()) fits = fits && row.options.value(option, Json()) == value;
    if (fits && (!best || label.options.size() > best->options.size())) best = &label;
  }
  const ReferenceRow* reference = row.is_reference() ? find_reference_row(row.id) : nullptr;
  std::string text = best        ? best->label
                     : reference ? statistics::capital(reference->name)
                                 : entry.about.value("label", statistics::display_name(row.own_name()));
  for (const std::string& option : telling) {
    if (!row.options.contains(option) || (best && best->options.contains(option))) continue;
    if (option == "policy" || option == "network") continue;
    const std::string words = words_for(labels, option + "=" + option_text(row.options.at(option)));
    text += (words.empty() ? "" : ", ") + words;
  }
  for (const std::string& part : entry.identity.conditions.parts()) text += ", " + words_for(labels, part);
  return text;
}

std::string policy_label(const Labels& labels, const Entry& entry) {
  const Competitor& row = entry.identity.row;
  const std::string policy = policy_of(entry);
  if (row.is_reference()) return "";
  if (policy.empty()) return "its own";
  std::string text = words_for(labels, "policy=" + policy);
  const Json network = (row.acts ? row.acts->options : row.options).value("network", Json());
  if (policy == "regression" && network.is_string())
    if (const std::string words = words_for(labels, "network=" + network.get<std::string>()); !words.empty())
      text += ", " + words;
  return text;
}

std::string answers_label(const Entry& entry) {
  if (entry.identity.row.is_reference()) return "";
  if (entry.has_answers_as_submitted()) return as_submitted;
  const std::set<std::string> all = provenances_of(entry);
  for (const auto& [provenance, words] : {std::pair("human", "people"),
                                          {"simulated_edit", "a simulated person"},
                                          {"truth", "the truth"},
                                          {"live", "a model"},
                                          {"cassette", "a model"},
                                          {"recorded", "a model, recorded"},
                                          {"rule", "nobody asked"}})
    if (all.count(provenance) > 0) return words;
  return "";
}

}  // namespace lgabench::leaderboard
