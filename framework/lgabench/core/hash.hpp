// Stable hashes: the same on every machine and in every version.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace lgabench {

/// 64-bit FNV-1a over the bytes, finished with SplitMix64's mixer so that near inputs differ in every bit.
std::uint64_t hash64(std::string_view bytes);

/// 16 hexadecimal digits.
std::string hex(std::uint64_t value);

/// SHA-256 of the bytes, 64 hexadecimal digits (OpenSSL's libcrypto).
std::string sha256(std::string_view bytes);

/// SHA-256 of a file's contents. @throws InputError where it cannot be read.
std::string sha256_file(const std::filesystem::path& file);

}  // namespace lgabench
