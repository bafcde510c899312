// What a plugin says of itself before anything of it runs: a constant without pointers, found in the file's bytes.
#pragma once
#include <cstddef>
#include <cstdint>

#include <lgabench/core/version.hpp>

/// 16 characters. They are a macro so that the bytes stand in a plugin once, in its descriptor.
#define LGABENCH_PLUGIN_MAGIC "\x89lgabench plugin"

namespace lgabench {

/// Texts end with NUL. The members magic, struct_size and abi never move, so that any two versions can say what
/// differs. All other members may change with abi.
struct PluginDescriptor {
  char magic[16];
  std::uint32_t struct_size, abi;
  char kind[16];  // "method", "engine", "perturbation", "perceiver", "environment"
  char asks[16];  // whom a method asks beside the language model: "specify", "edit", "accept", "truth", "network", ""
  char id[64];    // lower-case letters, digits, underscores; starts with a letter
  char version[32];  // the plugin's own
  char summary[160];
  char fingerprint[256];  // LGABENCH_FINGERPRINT where the plugin was compiled
  // {"name": {"default": value, "help": text, "source": text, "values": [...], "min": n, "max": n,
  // "needs": {...}, "framework": true}, ...}; beside them "questionnaire": true, see LGABENCH_QUESTIONNAIRE,
  // and of an engine "kinematic": true, see LGABENCH_KINEMATIC_ENGINE. Of a perturbation what its axis declares, see
  // LGABENCH_PERTURBATION
  char options_json[4096];
};
static_assert(sizeof(PluginDescriptor) == 4664, "the descriptor has no padding");

/// Exported as `lga_plugin_v1`. The host owns what create() returns: a Method*, PhysicsWorld*,
/// ObservationPerturbation*, Perceiver* or EnvironmentType* as void*.
struct PluginEntry {
  const PluginDescriptor* descriptor;
  void* (*create)();
};

/// Fills a descriptor at compile time; a text that is too long does not compile.
template <std::size_t Kind, std::size_t Asks, std::size_t Id, std::size_t Version, std::size_t Summary,
          std::size_t Fingerprint, std::size_t Options>
constexpr PluginDescriptor describe_plugin(const char (&kind)[Kind], const char (&asks)[Asks], const char (&id)[Id],
                                           const char (&version)[Version], const char (&summary)[Summary],
                                           const char (&fingerprint)[Fingerprint],
                                           const char (&options_json)[Options]) {
  static_assert(Kind <= sizeof(PluginDescriptor::kind), "plugin kind: at most 15 bytes");
  static_assert(Asks <= sizeof(PluginDescriptor::asks), "plugin asks: at most 15 bytes");
  static_assert(Id <= sizeof(PluginDescriptor::id), "plugin id: at most 63 bytes");
  static_assert(Version <= sizeof(PluginDescriptor::version), "plugin version: at most 31 bytes");
  static_assert(Summary <= sizeof(PluginDescriptor::summary), "plugin summary: at most 159 bytes");
  static_assert(Fingerprint <= sizeof(PluginDescriptor::fingerprint), "plugin fingerprint: at most 255 bytes");
  static_assert(Options <= sizeof(PluginDescriptor::options_json), "plugin options: at most 4095 bytes");
  PluginDescriptor d{};
  for (std::size_t i = 0; i < sizeof d.magic; ++i) d.magic[i] = LGABENCH_PLUGIN_MAGIC[i];
  d.struct_size = sizeof(PluginDescriptor);
  d.abi = LGABENCH_PLUGIN_ABI;
  for (std::size_t i = 0; i < Kind; ++i) d.kind[i] = kind[i];
  for (std::size_t i = 0; i < Asks; ++i) d.asks[i] = asks[i];
  for (std::size_t i = 0; i < Id; ++i) d.id[i] = id[i];
  for (std::size_t i = 0; i < Version; ++i) d.version[i] = version[i];
  for (std::size_t i = 0; i < Summary; ++i) d.summary[i] = summary[i];
  for (std::size_t i = 0; i < Fingerprint; ++i) d.fingerprint[i] = fingerprint[i];
  for (std::size_t i = 0; i < Options; ++i) d.options_json[i] = options_json[i];
  return d;
}

}  // namespace lgabench
