// A descriptor's options, and in further lines what a suite or a command line says of them.
#include <lgabench/plugin/reader.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  const std::vector<std::string_view> lines = fuzz::split(fuzz::text_of(data, size), "\n");
  PluginInfo plugin;
  try {
    plugin.options = read_options(std::string(lines.front())).options;
  } catch (const PluginError&) {
    return 0;
  }
  for (const std::string_view line : lines) try {
      canonical(resolve_options(plugin, option_value(std::string(line))));
      canonical(resolve_options(plugin, json_or_null(line)));
    } catch (const InputError&) {
    }
  return 0;
}
