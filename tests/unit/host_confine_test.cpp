// What a confined process opens; tests/integration/confine_test.py tries it from inside a method.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <lgabench/host/confine.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

bool opens(const Confinement& confinement, const fs::path& file) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(confinement.apply() ? (::open(file.c_str(), O_RDONLY) < 0 ? 1 : 0) : 2);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) < 2);
  return status == 0;
}

TEST(Confinement, ALinkBesideWhatIsHiddenOpensNothingElsewhere) {
  if (landlock_version() == 0) GTEST_SKIP() << "this kernel has no Landlock";
  const TemporaryDirectory reads, elsewhere;
  for (const fs::path& file : {reads.path / "hidden", reads.path / "file", elsewhere.path / "secret"})
    write_file(file, "text");
  fs::create_symlink(elsewhere.path / "secret", reads.path / "link");
  const Confinement confinement({{reads.path}, {}, {reads.path / "hidden"}});
  EXPECT_TRUE(opens(confinement, reads.path / "file"));
  EXPECT_FALSE(opens(confinement, reads.path / "hidden"));
  EXPECT_FALSE(opens(confinement, reads.path / "link"));
}

}  // namespace
}  // namespace lgabench
