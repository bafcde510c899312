#include <lgabench/host/frames.hpp>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>

namespace lgabench {
namespace {

// Little-endian on the socket, as on every processor that lgabench_plugin is known to work on (fingerprint.hpp).
struct Prefix {
  std::array<char, 4> magic;
  std::uint32_t header_bytes, payload_bytes, crc32;  // the checksum is that of header and payload
};
static_assert(sizeof(Prefix) == 16, "no padding");
constexpr std::array<char, 4> magic{'L', 'G', 'A', '1'};

std::uint32_t crc32(const std::string& header, const std::string& payload) {
  boost::crc_32_type crc;
  crc.process_bytes(header.data(), header.size());
  crc.process_bytes(payload.data(), payload.size());
  return crc.checksum();
}

[[noreturn]] void malformed(const std::string& why) { throw Malformed(why); }

void check_size(const char* what, std::uint32_t bytes, std::uint32_t most) {
  if (bytes > most) malformed(fmt::format("{} of {} bytes, at most {} are allowed", what, bytes, most));
}

Json parse_header(const std::string& text) {
  Json header;
  try {
    header = parse_json(text, "header");
  } catch (const InputError& e) {
    malformed(e.what());
  }
  if (!header.is_object() || !header.contains("type") || !header["type"].is_string())
    malformed("the header is no object with a \"type\"");
  return header;
}

}  // namespace

std::string Frame::type() const { return header.at("type").get<std::string>(); }

Channel::Channel(Descriptor socket, std::function<void(short events)> wait)
    : socket_(std::move(socket)), wait_(std::move(wait)), owner_(::getpid()) {}

void Channel::expect_owner() const {
  if (::getpid() != owner_) ::_exit(1);
}

std::string frame_bytes(const Json& header, const std::string& payload) {
  const std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > most_header_bytes || payload.size() > most_payload_bytes)
    throw MethodError(fmt::format("a frame \"{}\" with a header of {} and a payload of {} bytes is over the limits",
                                  header.value("type", ""), text.size(), payload.size()));
  const Prefix prefix{magic, static_cast<std::uint32_t>(text.size()), static_cast<std::uint32_t>(payload.size()),
                      crc32(text, payload)};
  std::string bytes(sizeof prefix, 0);
  std::memcpy(bytes.data(), &prefix, sizeof prefix);
  bytes += text;
  bytes += payload;
  return bytes;
}

void Channel::send(const Json& header, const std::string& payload, const Descriptor* file) {
  expect_owner();
  std::string bytes = frame_bytes(header, payload);
  for (std::size_t done = 0; done < bytes.size();) {
    iovec part{bytes.data() + done, bytes.size() - done};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    if (file && done == 0) {  // goes with the first byte
      message.msg_control = control;
      message.msg_controllen = sizeof control;
      cmsghdr* rights = CMSG_FIRSTHDR(&message);
      rights->cmsg_level = SOL_SOCKET;
      rights->cmsg_type = SCM_RIGHTS;
      rights->cmsg_len = CMSG_LEN(sizeof(int));
      std::memcpy(CMSG_DATA(rights), &file->fd, sizeof(int));
    }
    const ssize_t n = ::sendmsg(socket_.fd, &message, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n >= 0)
      done += static_cast<std::size_t>(n);
    else if (errno == EAGAIN)
      wait_(POLLOUT);
    else if (errno != EINTR)
      return;  // the peer is gone
  }
}

bool Channel::take(char* bytes, std::size_t size, Descriptor& file) {
  for (std::size_t done = 0; done < size;) {
    iovec part{bytes + done, size - done};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    message.msg_control = control;
    message.msg_controllen = CMSG_LEN(sizeof(int));  // of one descriptor: padding would have room for a second
    const ssize_t n = ::recvmsg(socket_.fd, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (n < 0 && errno == EAGAIN) {
      wait_(POLLIN);
      continue;
    }
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    for (cmsghdr* rights = CMSG_FIRSTHDR(&message); rights; rights = CMSG_NXTHDR(&message, rights)) {
      if (rights->cmsg_level != SOL_SOCKET || rights->cmsg_type != SCM_RIGHTS) continue;
      int received = -1;
      std::memcpy(&received, CMSG_DATA(rights), sizeof received);
      file = Descriptor(received);
    }
    done += static_cast<std::size_t>(n);
  }
  return true;
}

std::optional<Frame> Channel::receive() {
  expect_owner();
  Frame frame;
  Prefix prefix{};
  if (!take(reinterpret_cast<char*>(&prefix), sizeof prefix, frame.file)) return std::nullopt;
  if (prefix.magic != magic) malformed("its first bytes are not those of a frame");
  check_size("a header", prefix.header_bytes, most_header_bytes);
  check_size("a payload", prefix.payload_bytes, most_payload_bytes);
  std::string header(prefix.header_bytes, 0);
  frame.payload.resize(prefix.payload_bytes);
  if (!take(header.data(), header.size(), frame.file) || !take(frame.payload.data(), frame.payload.size(), frame.file))
    return std::nullopt;
  if (crc32(header, frame.payload) != prefix.crc32) malformed("its checksum does not match");
  frame.header = parse_header(header);
  return frame;
}

}  // namespace lgabench
