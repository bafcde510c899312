#include <lgabench/learning/archive.hpp>

#include <cstring>

namespace lgabench {

void Archive::move(void* value, std::size_t size) {
  if (!reads_) {
    bytes_.append(static_cast<const char*>(value), size);
    return;
  }
  if (size > bytes_.size() - at_) fail();
  std::memcpy(value, bytes_.data() + at_, size);
  at_ += size;
}

}  // namespace lgabench
