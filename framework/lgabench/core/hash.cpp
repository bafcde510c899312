#include <lgabench/core/hash.hpp>

#include <fmt/format.h>
#include <openssl/evp.h>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>

namespace lgabench {

std::uint64_t hash64(std::string_view bytes) {
  std::uint64_t h = 0xcbf29ce484222325ULL;
  for (const char c : bytes) {
    h ^= static_cast<unsigned char>(c);
    h *= 0x100000001b3ULL;
  }
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
  return h ^ (h >> 31);
}

std::string hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

std::string sha256(std::string_view bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest, &size, EVP_sha256(), nullptr) != 1)
    throw Error("libcrypto could not compute a SHA-256");
  return fmt::format("{:02x}", fmt::join(digest, digest + size, ""));
}

std::string sha256_file(const std::filesystem::path& file) { return sha256(read_file(file)); }

}  // namespace lgabench
