// The frames between a worker and a method's process (docs/formats/method-protocol.md). One thread.
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {

/// Raised whenever a frame or an array changes its meaning.
constexpr int protocol_version = 1;
constexpr std::uint32_t most_header_bytes = 8 << 20, most_payload_bytes = 1 << 20;

/// What the peer sent has another form than the protocol says.
class Malformed : public InputError {
 public:
  using InputError::InputError;
};

/// A JSON object, raw little-endian numbers, and a file that travels beside them.
struct Frame {
  Json header;
  std::string payload = {};
  Descriptor file = Descriptor();

  /// The header's "type".
  std::string type() const;
};

/// A frame as it goes over the socket. @throws MethodError for one over the limits.
std::string frame_bytes(const Json& header, const std::string& payload = {});

/// One end of the socket. A process that its owner forked ends where it sends or receives: only the first one speaks.
class Channel {
 public:
  /// `socket` is taken. `wait(events)` is called where it is not ready for POLLIN or POLLOUT, and returns once it may
  /// be.
  Channel(Descriptor socket, std::function<void(short events)> wait);

  /// `file` is lent. @throws MethodError for a frame over the limits. A peer that is gone is seen by receive().
  void send(const Json& header, const std::string& payload = {}, const Descriptor* file = nullptr);
  /// The next frame; none once the peer is gone. @throws Malformed with the reason for what is no frame.
  std::optional<Frame> receive();

  int socket() const { return socket_.fd; }

 private:
  bool take(char* bytes, std::size_t size, Descriptor& file);
  void expect_owner() const;

  Descriptor socket_;
  std::function<void(short events)> wait_;
  pid_t owner_;
};

}  // namespace lgabench
