// Text on its way to a person: without control sequences, and never the cause of another error.
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

namespace lgabench {

/// The text with every control character but tab and line end, every byte that is no UTF-8 and every mark that turns
/// the direction of writing shown as \x1b or \u202e: names and messages of plugins, runs and servers reach terminals.
std::string printable(std::string_view text);
/// printable(), with line ends shown as well: for a name or a message within a line.
std::string one_line(std::string_view text);

/// Writes bytes as they are. Never throws: a stream that cannot be written keeps the reason of its first failure.
void put(std::FILE* stream, std::string_view bytes) noexcept;

/// put() of the printable text. A failure to write stderr is ignored; flush_stdout() reports one of stdout.
template <class... Args>
void to_stdout(fmt::format_string<Args...> format, Args&&... args) {
  put(stdout, printable(fmt::format(format, std::forward<Args>(args)...)));
}
template <class... Args>
void to_stderr(fmt::format_string<Args...> format, Args&&... args) {
  put(stderr, printable(fmt::format(format, std::forward<Args>(args)...)));
}

/// Writes what is left of stdout. @throws InputError if any of what was printed could not be written.
void flush_stdout();

/// Opens what the caller left closed of descriptors 0 to 2, so that no file of ours takes the place of one: reading
/// finds nothing, writing to stdout fails, to stderr goes nowhere. First of all in main().
void open_standard_streams() noexcept;

}  // namespace lgabench
