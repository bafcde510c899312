// What the system refuses, in its own words and with a way on.
#pragma once
#include <cerrno>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <lgabench/core/error.hpp>

namespace lgabench {

/// "WHAT: errno's words", and what to do where that is known: "fork: Resource temporarily unavailable; raise ...".
std::string refused_text(const std::string& what, int reason = errno);

/// A process, a thread, a pipe or the like that the system did not give.
class Refused : public InputError {
 public:
  explicit Refused(const std::string& what, int reason = errno);
  ~Refused() override;
  /// Whether the same may be given once other processes have ended.
  bool may_pass() const;

  int reason;  // errno
};

/// Starts as many threads of work() as the system lets it, at most `most`. The caller works too, so fewer only take
/// longer.
template <class Work>
std::vector<std::thread> start_helpers(std::size_t most, const Work& work) {
  std::vector<std::thread> helpers;
  helpers.reserve(most);
  try {
    while (helpers.size() < most) helpers.emplace_back(work);
  } catch (const std::system_error&) {  // a limit of threads or of memory is reached
  }
  return helpers;
}

/// A thread of work(). @throws Refused
template <class Work>
std::thread start_thread(Work&& work) {
  try {
    return std::thread(std::forward<Work>(work));
  } catch (const std::system_error& e) {
    throw Refused("a thread cannot be started", e.code().value());
  }
}

}  // namespace lgabench
