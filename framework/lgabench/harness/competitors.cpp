#include <lgabench/harness/competitors.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

namespace lgabench {
namespace {

// The options of the row as written.
Json own_options(const std::string& method) {
  const std::vector<std::string> words = row_words(method);
  Json options = Json::object();
  for (auto word = words.begin() + 1; word != words.end(); ++word) {
    const std::size_t equals = word->find('=');
    const std::string option = word->substr(0, equals);
    if (option.empty() || equals == std::string::npos || options.contains(option))
      throw InputError(fmt::format("method \"{}\": expected ID+OPTION=VALUE+..., each option once", method));
    options[option] = option_value(word->substr(equals + 1));
  }
  return options;
}

// The layer's values for the method: those of its id, then those of "*" for options that it has.
Json layer_for(const PluginInfo& info, const Json& layer) {
  const Json any = layer.value("*", Json::object());
  Json values = Json::object();
  for (const auto& [option, value] : any.items())
    if (info.options.contains(option)) values[option] = value;
  values.update(layer.value(info.id, Json::object()));
  return values;
}

// Throws for an option in "*" that no plugin has, and for a value that a method of the run does not take.
void check_layer(const Json& layer, const std::string& file, const std::string& place,
                 const std::vector<const PluginInfo*>& methods, const Catalogue& catalogue) {
  const Json any = layer.value("*", Json::object());
  std::set<std::string> known;
  for (const PluginInfo& plugin : catalogue.plugins)
    if (plugin.kind == "method")
      for (const auto& option : plugin.options.items()) known.insert(option.key());
  JsonReader(any, file, place + "/*").only({known.begin(), known.end()});
  for (const PluginInfo* info : methods) {
    const Json of_any = layer_for(*info, {{"*", any}}), own = layer.value(info->id, Json::object());
    check_options(*info, JsonReader(of_any, file, place + "/*"));
    check_options(*info, JsonReader(own, file, place + "/" + info->id));
  }
}

std::string named(const PluginInfo& info, const Json& options, const Json& usual, const std::set<std::string>& told) {
  std::string name = info.id;
  for (const std::string& option : told)
    if (const Json& value = options.at(option); value != usual.at(option))
      name += fmt::format("+{}={}", option, option_text(value));
  return name;
}

}  // namespace

std::vector<Competitor> competitors(const Suite& suite, const Grid& grid, const Json& settings,
                                    const Catalogue& catalogue) {
  std::vector<const PluginInfo*> infos;
  std::vector<Competitor> methods;
  std::map<std::string, Json> usual;                  // id -> options of its row without options of its own
  std::map<std::string, std::set<std::string>> told;  // id -> options in which its rows differ
  for (const std::string& written : grid.methods) {
    const std::string id = row_words(written).front();
    if (id == "constant_action" || id == "random_object" || id == "oracle")  // tables find a row by its name
      throw InputError(fmt::format("methods: \"{}\" is a reference row; expected a method of another id", id));
    infos.push_back(&catalogue.find("method", id));
  }
  check_layer(grid.options, suite.file, grid.options_place, infos, catalogue);
  check_layer(settings, "--set", "", infos, catalogue);
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const PluginInfo& info = *infos[i];
    Json given = layer_for(info, grid.options);
    given.update(layer_for(info, settings));
    usual[info.id] = check_options(info, JsonReader(given, info.id));
    given.update(own_options(grid.methods[i]));
    methods.push_back({"method", info.id, info.id, info.version, resolve_options(info, given), info.asks});
    for (const Competitor& other : methods)
      if (other.id == info.id)
        for (const auto& [option, value] : other.options.items())
          if (value != methods.back().options.at(option)) told[info.id].insert(option);
  }
  for (std::size_t i = 0; i < infos.size(); ++i) {
    Competitor& method = methods[i];
    method.name = named(*infos[i], method.options, usual.at(method.id), told[method.id]);
    for (std::size_t before = 0; before < i; ++before)
      if (methods[before].name == method.name)
        throw InputError(fmt::format("methods: \"{}\" and \"{}\" are the same row, {}; expected each row once",
                                     grid.methods[before], grid.methods[i], method.name));
  }
  for (const auto& item : settings.items())
    if (item.key() != "*" && usual.count(item.key()) == 0)
      throw InputError(
          fmt::format("--set {}: expected a method of this run: {}", item.key(), fmt::join(grid.methods, ", ")));
  return methods;
}

}  // namespace lgabench
