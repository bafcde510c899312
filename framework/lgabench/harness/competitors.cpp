#include <lgabench/harness/competitors.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

#include <lgabench/record/reference_rows.hpp>

namespace lgabench {
namespace {

// The options of the row as written.
Json own_options(const std::string& method) {
  const std::vector<std::string> words = row_words(without_selected_by(method));
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

// Options by method id or "*", where they stand, and which of a method's options its "*" reaches. A suite knows no
// plugin of others, whose option of the same name may mean something else: its "*" is for the framework's.
struct Layer {
  const Json& options;
  std::string file, place;
  enum class Reach { framework, all } reach;

  bool reaches(const PluginInfo& info, const std::string& option) const {
    return info.options.contains(option) && (reach == Reach::all || info.options.at(option).value("framework", false));
  }
  // The part of "*" that is for the method.
  Json of_any(const PluginInfo& info) const {
    const Json all = any();
    Json values = Json::object();
    for (const auto& [option, value] : all.items())
      if (reaches(info, option)) values[option] = value;
    return values;
  }
  Json set_for(const PluginInfo& info) const { return options.value(info.id, Json::object()); }
  Json any() const { return options.value("*", Json::object()); }
  // The values for the method: those of its id, then those of "*".
  Json of(const PluginInfo& info) const {
    Json values = of_any(info);
    values.update(set_for(info));
    return values;
  }
  // Throws for an option in "*" that reaches no plugin, and for a value that a method of the run does not take.
  void check(const std::vector<const PluginInfo*>& methods, const Catalogue& catalogue) const {
    std::set<std::string> known;
    for (const PluginInfo& plugin : catalogue.plugins)
      if (plugin.kind == "method")
        for (const auto& option : plugin.options.items())
          if (reaches(plugin, option.key())) known.insert(option.key());
    const Json all = any();
    JsonReader(all, file, place + "/*").only({known.begin(), known.end()});
    for (const PluginInfo* info : methods) {
      const Json shared = of_any(*info), its_own = set_for(*info);
      check_options(*info, JsonReader(shared, file, place + "/*"));
      check_options(*info, JsonReader(its_own, file, place + "/" + info->id));
    }
  }
};

// The row that a written one is an example of: its id, and whether it selects alone.
std::string group_of(const std::string& written) {
  const std::string id = row_id(written);
  return selects_alone(written) ? selected_by + id : id;
}

// What learns and acts with the Selections of a method that selects alone: the shipped LGA, with the policy that finds
// places where the mask has them.
ActingMethod acting_method(const Layer& of_suite, const Layer& of_command, const Catalogue& catalogue) {
  const PluginInfo& lga = catalogue.find("method", "lga");
  Json given = of_suite.of(lga);
  given.update(of_command.of(lga));
  given["policy"] = "heat_map";
  return {lga.id, lga.version, resolve_options(lga, given)};
}

// An option added later is written where it is not its default alone.
Json value_of(const PluginInfo& info, const Json& options, const std::string& option) {
  return options.value(option, info.options.at(option).at("default"));
}

std::string named(const std::string& group, const PluginInfo& info, const Json& options, const Json& usual,
                  const std::set<std::string>& differing) {
  std::string name = group;
  for (const std::string& option : differing)
    if (const Json value = value_of(info, options, option); value != value_of(info, usual, option))
      name += fmt::format("+{}={}", option, option_text(value));
  return name;
}

}  // namespace

std::vector<Competitor> competitors(const Suite& suite, const Design& design, const Json& settings,
                                    const Catalogue& catalogue) {
  std::vector<const PluginInfo*> infos;
  std::vector<Competitor> methods;
  std::map<std::string, Json> usual;                       // group -> options of its row without options of its own
  std::map<std::string, std::set<std::string>> differing;  // group -> options in which its rows differ
  std::vector<std::string> groups;
  for (const std::string& written : design.methods) {
    const std::string id = row_id(written);
    if (find_reference_row(id))  // tables find a row by its name
      throw InputError(fmt::format("methods: \"{}\" is a reference row; expected a method of another id", id));
    infos.push_back(&catalogue.find("method", id));
    groups.push_back(group_of(written));
  }
  const Layer of_suite{design.options, suite.file, design.options_place, Layer::Reach::framework};
  const Layer of_command{settings, "--set", "", Layer::Reach::all};
  of_suite.check(infos, catalogue);
  of_command.check(infos, catalogue);
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const PluginInfo& info = *infos[i];
    Json given = of_suite.of(info);
    given.update(of_command.of(info));
    const std::string& group = groups[i];
    usual[group] = check_options(info, JsonReader(given, info.id));
    given.update(own_options(design.methods[i]));
    methods.push_back({"method", info.id, info.id, info.version, resolve_options(info, given), info.asks});
    if (selects_alone(design.methods[i])) methods.back().acts = acting_method(of_suite, of_command, catalogue);
    for (std::size_t before = 0; before < i; ++before)
      if (groups[before] == group)
        for (const auto& declared : info.options.items())
          if (const std::string& option = declared.key();
              value_of(info, methods[before].options, option) != value_of(info, methods.back().options, option))
            differing[group].insert(option);
  }
  for (std::size_t i = 0; i < infos.size(); ++i) {
    Competitor& method = methods[i];
    method.name = named(groups[i], *infos[i], method.options, usual.at(groups[i]), differing[groups[i]]);
    for (std::size_t before = 0; before < i; ++before)
      if (methods[before].name == method.name)
        throw InputError(fmt::format("methods: \"{}\" and \"{}\" are the same row, {}; expected each row once",
                                     design.methods[before], design.methods[i], method.name));
  }
  for (const auto& item : settings.items())
    if (item.key() != "*" &&
        std::none_of(methods.begin(), methods.end(), [&](const Competitor& one) { return one.id == item.key(); }))
      throw InputError(
          fmt::format("--set {}: expected a method of this run: {}", item.key(), fmt::join(design.methods, ", ")));
  return methods;
}

}  // namespace lgabench
