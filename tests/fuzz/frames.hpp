// The two ends of a conversation in one process: all that a peer says lies in the socket before it is read.
#pragma once
#include <sys/socket.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <lgabench/host/frames.hpp>

#include "fuzz.hpp"

namespace lgabench::fuzz {

/// More bytes or frames might not fit into the socket at once.
constexpr std::size_t most_said = 1 << 14, most_frames = 64;

/// Two connected sockets.
struct Ends {
  Descriptor ours, theirs;
};
inline Ends ends() {
  int pair[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0) throw InputError("socketpair");
  return {Descriptor(pair[0]), Descriptor(pair[1])};
}

/// A channel that nobody has to wait for.
inline Channel channel_of(Descriptor socket) {
  return {std::move(socket), [](short) { throw std::logic_error("nothing is left to be received"); }};
}

/// Each line as a frame: a JSON object, and after a tab the payload. What is none is passed over.
inline std::vector<Frame> frames_of(std::string_view text) {
  std::vector<Frame> frames;
  for (const std::string_view line : split(text, "\n")) {
    const std::size_t tab = std::min(line.find('\t'), line.size());
    const Json header = json_or_null(line.substr(0, tab));
    if (!header.is_object() || frames.size() == most_frames) continue;
    frames.push_back({header, std::string(line.substr(std::min(tab + 1, line.size())))});
  }
  return frames;
}

}  // namespace lgabench::fuzz
