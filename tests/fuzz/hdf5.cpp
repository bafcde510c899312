// A file of demonstrations.
#include <lgabench/cell/hdf5.hpp>
#include <lgabench/core/error.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  try {
    read_demonstrations(std::string(fuzz::text_of(data, size)), "fuzzed.hdf5");
  } catch (const InputError&) {
  }
  return 0;
}
