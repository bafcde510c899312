#include <lgabench/abstraction/nobody.hpp>

#include <fmt/format.h>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

[[noreturn]] void refuse(const Command& command) {
  throw InputError(fmt::format("the method asks a language model about \"{}\", and --answers none has no answers",
                               command.utterance));
}

}  // namespace

std::vector<bool> Nobody::answer(const Command& command, const FeatureSpace&, const std::vector<Question>&) {
  refuse(command);
}

Meaning Nobody::mean(const Command& command, const FeatureSpace&) { refuse(command); }

}  // namespace lgabench
