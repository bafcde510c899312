#include <lgabench/core/directories.hpp>

#include <fmt/format.h>

#include <cstdlib>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

// The first part of the path that is a link to what is not there, or a file; "" where the system refused.
std::string in_the_way(const fs::path& directory) {
  fs::path part;
  std::error_code error;
  if (directory.is_relative() && fs::current_path(error).empty()) return "the current directory is gone";
  for (const fs::path& name : directory) {
    part /= name;
    const fs::file_status itself = fs::symlink_status(part, error), led_to = fs::status(part, error);
    if (fs::is_symlink(itself) && !fs::exists(led_to))
      return fmt::format("{} is a symbolic link to {}, which is not there", part.string(),
                         fs::read_symlink(part, error).string());
    if (fs::exists(led_to) && !fs::is_directory(led_to)) return part.string() + " is not a directory";
    if (!fs::exists(itself)) break;
  }
  return "";
}

}  // namespace

std::string try_make_directories(const fs::path& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (!error) return "";
  const std::string found = in_the_way(directory);
  return found.empty() ? error.message() : found;
}

void make_directories(const fs::path& directory) {
  if (const std::string why = try_make_directories(directory); !why.empty())
    throw InputError(fmt::format("{}: cannot be made: {}", directory.string(), why));
}

void expect_directory(const char* variable, const fs::path& value) {
  if (std::error_code error; !fs::is_directory(value, error))
    throw InputError(fmt::format("{}={}: {}", variable, value.string(), error ? error.message() : "not a directory"));
}

fs::path temporary_directory() {
  std::string variable, value = "/tmp";
  for (const char* name : {"TMPDIR", "TMP", "TEMP", "TEMPDIR"})
    if (const char* named = std::getenv(name); variable.empty() && named && *named) variable = name, value = named;
  std::error_code error;
  if (fs::is_directory(value, error)) return value;
  throw InputError(fmt::format("{}{}: {}; set TMPDIR to a directory for temporary files",
                               variable.empty() ? "" : variable + "=", value,
                               error ? error.message() : "not a directory"));
}

}  // namespace lgabench
