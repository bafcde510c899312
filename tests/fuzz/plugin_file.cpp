// A plugin's file. What a compiler writes into a descriptor is put right: else nothing behind it would be read.
#include <cstring>

#include <lgabench/plugin/fingerprint.hpp>
#include <lgabench/plugin/reader.hpp>

#include "fuzz.hpp"

namespace {

using namespace lgabench;

std::string of_this_build(std::string bytes) {
  const std::string magic(LGABENCH_PLUGIN_MAGIC, sizeof(PluginDescriptor::magic));
  for (std::size_t at = bytes.find(magic); at != bytes.npos; at = bytes.find(magic, at + 1)) {
    PluginDescriptor d;
    if (bytes.size() - at < sizeof d) break;
    std::memcpy(&d, bytes.data() + at, sizeof d);
    d.struct_size = sizeof d;
    d.abi = LGABENCH_PLUGIN_ABI;
    std::strcpy(d.fingerprint, LGABENCH_FINGERPRINT);
    std::memcpy(bytes.data() + at, &d, sizeof d);
  }
  return bytes;
}

void read(const std::string& bytes) {
  try {
    const PluginInfo plugin = inspect_plugin(fuzz::write(fuzz::directory() / "plugin.so", bytes));
    canonical(to_json(plugin));
    resolve_options(plugin, Json::object());
  } catch (const PluginError&) {
  } catch (const InputError&) {  // defaults that do not go together
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(fuzz::text_of(data, size));
  read(bytes);
  read(of_this_build(bytes));
  return 0;
}
