// Weights: the bytes as a file, and as what follows the length of a header that is the first line.
#include <lgabench/core/error.hpp>
#include <lgabench/learning/safetensors.hpp>

#include "fuzz.hpp"

namespace {

using namespace lgabench;

volatile float seen = 0;  // that a number is read is seen

void read(std::string_view bytes) {
  try {
    const Safetensors weights(fuzz::write(fuzz::directory() / "model.safetensors", bytes));
    seen = weights.get("bias", {2})[1];
    seen = weights.get("weight", {2, 3})[5];
  } catch (const InputError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  read(text);
  const std::uint64_t header = std::min(text.find('\n'), text.size());
  read(std::string(reinterpret_cast<const char*>(&header), sizeof header).append(text));
  return 0;
}
