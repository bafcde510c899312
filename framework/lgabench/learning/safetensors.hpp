// Weights in the safetensors format: a length, a JSON header, the numbers.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lgabench {

/// The single-precision tensors of a file, checked: every size and place agrees with the file. Owns the numbers.
class Safetensors {
 public:
  /// `sum`: the file's SHA-256, "" for any. @throws InputError with file and place if the file cannot be read, has
  /// another sum or differs from its header.
  explicit Safetensors(const std::filesystem::path& file, const std::string& sum = "");

  /// The numbers of a tensor, row-major; valid as long as this object.
  /// @throws InputError where there is none of that name, type F32 and shape.
  const float* get(const std::string& name, const std::vector<std::int64_t>& shape) const;

 private:
  struct Entry {
    std::vector<std::int64_t> shape;
    std::size_t begin, count;  // in numbers_
  };
  std::string file_;
  std::vector<float> numbers_;
  std::map<std::string, Entry> entries_;
};

}  // namespace lgabench
