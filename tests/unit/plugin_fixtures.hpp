// Where the test plugins lie, and directories made of some of them.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include <lgabench/core/files.hpp>

namespace lgabench {

/// "refused/wrong_sdk" -> its library.
inline fs::path fixture(const std::string& name) { return fs::path(LGABENCH_TEST_PLUGINS) / (name + ".so"); }

/// A new directory, removed at the end.
class Directory {
 public:
  Directory() {
    static int count = 0;
    path_ = fs::temp_directory_path() /
            ("lgabench-plugin-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    fs::create_directories(path_);
  }
  ~Directory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  const fs::path& path() const { return path_; }
  fs::path copy(const std::string& name) const {
    const fs::path to = path_ / fixture(name).filename();
    fs::copy_file(fixture(name), to);
    return to;
  }
  fs::path write(const std::string& name, const std::string& bytes) const {
    write_file(path_ / name, bytes);
    return path_ / name;
  }

 private:
  fs::path path_;
};

inline void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
}

/// what() of the Expected that `call` throws.
template <class Expected, class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const Expected& e) {
    return e.what();
  } catch (const std::exception& e) {
    ADD_FAILURE() << "another exception: " << e.what();
    return {};
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

}  // namespace lgabench
