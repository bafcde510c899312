#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include <lgabench/core/filled.hpp>
#include <lgabench/core/process.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

// A file that a process writes to.
struct Written {
  explicit Written(const fs::path& file) : path(file), fd(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {}
  ~Written() { ::close(fd); }
  Written(const Written&) = delete;
  Written& operator=(const Written&) = delete;
  std::string bytes() const { return read_file(path); }

  fs::path path;
  int fd;
};

int exit_status(const ProcessStart& start) {
  const int status = wait_for(start_process(start));
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Process, HoldsWhatItIsGivenAndNothingElse) {
  const TemporaryDirectory directory;
  const Written first(directory.path / "first"), second(directory.path / "second");
  // Each has the number that the other one gets.
  ASSERT_LT(first.fd, second.fd);
  const Written out(directory.path / "out"), kept_open(directory.path / "kept_open");
  ::fcntl(kept_open.fd, F_SETFD, 0);
  ASSERT_LT(kept_open.fd, 10) << "a shell's redirections have one digit";
  const std::string script =
      fmt::format("echo one >&{}; echo two >&{}; echo $X$HOME; pwd; [ -e /proc/$$/fd/{} ] || echo closed", second.fd,
                  first.fd, kept_open.fd);
  EXPECT_EQ(exit_status({{"sh", "-c", script},
                         {"PATH=/usr/bin:/bin", "X=set"},
                         {{first.fd, second.fd}, {second.fd, first.fd}, {out.fd, 1}},
                         directory.path}),
            0);
  EXPECT_EQ(first.bytes(), "one\n");
  EXPECT_EQ(second.bytes(), "two\n");
  EXPECT_EQ(out.bytes(), "set\n" + fs::canonical(directory.path).string() + "\nclosed\n");
}

TEST(Process, AVariableThatIsSetReplacesOurs) {
  ::setenv("LGABENCH_A", "ours", 1);
  ::setenv("LGABENCH_AB", "ours", 1);
  const auto all = environment_with({"LGABENCH_A=set"});
  ::unsetenv("LGABENCH_A");
  ::unsetenv("LGABENCH_AB");
  EXPECT_EQ(std::count(all.begin(), all.end(), "LGABENCH_A=set"), 1);
  EXPECT_EQ(std::count(all.begin(), all.end(), "LGABENCH_A=ours"), 0);
  EXPECT_EQ(std::count(all.begin(), all.end(), "LGABENCH_AB=ours"), 1);
}

TEST(Templates, AreFilledInOnePass) {
  EXPECT_EQ(filled("@A@ and @B@, @A@ @C@", {{"@A@", "@B@"}, {"@B@", "b"}}), "@B@ and b, @B@ @C@");
}

}  // namespace
}  // namespace lgabench
