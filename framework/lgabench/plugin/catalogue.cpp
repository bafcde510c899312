#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>

#include <lgabench/core/files.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/plugin/reader.hpp>

namespace lgabench {
namespace {

constexpr const char* found_elsewhere = "; other plugins are found with --plugin-path DIR";

// Programs without --plugin-path, and scenarios that are read before it was, find environments where plugins are.
const bool environments_are_looked_for = [] {
  look_for_environments([](const std::string& id) {
    return scan_plugins(plugin_directories()).refusals_of(id) +
           "; others are found with --plugin-path or $LGABENCH_PLUGIN_PATH";
  });
  return true;
}();

}  // namespace

Json to_json(const PluginInfo& plugin) {
  Json json{{"file", plugin.file.string()},
            {"kind", plugin.kind},
            {"id", plugin.id},
            {"version", plugin.version},
            {"summary", plugin.summary},
            {"fingerprint", plugin.fingerprint},
            {"asks", plugin.asks},
            {"options", plugin.options},
            {"sha256", plugin.sha256},
            {"questionnaire", plugin.questionnaire},
            {"kinematic", plugin.kinematic}};
  if (!plugin.axis.is_null()) json["axis"] = plugin.axis;
  return json;
}

const PluginInfo& Catalogue::find(const std::string& kind, const std::string& id) const {
  std::vector<std::string> known;
  for (const auto& plugin : plugins) {
    if (plugin.kind == kind && plugin.id == id) return plugin;
    if (plugin.kind == kind) known.push_back(plugin.id);
  }
  std::sort(known.begin(), known.end());
  throw PluginError(none_named(kind, id, known) + refusals_of(id) + found_elsewhere);
}

std::optional<PluginInfo> Catalogue::engine(const std::string& id, const EnvironmentType& environment) const {
  if (environment.has_engine() && id == own_engine)
    throw InputError(
        fmt::format("engine {}: environment {} needs an engine plugin (lgabench list engines)", id, environment.id()));
  if (environment.has_engine()) return find("engine", id);
  if (id != own_engine)
    throw InputError(
        fmt::format("engine {}: environment {} has no engine plugin: expected {}", id, environment.id(), own_engine));
  return std::nullopt;
}

std::string Catalogue::refusals_of(const std::string& id) const {
  std::string all;
  for (const auto& [file, reason] : refused)
    if (file.stem() == id || file.extension() != ".so")  // of that name, or a whole directory
      all += fmt::format("; {} was refused: {}", file.string(), reason);
  return all;
}

std::vector<fs::path> plugin_directories(const std::vector<fs::path>& extra) {
  std::vector<fs::path> all{shipped_plugin_directory()};
  if (const char* listed = std::getenv("LGABENCH_PLUGIN_PATH")) {
    std::istringstream parts(listed);
    for (std::string part, rest; std::getline(parts, part, ':');) {
      if (fs::path(part).extension() == ".py" && std::getline(parts, rest, ':')) part += ":" + rest;  // FILE.py:CLASS
      if (!part.empty()) all.emplace_back(part);
    }
  }
  all.insert(all.end(), extra.begin(), extra.end());
  return all;
}

bool is_site_packages(const fs::path& directory) {
  std::error_code error;
  for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".dist-info") return true;
  return false;
}

Catalogue scan_plugins(const std::vector<fs::path>& directories) {
  Catalogue catalogue;
  std::set<fs::path> seen;  // a directory named twice is one directory
  for (const fs::path& directory : directories) {
    std::error_code error;
    if (directory.string().find(".py:") != std::string::npos) continue;  // host/python_method.hpp
    if (!seen.insert(fs::weakly_canonical(directory, error)).second || is_site_packages(directory)) continue;
    std::vector<fs::path> files;
    const bool is_file = directory.extension() == ".so" && fs::is_regular_file(directory);
    if (is_file) files.push_back(directory);
    for (fs::directory_iterator it = is_file ? fs::directory_iterator() : fs::directory_iterator(directory, error), end;
         !error && it != end; it.increment(error))
      if (it->path().extension() == ".so") files.push_back(it->path());
    if (!error && files.empty()) catalogue.refused.push_back({directory, "no plugin (*.so) is in it"});
    if (error) {
      catalogue.refused.push_back({directory, "cannot be read: " + error.message()});
      continue;
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
      try {
        PluginInfo plugin = inspect_plugin(file);
        for (const auto& other : catalogue.plugins)
          if (other.kind == plugin.kind && other.id == plugin.id)
            throw PluginError(fmt::format("{} \"{}\" is already in {}", plugin.kind, plugin.id, other.file.string()));
        if (plugin.kind == "environment") add_environment(plugin);
        catalogue.plugins.push_back(std::move(plugin));
      } catch (const Error& e) {
        catalogue.refused.push_back({file, e.what()});
      }
    }
  }
  return catalogue;
}

void add_axes(Catalogue& catalogue) {
  auto& plugins = catalogue.plugins;
  const auto refused = [&catalogue](const PluginInfo& plugin) {
    if (plugin.kind != "perturbation") return false;
    try {
      add_plugin_axis(read_axis(plugin.id, JsonReader(plugin.axis, plugin.file.string())));
      return false;
    } catch (const InputError& e) {
      catalogue.refused.push_back({plugin.file, e.what()});
      return true;
    }
  };
  plugins.erase(std::remove_if(plugins.begin(), plugins.end(), refused), plugins.end());
}

}  // namespace lgabench
