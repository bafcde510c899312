#include <lgabench/record/processor.hpp>

#include <fmt/format.h>

#include <fstream>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/processor.hpp>

namespace lgabench {
namespace {

constexpr const char* without_fma = vector_instructions.back();

bool has_fma(const Processor& processor) {
  return !processor.instructions.empty() && processor.instructions != without_fma;
}

}  // namespace

Processor this_processor() {
  const char* const instructions = has_avx512() ? "AVX-512" : has_avx2() ? "AVX2" : without_fma;
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return {line.substr(line.find(':') + 2), instructions};
  return {"unknown", instructions};
}

Processor read_processor(const JsonReader& machine) {
  Processor processor{machine.at("processor").string()};
  if (machine.has("instructions")) {
    processor.instructions = machine.at("instructions").string();
    if (!contains(vector_instructions, processor.instructions))
      machine.at("instructions")
          .fail(fmt::format("{}, {} or {}", vector_instructions[0], vector_instructions[1], without_fma));
    return processor;
  }
  for (const char* instructions : {"AVX-512", "AVX2"}) {
    const std::string ending = fmt::format(" with {}", instructions);
    const std::size_t at = processor.name.rfind(ending);
    if (at != std::string::npos && at + ending.size() == processor.name.size())
      return {processor.name.substr(0, at), instructions};
  }
  return processor;
}

std::string to_string(const Processor& processor) {
  if (processor.instructions.empty()) return processor.name + ", instructions not recorded";
  const bool without = processor.instructions == without_fma;
  return fmt::format("{} {}{}{}", processor.name, without ? "" : "with ", processor.instructions,
                     processor.inferred ? " (inferred)" : "");
}

bool owe_same_bits(const Processor& there, const Processor& here, bool own_arithmetic) {
  if (there.instructions.empty() || here.instructions.empty()) return false;
  if (there.name == here.name && there.instructions == here.instructions) return true;
  return own_arithmetic && has_fma(there) && has_fma(here);
}

}  // namespace lgabench
