// A peer's bytes as frames. Checksums are put right, since chance finds none.
#include "frames.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <cstring>

namespace {

// A frame's first bytes: LGA1, the length of its header and of its payload, its checksum.
constexpr std::size_t prefix_bytes = 16, lengths_at = 4, checksum_at = 12;

std::string with_checksums(std::string bytes) {
  for (std::size_t at = 0; bytes.size() - at >= prefix_bytes;) {
    std::uint32_t lengths[2];
    std::memcpy(lengths, bytes.data() + at + lengths_at, sizeof lengths);
    const std::size_t body = std::size_t{lengths[0]} + lengths[1];
    if (body > bytes.size() - at - prefix_bytes) break;
    boost::crc_32_type crc;
    crc.process_bytes(bytes.data() + at + prefix_bytes, body);
    const std::uint32_t sum = crc.checksum();
    std::memcpy(bytes.data() + at + checksum_at, &sum, sizeof sum);
    at += prefix_bytes + body;
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  if (size > fuzz::most_said) return 0;
  const std::string bytes = with_checksums(std::string(fuzz::text_of(data, size)));
  fuzz::Ends ends = fuzz::ends();
  if (::send(ends.theirs.fd, bytes.data(), bytes.size(), MSG_DONTWAIT) != static_cast<ssize_t>(bytes.size())) return 0;
  ends.theirs.close();
  Channel channel = fuzz::channel_of(std::move(ends.ours));
  try {
    while (const std::optional<Frame> frame = channel.receive()) canonical(frame->type());
  } catch (const Malformed&) {
  }
  return 0;
}
