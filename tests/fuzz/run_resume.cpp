// Somebody else's run, merged, and gone on with.
#include <lgabench/core/version.hpp>
#include <lgabench/harness/merge.hpp>
#include <lgabench/harness/run_directory.hpp>

#include "run_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  const fs::path run = fuzz::directory() / "run", merged = fuzz::directory() / "merged";
  fuzz::write_run(run, fuzz::text_of(data, size));
  fuzz::write_run(merged, "");
  RunRecord wanted;
  wanted.cells = {"22a1e6165750943b"};
  wanted.version = LGABENCH_VERSION;
  wanted.request = {{"episodes", 4}};
  wanted.machine = {{"processor", "a processor"}};
  try {
    merge_runs(merged, {run, run}, "lgabench merge");
  } catch (const InputError&) {
  }
  try {
    const RunDirectory directory(run, wanted, Existing::resume);
    directory.state("22a1e6165750943b", Json::object());
  } catch (const InputError&) {
  }
  return 0;
}
