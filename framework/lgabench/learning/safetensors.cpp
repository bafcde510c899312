#include <lgabench/learning/safetensors.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>

#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {

Safetensors::Safetensors(const fs::path& file, const std::string& sum) : file_(file.string()) {
  const std::string bytes = read_file(file);
  if (!sum.empty())
    if (const std::string found = sha256(bytes); found != sum)
      throw InputError(fmt::format("{}: expected the weights with SHA-256 {}, got {}", file_, sum, found));
  std::uint64_t header_size = 0;
  constexpr std::size_t prefix = sizeof header_size;
  if (bytes.size() < prefix) throw InputError(file_ + ": expected safetensors, got fewer than 8 bytes");
  std::memcpy(&header_size, bytes.data(), prefix);  // little-endian, as every machine that this is built for
  if (header_size > bytes.size() - prefix)
    throw InputError(
        fmt::format("{}: expected a header of {} bytes, got a file of {}", file_, header_size, bytes.size()));
  const std::size_t data = prefix + header_size, data_size = bytes.size() - data;
  const Json header = parse_json(std::string_view(bytes).substr(prefix, header_size), file_ + ": header in JSON");
  if (!header.is_object()) throw InputError(file_ + ": expected a header in JSON that is an object");

  for (const auto& [name, value] : header.items()) {
    if (name == "__metadata__") continue;
    const JsonReader entry(value, file_, "/" + name);
    if (entry.at("dtype").string() != "F32") continue;
    constexpr long long most = 1LL << 40;
    Entry read{{}, numbers_.size(), 1};
    for (const JsonReader& extent : entry.at("shape").elements()) {
      read.shape.push_back(extent.integer(1, most));
      const auto times = static_cast<std::size_t>(read.shape.back());
      if (times > data_size / read.count) entry.at("shape").fail("no more numbers than the file holds");
      read.count *= times;
    }
    const auto offsets = entry.at("data_offsets").elements();
    if (offsets.size() != 2) entry.at("data_offsets").fail("[begin, end]");
    const auto begin = static_cast<std::size_t>(offsets[0].integer(0, most)),
               end = static_cast<std::size_t>(offsets[1].integer(0, most));
    if (end > data_size || begin > end || end - begin != read.count * sizeof(float))
      entry.at("data_offsets")
          .fail(fmt::format("{} bytes within the file's {}", read.count * sizeof(float), data_size));
    numbers_.resize(read.begin + read.count);
    std::memcpy(numbers_.data() + read.begin, bytes.data() + data + begin, end - begin);
    entries_.emplace(name, std::move(read));
  }
}

const float* Safetensors::get(const std::string& name, const std::vector<std::int64_t>& shape) const {
  const auto found = entries_.find(name);
  if (found == entries_.end() || found->second.shape != shape)
    throw InputError(fmt::format("{}: expected a tensor \"{}\" of type F32 and shape {}", file_, name, shape));
  return numbers_.data() + found->second.begin;
}

}  // namespace lgabench
