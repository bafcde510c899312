// What a learner learned, as bytes and back.
#pragma once
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <lgabench/core/error.hpp>

namespace lgabench {

/// Writes values one after another, or reads them in that order. A class names its members to an archive in one
/// function, which then does both. Numbers are stored as this machine has them in memory. One thread.
class Archive {
 public:
  /// An archive that writes.
  Archive() = default;
  /// An archive that reads these bytes.
  explicit Archive(std::string bytes) : reads_(true), bytes_(std::move(bytes)) {}

  bool reads() const { return reads_; }
  /// What was written.
  const std::string& bytes() const { return bytes_; }

  /// Writes or reads a value. @throws InputError where the bytes end too early.
  template <class T>
  std::enable_if_t<std::is_trivially_copyable_v<T>> operator()(T& value) {
    move(&value, sizeof value);
  }
  /// A bool is one byte. @throws InputError for a byte other than 0 or 1, which no bool may hold.
  void operator()(bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    (*this)(byte);
    if (byte > 1) fail();
    value = byte == 1;
  }
  /// A vector is its length, then each value.
  template <class T>
  void operator()(std::vector<T>& values) {
    const std::uint64_t count = counted(values.size());
    if (reads_) values.resize(static_cast<std::size_t>(count));
    if constexpr (std::is_trivially_copyable_v<T>) {
      if (count > 0) move(values.data(), values.size() * sizeof(T));
    } else {
      for (T& value : values) (*this)(value);
    }
  }
  /// A text is its length, then each byte.
  void operator()(std::string& text) {
    const std::uint64_t count = counted(text.size());
    if (reads_) text.resize(static_cast<std::size_t>(count));
    move(text.data(), text.size());
  }
  /// Call it after the last value was read. @throws InputError if bytes are left over.
  void expect_end() const {
    if (reads_ && at_ != bytes_.size()) fail();
  }
  /// Call it for values that were read and do not fit. @throws InputError, always.
  [[noreturn]] static void fail() { throw InputError("saved policy: damaged, or saved by another method"); }

 private:
  // A count that is read is no larger than what is left: nothing is made for bytes that are not there.
  std::uint64_t counted(std::uint64_t count) {
    (*this)(count);
    if (reads_ && count > bytes_.size() - at_) fail();
    return count;
  }
  void move(void* value, std::size_t size);

  bool reads_ = false;
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace lgabench
