#include <lgabench/core/colour.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace lgabench {

bool is_terminal(std::FILE* stream) {
  const char* kind = std::getenv("TERM");
  return ::isatty(::fileno(stream)) != 0 && kind && std::string_view(kind) != "dumb";
}

std::string painted(std::FILE* stream, Colour colour, std::string_view text) {
  const char* none = std::getenv("NO_COLOR");
  if (!is_terminal(stream) || (none && *none)) return std::string(text);
  return fmt::format("\x1b[{}m{}\x1b[0m", static_cast<int>(colour), text);
}

}  // namespace lgabench
