#include <lgabench/core/terminal.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

int stdout_error = 0;  // errno of the first failure

// Bytes of the UTF-8 character that `text` begins with, and its code point; 0 bytes where it begins with none.
std::size_t decode(std::string_view text, std::uint32_t& point) {
  const auto lead = static_cast<unsigned char>(text[0]);
  const std::size_t size = lead < 0x80 ? 1 : lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : lead < 0xf5 ? 4 : 0;
  if (size == 0 || size > text.size()) return 0;
  point = size == 1 ? lead : lead & (0x7fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    const auto next = static_cast<unsigned char>(text[i]);
    if ((next & 0xc0) != 0x80) return 0;
    point = point << 6 | (next & 0x3fu);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  return point < least[size] || (point >= 0xd800 && point < 0xe000) || point > 0x10ffff ? 0 : size;
}

bool is_control(std::uint32_t point) {
  const auto within = [point](std::uint32_t first, std::uint32_t last) { return point >= first && point <= last; };
  return point < 0x20 || within(0x7f, 0x9f) || within(0x200e, 0x200f) || within(0x2028, 0x202e) ||
         within(0x2066, 0x2069);
}

std::string shown(std::string_view text, std::string_view kept) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const auto plain = std::find_if(text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }) - text.begin();
    out += text.substr(0, static_cast<std::size_t>(plain));
    text.remove_prefix(static_cast<std::size_t>(plain));
    if (text.empty()) break;
    std::uint32_t point = 0;
    const std::size_t size = decode(text, point);
    if (size == 0)
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    else if (!is_control(point) || (size == 1 && kept.find(text[0]) != kept.npos))
      out += text.substr(0, size);
    else
      out += point == '\n' ? "\\n" : fmt::format(fmt::runtime(point < 0x20 ? "\\x{:02x}" : "\\u{:04x}"), point);
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return shown(text, "\n\t"); }

std::string one_line(std::string_view text) { return shown(text, ""); }

void put(std::FILE* stream, std::string_view bytes) noexcept {
  // In the order in which it was said, where both streams go to one file.
  if (stream == stderr && std::fflush(stdout) != 0 && stdout_error == 0) stdout_error = errno;
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size()) return;
  if (stream == stdout && stdout_error == 0) stdout_error = errno;
}

void flush_stdout() {
  if (std::fflush(stdout) != 0 && stdout_error == 0) stdout_error = errno;
  if (stdout_error == 0 && std::ferror(stdout) != 0) stdout_error = EIO;
  if (stdout_error != 0)
    throw InputError(fmt::format("standard output: cannot be written: {}", std::strerror(stdout_error)));
}

void open_standard_streams() noexcept {
  for (int fd = 0; fd < 3; ++fd)
    if (::fcntl(fd, F_GETFD) < 0 && errno == EBADF)  // the lowest free number is this one
      ::open(fd == 1 ? "/dev/full" : "/dev/null", fd == 0 ? O_RDONLY : O_WRONLY);
}

}  // namespace lgabench
