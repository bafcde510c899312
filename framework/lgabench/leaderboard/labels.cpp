#include <lgabench/leaderboard/labels.hpp>

#include <algorithm>

#include <lgabench/plugin/loader.hpp>
#include <lgabench/report/names.hpp>

namespace lgabench::leaderboard {

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
  std::string text = best ? best->label : entry.about.value("label", report::display_name(row.own_name()));
  for (const std::string& option : telling) {
    if (!row.options.contains(option) || (best && best->options.contains(option))) continue;
    const std::string said = option + "=" + option_text(row.options.at(option));
    const auto words = labels.values.find(said);
    text += ", " + (words == labels.values.end() ? said : words->second);
  }
  return text;
}

}  // namespace lgabench::leaderboard
