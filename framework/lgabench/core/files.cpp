#include <lgabench/core/files.hpp>

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <random>

#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/directories.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/plain_directory.hpp>

namespace lgabench {
namespace {

[[noreturn]] void fail(const fs::path& file, const char* wanted) {
  throw InputError(fmt::format("{}: {}: {}", file.string(), wanted, std::strerror(errno)));
}

[[noreturn]] void refuse_link(const fs::path& file) {
  throw InputError(fmt::format("{}: a symbolic link, which a run may not hold", file.string()));
}

// False, with errno set, if not all of it could be written.
bool write_all(int fd, std::string_view bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

// `name`: the file's, within the directory; `file`: what a message calls it.
std::string read_at(int directory, const fs::path& name, const fs::path& file, Links links, std::uintmax_t most) {
  // Without O_NONBLOCK opening a pipe waits for a writer.
  const int flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | (links == Links::refused ? O_NOFOLLOW : 0);
  const Descriptor in{::openat(directory, name.c_str(), flags)};
  if (in.fd < 0 && errno == ELOOP && links == Links::refused) refuse_link(file);
  struct stat about {};
  if (in.fd < 0 || ::fstat(in.fd, &about) != 0) fail(file, "cannot be read");
  if (!S_ISREG(about.st_mode)) throw InputError(fmt::format("{}: cannot be read: not a regular file", file.string()));
  const auto expect_within = [&](std::uintmax_t size) {
    if (size > most)
      throw InputError(
          fmt::format("{}: cannot be read: {} bytes or more, expected at most {}", file.string(), size, most));
  };
  expect_within(static_cast<std::uintmax_t>(about.st_size));
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(about.st_size));
  char block[1 << 16];
  for (;;) {
    const ssize_t n = ::read(in.fd, block, sizeof block);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(file, "cannot be read");
    if (n == 0) return bytes;
    bytes.append(block, static_cast<std::size_t>(n));
    expect_within(bytes.size());
  }
}

}  // namespace

std::string read_file(const fs::path& file, Links links, std::uintmax_t most) {
  return read_at(AT_FDCWD, file, file, links, most);
}

PlainDirectory::PlainDirectory(const fs::path& path)
    : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {}

PlainDirectory::~PlainDirectory() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::vector<std::string> PlainDirectory::kept_names() const {
  constexpr std::size_t most = 100, longest = 100;
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  std::vector<std::string> names;
  // Opened anew: a duplicate would share the place at which reading goes on.
  const int listed = descriptor_ < 0 ? -1 : ::openat(descriptor_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  DIR* const stream = listed < 0 ? nullptr : ::fdopendir(listed);
  if (!stream && listed >= 0) ::close(listed);
  struct stat about {};
  while (const dirent* entry = stream ? ::readdir(stream) : nullptr) {
    const std::string_view name = entry->d_name;
    const bool plain = name[0] != '.' && name.size() <= longest && name.find_first_not_of(allowed) == name.npos;
    if (plain && ::fstatat(descriptor_, entry->d_name, &about, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(about.st_mode))
      names.emplace_back(name);
  }
  if (stream) ::closedir(stream);
  std::sort(names.begin(), names.end());
  names.resize(std::min(names.size(), most));
  return names;
}

std::string PlainDirectory::read_file(const std::string& name, std::uintmax_t most) const {
  return read_at(descriptor_, name, path_ / name, Links::refused, most);
}

void expect_plain_entries(const fs::path& directory) {
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(directory, none_there)) {
    // As the directory tells them: symlink_status() would ask the file system again.
    if (entry.is_symlink()) refuse_link(entry.path());
    if (!entry.is_regular_file() && !entry.is_directory())
      throw InputError(fmt::format("{}: expected a regular file or a directory", entry.path().string()));
  }
}

void write_file(const fs::path& file, std::string_view bytes, Sync sync) {
  const std::string why = file.has_parent_path() ? try_make_directories(file.parent_path()) : "";
  if (!why.empty()) throw InputError(fmt::format("{}: cannot be written: {}", file.string(), why));

  fs::path temporary = file;
  Descriptor out;
  if (sync == Sync::later) {
    out.fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  } else {  // a name that no other process takes, on no machine that shares the directory
    std::random_device random;
    do {
      temporary = fmt::format("{}.{:08x}.tmp", file.string(), random());
      out.fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    } while (out.fd < 0 && errno == EEXIST);
  }
  if (out.fd < 0) fail(file, "cannot be written");
  const auto give_up = [&](const char* wanted) {
    const int reason = errno;
    ::unlink(temporary.c_str());
    errno = reason;
    fail(file, wanted);
  };
  if (!write_all(out.fd, bytes)) give_up("cannot be written");
  if (sync == Sync::later) return;
  if (::fsync(out.fd) != 0) give_up("cannot be written to disk");
  if (::rename(temporary.c_str(), file.c_str()) != 0) give_up("cannot be written");
}

void append_file(const fs::path& file, std::string_view bytes) {
  const Descriptor out{::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644)};
  if (out.fd < 0) fail(file, "cannot be written");
  const off_t before = ::lseek(out.fd, 0, SEEK_END);
  if (write_all(out.fd, bytes) && ::fsync(out.fd) == 0) return;
  const int reason = errno;
  [[maybe_unused]] const int taken_back = ::ftruncate(out.fd, before);
  errno = reason;
  fail(file, "cannot be written");
}

void remove_temporaries(const fs::path& directory) {
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(directory, none_there))
    if (is_temporary(entry.path())) fs::remove(entry.path(), none_there);
}

bool is_temporary(const fs::path& file) { return file.extension() == ".tmp"; }

std::vector<std::string> json_names(const fs::path& directory, std::error_code& error) {
  std::vector<std::string> names;
  for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".json") names.push_back(it->path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

void sync_directory(const fs::path& directory) {
  const Descriptor d{::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  // EINVAL: a file system that syncs no directories, and has names on the disk when files are.
  if (d.fd < 0 || (::fsync(d.fd) != 0 && errno != EINVAL)) fail(directory, "cannot be synced");
}

void sync_file_system(const fs::path& directory) {
  const Descriptor d{::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (d.fd < 0 || ::syncfs(d.fd) != 0) fail(directory, "cannot be synced");
}

fs::path program_directory() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (error) throw InputError("/proc/self/exe: cannot be read: " + error.message());
  return self.parent_path();
}

fs::path library_directory() {
  static const fs::path directory = [] {  // asked for with each file that is read
    Dl_info here;
    if (::dladdr(reinterpret_cast<const void*>(&library_directory), &here) == 0)
      throw InputError("dladdr: lgabench's library is not found");
    return fs::canonical(here.dli_fname).parent_path();
  }();
  return directory;
}

fs::path data_directory() {
  if (const char* named = std::getenv("LGABENCH_DATA"); named && *named) {
    expect_directory("LGABENCH_DATA", named);
    return named;
  }
  return library_directory().parent_path() / "share" / "lgabench";
}

fs::path encoder_directory() {
  const char* named = std::getenv("LGABENCH_ENCODER");
  return named && *named ? fs::path(named) : data_directory() / "encoder";
}

bool has_encoder_library() { return fs::exists(library_directory() / "liblgabench_encoder.so"); }

std::string encoder_remedy() {
  return has_encoder_library() ? "lgabench encoder fetch gets it"
                               : "it needs LibTorch, which this installation lacks and one by ./install has";
}

fs::path shipped_plugin_directory() { return library_directory() / "lgabench" / "plugins"; }

}  // namespace lgabench
