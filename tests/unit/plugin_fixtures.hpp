// Where the test plugins lie, and directories made of some of them.
#pragma once
#include <string>

#include "testing.hpp"

namespace lgabench {

/// "refused/wrong_sdk" -> its library.
inline fs::path fixture(const std::string& name) { return fs::path(LGABENCH_TEST_PLUGINS) / (name + ".so"); }

/// A directory for plugins.
class Directory : public TemporaryDirectory {
 public:
  fs::path copy(const std::string& name) const {
    const fs::path to = path / fixture(name).filename();
    fs::copy_file(fixture(name), to);
    return to;
  }
  fs::path write(const std::string& name, const std::string& bytes) const {
    write_file(path / name, bytes);
    return path / name;
  }
};

}  // namespace lgabench
