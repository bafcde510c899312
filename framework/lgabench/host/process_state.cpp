#include <lgabench/host/process_state.hpp>

#include <malloc.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>

namespace lgabench {
namespace {

std::vector<std::string> difference(const std::vector<std::string>& all, const std::vector<std::string>& without) {
  std::vector<std::string> more;
  std::set_difference(all.begin(), all.end(), without.begin(), without.end(), std::back_inserter(more));
  return more;
}

// Describes each entry of a directory of /proc, which may be gone by the time it is read.
template <class Describe>
std::vector<std::string> entries(const fs::path& directory, Describe describe) {
  std::vector<std::string> all;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(directory)) {
    const std::string text = describe(entry.path(), gone);
    if (!gone) all.push_back(text);
  }
  std::sort(all.begin(), all.end());
  return all;
}

// Takes blocks of every size for good: the heap then gives out other addresses, also where the system does not
// randomise them.
void shift_heap() {
  static std::vector<std::unique_ptr<char[]>> kept;
  constexpr std::size_t small = 1024, blocks = 32, large = 1 << 20;
  kept.reserve(small / 16 * blocks + 1);
  for (std::size_t size = 16; size <= small; size += 16)
    for (std::size_t i = 0; i < blocks; ++i) kept.push_back(std::make_unique<char[]>(size - 8));
  kept.push_back(std::make_unique<char[]>(large));
}

}  // namespace

ProcessState ProcessState::now() {
  ProcessState state;
  state.threads = entries("/proc/self/task", [](const fs::path& task, std::error_code&) { return task.filename(); });
  state.descriptors = entries("/proc/self/fd", [](const fs::path& link, std::error_code& gone) {
    return fs::read_symlink(link, gone).string();
  });
  const struct mallinfo2 heap = ::mallinfo2();
  state.heap_bytes = static_cast<long long>(heap.uordblks + heap.hblkhd);
  return state;
}

ProcessState ProcessState::beyond(const ProcessState& before) const {
  ProcessState more = *this;
  more.threads = difference(threads, before.threads);
  more.descriptors = difference(descriptors, before.descriptors);
  return more;
}

void perturb_heap(int byte) {
  if (byte != 0) shift_heap();
  ::mallopt(M_PERTURB, byte);
}

}  // namespace lgabench
