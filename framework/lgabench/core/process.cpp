#include <lgabench/core/process.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

// As exec takes them: pointers into the words, and a null pointer at the end.
std::vector<char*> pointers(const std::vector<std::string>& words) {
  std::vector<char*> all;
  for (const std::string& word : words) all.push_back(const_cast<char*>(word.c_str()));
  all.push_back(nullptr);
  return all;
}

}  // namespace

std::vector<std::string> environment_with(const std::vector<std::string>& set) {
  const auto name = [](const std::string& variable) { return variable.substr(0, variable.find('=') + 1); };
  std::vector<std::string> all = set;
  for (char** variable = environ; *variable; ++variable) {
    const std::string text = *variable;
    const auto same = [&](const std::string& one) { return name(one) == name(text); };
    if (std::none_of(set.begin(), set.end(), same)) all.push_back(text);
  }
  return all;
}

pid_t start_process(const ProcessStart& start) {
  // Nothing is allocated between fork and exec, but by in_child.
  const std::vector<char*> words = pointers(start.words), variables = pointers(start.variables);
  int last = 2;
  for (const auto& [ours, its] : start.descriptors) last = std::max(last, its);
  std::vector<int> spare(start.descriptors.size());
  const pid_t parent = ::getpid();

  const pid_t pid = ::fork();
  if (pid < 0) throw InputError(fmt::format("fork: {}", std::strerror(errno)));
  if (pid > 0) return pid;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(not_started);  // which died before that took effect
  if (!start.directory.empty() && ::chdir(start.directory.c_str()) != 0) ::_exit(not_started);
  if (start.in_child && !start.in_child()) ::_exit(126);
  // By way of numbers beyond all that are wanted: one may be another's, and dup2 onto itself would keep CLOEXEC.
  for (std::size_t i = 0; i < spare.size(); ++i)
    spare[i] = ::fcntl(start.descriptors[i].first, F_DUPFD_CLOEXEC, last + 1);
  for (std::size_t i = 0; i < spare.size(); ++i) ::dup2(spare[i], start.descriptors[i].second);
  ::syscall(SYS_close_range, static_cast<unsigned>(last + 1), ~0u, 0u);
  ::execvpe(words[0], words.data(), variables.data());
  ::_exit(not_started);
}

int wait_for(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace lgabench
