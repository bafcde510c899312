#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <cmath>
#include <limits>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {
namespace {

const char* type_of(const Json& value) {
  if (value.is_string()) return "a text";
  if (value.is_boolean()) return "true or false";
  if (value.is_number_integer()) return "a whole number";
  return "a number";
}

bool within(const Json& option, double value) {
  return (!option.contains("min") || value >= option.at("min").get<double>()) &&
         (!option.contains("max") || value <= option.at("max").get<double>());
}

}  // namespace

std::string range_text(const Json& option) {
  const bool from = option.contains("min"), to = option.contains("max");
  if (from && to) return fmt::format("from {} to {}", canonical(option.at("min")), canonical(option.at("max")));
  if (from) return fmt::format("of {} or more", canonical(option.at("min")));
  return to ? fmt::format("of {} or less", canonical(option.at("max"))) : "";
}

Json option_value(const std::string& word) {
  const Json value = json_or_null(word);
  return value.is_number() || value.is_boolean() ? value : Json(word);
}

std::string option_text(const Json& value) { return value.is_string() ? value.get<std::string>() : canonical(value); }

std::vector<std::string> row_words(const std::string& row) {
  std::vector<std::string> words{""};
  for (std::size_t i = 0; i < row.size(); ++i) {
    const bool ends = words.size() == 1 || i + 1 == row.size() || std::isalpha(static_cast<unsigned char>(row[i + 1]));
    if (row[i] == '+' && ends)
      words.emplace_back();
    else
      words.back() += row[i];
  }
  return words;
}

std::string row_id(const std::string& row) { return row_words(without_selected_by(row)).front(); }

bool selects_alone(const std::string& row) { return row.rfind(selected_by, 0) == 0; }

std::string without_selected_by(const std::string& row) {
  return selects_alone(row) ? row.substr(std::string(selected_by).size()) : row;
}

Json check_options(const PluginInfo& plugin, const JsonReader& given) {
  const Json& overrides = given.json();
  std::vector<std::string> known;
  for (const auto& option : plugin.options.items()) known.push_back(option.key());
  if (known.empty() && overrides.is_object() && !overrides.empty()) given.fail("none: it has no options");
  given.only(known);

  Json resolved = Json::object();
  for (const auto& [name, option] : plugin.options.items()) {
    const Json& usual = option.at("default");
    Json value = given.has(name) ? overrides.at(name) : usual;
    if (value == usual && option.value("added", false)) continue;  // as before there was this option
    // A fractional option keeps its type, so that 1 and 1.0 are one configuration.
    if (usual.is_number_float() && value.is_number()) value = value.get<double>();
    if (value.is_string() && option.contains("words") && contains(option.at("words"), value)) {
      resolved[name] = std::move(value);
      continue;
    }
    const bool same_type = value.type() == usual.type() || (value.is_number_integer() && usual.is_number_integer());
    if (!same_type) given.at(name).fail(type_of(usual));
    if (option.contains("values")) {
      const Json& values = option.at("values");
      std::vector<std::string> texts;
      for (const Json& one : values) texts.push_back(option_text(one));
      if (!contains(values, value))
        given.at(name).fail(fmt::format("one of {} ({}){}", canonical(values), option.at("help").get<std::string>(),
                                        suggestion(option_text(value), texts)));
    }
    if (value.is_number() && !within(option, value.get<double>()))
      given.at(name).fail(fmt::format("{} {}", type_of(usual), range_text(option)));
    constexpr double most = std::numeric_limits<int>::max();  // which is how methods read them
    if (value.is_number_integer() && std::abs(value.get<double>()) > most)
      given.at(name).fail(fmt::format("{} of at most {:.0f}", type_of(usual), most));
    resolved[name] = std::move(value);
  }
  return resolved;
}

Json resolve_options(const PluginInfo& plugin, const Json& overrides) {
  const JsonReader given(overrides, fmt::format("options of {} {}", plugin.kind, plugin.id));
  Json resolved = check_options(plugin, given);
  for (const auto& [name, option] : plugin.options.items()) {
    if (!option.contains("needs") || !resolved.contains(name) || !resolved.at(name).is_string()) continue;
    const Json& value = resolved.at(name);
    const Json needs = option.at("needs").value(value.get<std::string>(), Json::object());
    for (const auto& [other, values] : needs.items())
      if (!contains(values, resolved[other]))
        JsonReader(resolved, given.file())
            .at(other)
            .fail(fmt::format("one of {}, which {}={} needs", canonical(values), name, value.get<std::string>()));
  }
  return resolved;
}

}  // namespace lgabench
