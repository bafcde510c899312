#include <lgabench/abstraction/nobody.hpp>

#include <fmt/format.h>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

[[noreturn]] void refuse(const Command& command) {
  throw InputError(
      fmt::format("a language model is asked about \"{}\", and --answers none has none", command.utterance));
}

}  // namespace

std::vector<bool> Nobody::answer(const Command& command, const FeatureSpace&, const std::vector<Question>&) {
  refuse(command);
}

Meaning Nobody::mean(const Command& command, const FeatureSpace&) { refuse(command); }

}  // namespace lgabench
