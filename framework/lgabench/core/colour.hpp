// Colour for a person at a terminal; none in a file, a pipe, or where NO_COLOR is set.
#pragma once
#include <cstdio>
#include <string>
#include <string_view>

namespace lgabench {

/// Its values are those of the terminal's "select graphic rendition".
enum class Colour { bold = 1, red = 31, green = 32, yellow = 33 };

/// Whether the stream is a terminal that understands control sequences.
bool is_terminal(std::FILE* stream);

/// The text in that colour, if the stream is a terminal and NO_COLOR is not set; else as it is. For put(): what the
/// text holds reaches the terminal unchanged.
std::string painted(std::FILE* stream, Colour colour, std::string_view text);

}  // namespace lgabench
