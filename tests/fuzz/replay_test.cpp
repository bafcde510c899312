// Every file of the corpus, through its target, without a fuzzer: what was found once stays mended.
#include <gtest/gtest.h>

#include <algorithm>

#include <lgabench/core/files.hpp>

// The targets of CMakeLists.txt, each under its own name.
#define TARGET(name) extern "C" int fuzz_##name(const std::uint8_t* data, std::size_t size);
#include "targets.inc"
#undef TARGET

namespace lgabench {
namespace {

void replay(const char* name, int (*target)(const std::uint8_t*, std::size_t)) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(LGABENCH_FUZZ_CORPUS) / name)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty());
  target(nullptr, 0);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    const std::string bytes = read_file(file);
    EXPECT_NO_THROW(target(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
  }
}

#define TARGET(name) \
  TEST(Corpus, name) { replay(#name, fuzz_##name); }
#include "targets.inc"
#undef TARGET

}  // namespace
}  // namespace lgabench
