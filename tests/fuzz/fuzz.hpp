// What fuzz targets share. A target lets the errors go that its reader documents; whatever else escapes is a finding.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <lgabench/core/scratch.hpp>

/// One target. Called with any bytes, again and again in one process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace lgabench::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A directory of this process's own, gone at its end.
inline const fs::path& directory() {
  static const Scratch scratch("fuzz");
  return scratch.path;
}

/// Writes the bytes without waiting for a disk, and makes missing parents. What cannot be named like this is not there.
inline fs::path write(const fs::path& file, std::string_view bytes) {
  std::ofstream out(file, std::ios::binary);
  if (!out) {
    std::error_code not_made;
    fs::create_directories(file.parent_path(), not_made);
    out.open(file, std::ios::binary);
  }
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

/// Has the library read its installed data from data/, a few scenarios and spaces of a few words, until the process
/// ends: what a stranger's bytes name is read again for every input.
inline void use_small_data() {
  static const int used [[maybe_unused]] = ::setenv("LGABENCH_DATA", LGABENCH_FUZZ_DATA, 1);
}

/// Whether what takes long is done with these bytes as well: with one input in so many of a fuzzer, with all of the
/// corpus where a test plays it. The same bytes are answered the same.
inline bool takes_long([[maybe_unused]] std::string_view bytes, [[maybe_unused]] std::size_t one_in = 1000) {
#ifdef LGABENCH_FUZZ
  return std::hash<std::string_view>()(bytes) % one_in == 0;
#else
  return true;
#endif
}

/// The text's parts between separators; one more than there are of these.
inline std::vector<std::string_view> split(std::string_view text, std::string_view separator) {
  std::vector<std::string_view> parts;
  for (std::size_t at; (at = text.find(separator)) != text.npos; text.remove_prefix(at + separator.size()))
    parts.push_back(text.substr(0, at));
  parts.push_back(text);
  return parts;
}

}  // namespace lgabench::fuzz
