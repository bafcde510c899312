#include <fmt/format.h>

#include <cstring>
#define BOOST_DLL_USE_STD_FS
#include <boost/core/demangle.hpp>
#include <boost/dll/shared_library.hpp>

#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/plugin/guarded.hpp>
#include <lgabench/plugin/reader.hpp>

namespace lgabench {
namespace {

constexpr const char* entry_symbol = "lga_plugin_v1";

// Libraries stay open until the process is gone: deleters, types and threads of LibTorch may live in them.
void keep_open(boost::dll::shared_library library) {
  static auto& kept = *new std::vector<boost::dll::shared_library>;
  kept.push_back(std::move(library));
}

// The dynamic loader's message, its undefined symbol as C++ text.
std::string readable(const std::string& message) {
  constexpr std::string_view before = "undefined symbol: ";
  const std::size_t at = message.find(before);
  if (at == std::string::npos) return message;
  const std::size_t begin = at + before.size();
  const std::size_t end = std::min(message.find_first_of(" ,)\n", begin), message.size());
  const std::string symbol = message.substr(begin, end - begin);
  return fmt::format("undefined symbol: {} ({})", boost::core::demangle(symbol.c_str()), symbol);
}

boost::dll::shared_library open_library(const fs::path& file) {
  using boost::dll::load_mode::rtld_local;
  using boost::dll::load_mode::rtld_now;
  try {
    return boost::dll::shared_library(fs::absolute(file), rtld_now | rtld_local);
  } catch (const std::exception& e) {
    throw PluginError("cannot be opened: " + readable(e.what()));
  }
}

void* create_object(const PluginInfo& plugin) {
  // The file may have been replaced since it was read; only bytes that passed are opened.
  const std::string bytes = read_file(plugin.file);
  if (sha256(bytes) != plugin.sha256) throw PluginError("the file has changed since it was read");
  const PluginDescriptor read = find_descriptor(bytes);

  const FlushDenormalsAgain on_every_way_out;  // static initialisers are plugin code too
  boost::dll::shared_library library = open_library(plugin.file);
  if (!library.has(entry_symbol)) throw PluginError(fmt::format("exports no {}", entry_symbol));
  const PluginEntry entry = library.get<const PluginEntry>(entry_symbol);
  keep_open(std::move(library));
  if (!entry.descriptor || std::memcmp(entry.descriptor, &read, sizeof read) != 0)
    throw PluginError("the descriptor in memory differs from the one in the file");

  void* object = nullptr;
  try {
    if (entry.create) object = entry.create();
  } catch (...) {
    throw PluginError("its factory failed: " + current_exception_text());
  }
  if (!object) throw PluginError("its factory returned nothing");
  return object;
}

template <class Interface>
std::unique_ptr<Interface> load(const PluginInfo& plugin, const char* kind) {
  try {
    if (plugin.kind != kind) throw PluginError(fmt::format("kind {}, expected {}", plugin.kind, kind));
    return std::unique_ptr<Interface>(static_cast<Interface*>(create_object(plugin)));
  } catch (const Error& e) {
    throw PluginError(fmt::format("plugin {} ({}): {}", plugin.id, plugin.file.string(), e.what()));
  }
}

}  // namespace

std::unique_ptr<Method> load_method(const PluginInfo& plugin) { return load<Method>(plugin, "method"); }

std::unique_ptr<PhysicsWorld> load_engine(const std::optional<PluginInfo>& plugin) {
  return plugin ? load<PhysicsWorld>(*plugin, "engine") : nullptr;
}

std::unique_ptr<ObservationPerturbation> load_perturbation(const PluginInfo& plugin) {
  return load<ObservationPerturbation>(plugin, "perturbation");
}

std::unique_ptr<Perceiver> load_perceiver(const PluginInfo& plugin) { return load<Perceiver>(plugin, "perceiver"); }

static std::function<const EnvironmentType*(const PluginInfo&)>& maker_of_python() {
  static std::function<const EnvironmentType*(const PluginInfo&)> make = [](const PluginInfo& plugin) {
    throw PluginError(fmt::format("environment {}: it is in Python, and this program plays none", plugin.id));
    return nullptr;
  };
  return make;
}

void make_python_environments(std::function<const EnvironmentType*(const PluginInfo& plugin)> make) {
  maker_of_python() = std::move(make);
}

void add_environment(const PluginInfo& plugin) {
  if (!plugin.python.is_null())
    return add_environment(plugin.id, plugin.sha256, [plugin] { return maker_of_python()(plugin); });
  add_environment(plugin.id, plugin.sha256, [plugin] {
    auto type = load<EnvironmentType>(plugin, "environment");
    if (type->id() != plugin.id)
      throw PluginError(fmt::format("plugin {} ({}): its EnvironmentType calls itself \"{}\"", plugin.id,
                                    plugin.file.string(), type->id()));
    return type.release();  // scenarios point to it
  });
}

}  // namespace lgabench
