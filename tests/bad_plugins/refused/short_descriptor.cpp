// A descriptor that ends after its id, and says so.
#include <lgabench/plugin/plugin.hpp>

namespace {

struct ShortDescriptor {
  char magic[16];
  std::uint32_t struct_size, abi;
  char kind[16], id[64];
};

constexpr ShortDescriptor describe() {
  ShortDescriptor d{{}, sizeof(ShortDescriptor), LGABENCH_PLUGIN_ABI, "method", "short_descriptor"};
  for (std::size_t i = 0; i < sizeof d.magic; ++i) d.magic[i] = LGABENCH_PLUGIN_MAGIC[i];
  return d;
}

[[gnu::section(".lgabench"), gnu::used]] constexpr ShortDescriptor descriptor = describe();

}  // namespace
