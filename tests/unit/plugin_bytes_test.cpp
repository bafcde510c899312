// Damaged files: read_plugin refuses, or reads something whole; it never crashes.
#include <lgabench/core/random.hpp>
#include <lgabench/plugin/descriptor.hpp>
#include <lgabench/plugin/loader.hpp>

#include "plugin_fixtures.hpp"

namespace lgabench {
namespace {

const std::string& good_bytes() {
  static const std::string bytes = read_file(fixture("good/fixture_constant"));
  return bytes;
}

std::size_t descriptor_at() { return good_bytes().find(std::string(LGABENCH_PLUGIN_MAGIC, 16)); }

// True if the bytes were accepted as a plugin.
bool accepted(const Directory& directory, const std::string& bytes) {
  const fs::path file = directory.write("damaged.so", bytes);
  try {
    const PluginInfo plugin = read_plugin(file);
    EXPECT_TRUE(plugin.kind == "method" || plugin.kind == "engine");
    EXPECT_FALSE(plugin.id.empty());
    EXPECT_TRUE(plugin.options.is_object());
    return true;
  } catch (const PluginError& e) {
    EXPECT_EQ(std::string(e.what()).rfind(file.string() + ": ", 0), 0u) << e.what();
    return false;
  }
}

TEST(DamagedPlugin, EveryCutIsRefused) {
  const Directory directory;
  const std::size_t size = good_bytes().size();
  std::vector<std::size_t> lengths{1, 63, 64, size - 1, descriptor_at(), descriptor_at() + 20, descriptor_at() + 1000};
  for (std::size_t length = 100; length < size; length += 997) lengths.push_back(length);
  for (const std::size_t length : lengths)
    EXPECT_FALSE(accepted(directory, good_bytes().substr(0, length))) << length << " of " << size << " bytes";
  EXPECT_TRUE(accepted(directory, good_bytes()));

  directory.write("damaged.so", good_bytes().substr(0, descriptor_at() + 1000));
  EXPECT_SAYS(message_of<PluginError>([&] { read_plugin(directory.path / "damaged.so"); }), "cut off");
}

TEST(DamagedPlugin, AnotherMachinesIsRefused) {
  const Directory directory;
  std::string bytes = good_bytes();
  bytes[18] = '\xf3', bytes[19] = 0;  // e_machine: RISC-V
  EXPECT_FALSE(accepted(directory, bytes));
  EXPECT_SAYS(message_of<PluginError>([&] { read_plugin(directory.path / "damaged.so"); }),
              "built for ELF machine 243");
}

TEST(DamagedPlugin, DescriptorOutsideOfWhatIsLoadedDoesNotCount) {
  const Directory directory;  // debug information repeats constants
  EXPECT_TRUE(accepted(directory, good_bytes() + good_bytes().substr(descriptor_at(), sizeof(PluginDescriptor))));
}

TEST(DamagedPlugin, RandomDamageNeverCrashes) {
  const Directory directory;
  RandomStream random("plugin bytes test");
  const std::size_t header = 64 + 56 * 12;  // ELF header and program headers
  int refused = 0;
  for (int round = 0; round < 500; ++round) {
    std::string bytes = good_bytes();
    // Where it matters: headers, descriptor, anywhere.
    std::size_t begin = 0, length = bytes.size();
    if (round % 3 == 0) length = header;
    if (round % 3 == 1) begin = descriptor_at(), length = sizeof(PluginDescriptor);
    const std::uint32_t count = 1 + random.below(16);
    for (std::uint32_t i = 0; i < count; ++i)
      bytes[begin + random.below(static_cast<std::uint32_t>(length))] = static_cast<char>(random.below(256));
    if (random.below(5) == 0) bytes.resize(random.below(static_cast<std::uint32_t>(bytes.size())));
    if (!accepted(directory, bytes)) ++refused;
  }
  EXPECT_GT(refused, 100);
}

TEST(DamagedPlugin, TextWithoutAnEndIsRefused) {
  const Directory directory;
  using D = PluginDescriptor;
  const std::pair<std::size_t, std::size_t> fields[] = {{offsetof(D, kind), sizeof(D::kind)},
                                                        {offsetof(D, id), sizeof(D::id)},
                                                        {offsetof(D, version), sizeof(D::version)},
                                                        {offsetof(D, summary), sizeof(D::summary)},
                                                        {offsetof(D, fingerprint), sizeof(D::fingerprint)},
                                                        {offsetof(D, options_json), sizeof(D::options_json)}};
  for (const auto& [offset, size] : fields) {
    std::string bytes = good_bytes();
    bytes.replace(descriptor_at() + offset, size, std::string(size, 'x'));
    EXPECT_FALSE(accepted(directory, bytes)) << "at " << offset;
  }
  std::string bytes = good_bytes();
  bytes[descriptor_at() + offsetof(PluginDescriptor, summary)] = '\xff';
  EXPECT_FALSE(accepted(directory, bytes)) << "invalid UTF-8";
}

}  // namespace
}  // namespace lgabench
