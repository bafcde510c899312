#include <lgabench/core/tree.hpp>

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <memory>
#include <string_view>
#include <vector>

#include <lgabench/core/descriptor.hpp>

namespace lgabench {
namespace {

// By the descriptor: in the place of the name there may be a link by now.
void make_accessible(int directory, const char* name) {
  const Descriptor itself(::openat(directory, name, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (itself.fd >= 0) ::chmod(fmt::format("/proc/self/fd/{}", itself.fd).c_str(), 0700);
}

Descriptor open_directory(int directory, const char* name) {
  constexpr int how = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
  Descriptor opened(::openat(directory, name, how));
  if (opened.fd >= 0 || errno != EACCES) return opened;
  make_accessible(directory, name);
  return Descriptor(::openat(directory, name, how));
}

// `of_entry` returns whether to go on.
template <class OfEntry>
void for_entries(int directory, OfEntry of_entry) {
  struct Closes {
    void operator()(DIR* stream) const { ::closedir(stream); }
  };
  Descriptor listed = open_directory(directory, ".");  // anew: a duplicate would share the place where reading goes on
  const std::unique_ptr<DIR, Closes> stream(listed.fd < 0 ? nullptr : ::fdopendir(listed.fd));
  if (!stream) return;
  listed.fd = -1;  // the stream's
  while (const dirent* entry = ::readdir(stream.get())) {
    const std::string_view name = entry->d_name;
    if (name != "." && name != ".." && !of_entry(entry->d_name)) return;
  }
}

std::vector<std::string> entry_names(int directory) {
  std::vector<std::string> names;
  for_entries(directory, [&names](const char* name) {
    names.emplace_back(name);
    return true;
  });
  return names;
}

void measure(int directory, int depth, std::uintmax_t most_files, TreeSize& size) {
  constexpr int deepest = 100;
  for_entries(directory, [&](const char* name) {
    struct stat about {};
    if (::fstatat(directory, name, &about, AT_SYMLINK_NOFOLLOW) != 0) return true;
    ++size.files;
    size.bytes += static_cast<std::uintmax_t>(about.st_blocks) * 512;
    if (S_ISDIR(about.st_mode)) {
      if (depth == deepest)
        size.files = most_files + 1;
      else if (const Descriptor below = open_directory(directory, name); below.fd >= 0)
        measure(below.fd, depth + 1, most_files, size);
    }
    return size.files <= most_files;
  });
}

}  // namespace

TreeSize tree_size(int directory, std::uintmax_t most_files) {
  TreeSize size;
  measure(directory, 1, most_files, size);
  return size;
}

void remove_tree(const fs::path& directory) {
  const Descriptor top = open_directory(AT_FDCWD, directory.c_str());
  if (top.fd < 0) return;
  // Directories within others come up to the top before those are removed: no depth is too deep.
  std::uint64_t number = 0;
  for (bool moved = true; moved;) {
    moved = false;
    for (const std::string& name : entry_names(top.fd)) {
      if (::unlinkat(top.fd, name.c_str(), 0) == 0) continue;
      const Descriptor below = open_directory(top.fd, name.c_str());
      for (const std::string& inner : below.fd < 0 ? std::vector<std::string>() : entry_names(below.fd)) {
        if (::unlinkat(below.fd, inner.c_str(), 0) == 0 || ::unlinkat(below.fd, inner.c_str(), AT_REMOVEDIR) == 0)
          continue;
        make_accessible(below.fd, inner.c_str());
        std::string up;
        do up = fmt::format("{}.up", number++);
        while (::faccessat(top.fd, up.c_str(), F_OK, AT_SYMLINK_NOFOLLOW) == 0);
        moved |= ::renameat(below.fd, inner.c_str(), top.fd, up.c_str()) == 0;
      }
      ::unlinkat(top.fd, name.c_str(), AT_REMOVEDIR);
    }
  }
  ::rmdir(directory.c_str());
}

}  // namespace lgabench
