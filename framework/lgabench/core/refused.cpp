#include <lgabench/core/refused.hpp>

#include <cstring>

namespace lgabench {
namespace {

const char* way_on(int reason) {
  switch (reason) {
    case EAGAIN:
      return "; raise the limit of processes and threads (ulimit -u, or the job's), or take fewer --jobs";
    case EMFILE:
      return "; raise the limit of open files (ulimit -n), or take fewer --jobs";
    case ENFILE:
      return "; the whole system has too many files open";
    case ENOMEM:
      return "; free memory, or take fewer --jobs";
    default:
      return "";
  }
}

}  // namespace

std::string refused_text(const std::string& what, int reason) {
  return what + ": " + std::strerror(reason) + way_on(reason);
}

Refused::Refused(const std::string& what, int why) : InputError(refused_text(what, why)), reason(why) {}
Refused::~Refused() = default;

bool Refused::may_pass() const { return reason == EAGAIN || reason == EMFILE || reason == ENFILE || reason == ENOMEM; }

}  // namespace lgabench
