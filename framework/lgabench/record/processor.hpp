// The processor of a record's machine, which the last bits of a trained policy may depend on.
#pragma once
#include <array>
#include <string>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// A kind of processor. Virtual machines with different processors share a name: their vector instructions tell them
/// apart.
struct Processor {
  std::string name;
  std::string instructions{};  // one of vector_instructions; "" where the record does not say
  bool inferred = false;       // the record does not name the instructions; the board's maintainers do
};
/// The first that a processor has is the one that training uses.
inline constexpr std::array vector_instructions{"AVX-512", "AVX2", "without FMA"};

/// The processor of this machine.
Processor this_processor();
/// /machine of a record. Of lgabench before 0.5 it has no instructions, or they follow the name: "AMD EPYC with AVX2".
/// @throws InputError for a member that is not as docs/formats says.
Processor read_processor(const JsonReader& machine);
/// "AMD EPYC with AVX2", "AMD EPYC without FMA", "AMD EPYC, instructions not recorded"
std::string to_string(const Processor& processor);

/// Whether a program owes the same bits on both. On one kind of processor it does. On two kinds it does where both have
/// fused multiply-add and the arithmetic is the framework's own: its kernels give the same bits in vectors of any
/// width. Where one of the records names no instructions, nothing is owed.
bool owe_same_bits(const Processor& there, const Processor& here, bool own_arithmetic);

}  // namespace lgabench
