// lgabench-engine-conformance [ENGINE] [--gtest_filter=...]: does an engine keep the contract?
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <lgabench/core/flush_denormals.hpp>

#include "../engine_under_test.hpp"

int main(int argc, char** argv) {
  lgabench::flush_denormals();
  testing::InitGoogleTest(&argc, argv);
  if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
    fmt::print(
        "Usage: lgabench-engine-conformance [ENGINE] [--gtest_filter=PATTERN]\n"
        "ENGINE: an engine's id, or the file of a plugin (.so). LGABENCH_FULL=1 plays more.\n"
        "Example: lgabench-engine-conformance ./my_engine.so --gtest_filter=World.*\n");
    return 2;
  }
  if (argc == 2) ::setenv("LGABENCH_TEST_ENGINE", argv[1], 1);
  if (!testing::GTEST_FLAG(list_tests)) try {
      const lgabench::PluginInfo& engine = lgabench::engine_under_test();
      fmt::print("engine {} {}: {}\n", engine.id, engine.version, engine.file.string());
    } catch (const lgabench::Error& e) {
      fmt::print(stderr, "{}\n", e.what());
      return 4;
    }
  return RUN_ALL_TESTS();
}
