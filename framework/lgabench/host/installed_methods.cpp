#include <lgabench/host/installed_methods.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>
#include <vector>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/host/python_method.hpp>

namespace lgabench {
namespace {

constexpr const char* group = "lgabench.methods";
constexpr std::uintmax_t most_bytes = 1 << 20;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == text.npos ? "" : text.substr(first, last - first + 1);
}

// "id", "package.module:Class" of each entry, in the file's order; extras behind it do not count.
std::vector<std::pair<std::string, std::string>> entries_of(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > most_bytes) return {};
  std::vector<std::pair<std::string, std::string>> entries;
  std::istringstream lines(read_file(file));
  bool ours = false;
  for (std::string line; std::getline(lines, line);) {
    line = trimmed(line);
    if (line.empty() || line.front() == '#' || line.front() == ';') continue;
    if (line.front() == '[') {
      ours = line == fmt::format("[{}]", group);
    } else if (const std::size_t equals = line.find('='); ours && equals != line.npos) {
      const std::string object = line.substr(equals + 1);
      entries.emplace_back(trimmed(line.substr(0, equals)), trimmed(object.substr(0, object.find('['))));
    }
  }
  return entries;
}

// FILE.py:Class, by names alone. @throws PluginError where there is no such file.
std::string source_of(const fs::path& site, const std::string& object) {
  const std::size_t colon = object.find(':');
  const std::string module = trimmed(object.substr(0, colon));
  const std::string name = colon == object.npos ? "" : trimmed(object.substr(colon + 1));
  const auto is_written = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.'; };
  if (module.empty() || name.empty() || module.front() == '.' || !std::all_of(module.begin(), module.end(), is_written))
    throw PluginError(fmt::format("\"{}\", expected package.module:Class", object));
  std::string inside = module;
  std::replace(inside.begin(), inside.end(), '.', '/');
  std::error_code not_there;
  for (const fs::path& file : {site / (inside + ".py"), site / inside / "__init__.py"})
    if (fs::exists(file, not_there)) return fmt::format("{}:{}", file.string(), name);
  throw PluginError(fmt::format("no module {} in {}; a package that is not installed there is named FILE.py:CLASS",
                                module, site.string()));
}

}  // namespace

void add_installed_methods(const fs::path& site, const std::string& interpreter, Catalogue& catalogue) {
  const fs::path folder = fs::absolute(site);
  std::vector<fs::path> declared;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".dist-info") declared.push_back(it->path() / "entry_points.txt");
  std::sort(declared.begin(), declared.end());
  for (const fs::path& file : declared)
    for (const auto& [id, object] : entries_of(file)) try {
        const PluginInfo plugin = describe_python(source_of(folder, object), interpreter, folder, id);
        if (plugin.kind != "method") throw PluginError(fmt::format("expected a method, it is a {}", plugin.kind));
        add_once(plugin, catalogue);
      } catch (const Error& e) {
        catalogue.refused.push_back({file, fmt::format("{}: {}", id, e.what())});
      }
}

}  // namespace lgabench
