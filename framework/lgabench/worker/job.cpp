#include <lgabench/worker/job.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <new>
#include <string_view>

#include <lgabench/core/exit_status.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/host/host_session.hpp>
#include <lgabench/plugin/fingerprint.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench::worker {
namespace {

// A lower limit that is there already stays.
void limit(int resource, long long value) {
  const auto which = static_cast<__rlimit_resource>(resource);
  rlimit both{};
  if (::getrlimit(which, &both) != 0) throw Refused("getrlimit");
  both.rlim_cur = both.rlim_max = std::min(static_cast<rlim_t>(value), both.rlim_cur);
  if (::setrlimit(which, &both) != 0) throw Refused("setrlimit");
}

// And sets the limits that it names.
Json read_job() {
  const std::string text((std::istreambuf_iterator<char>(std::cin)), {});
  Json job = parse_json(text, "job");
  const Limits limits = read_limits(JsonReader(job, "job"));
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 1LL << 28);
  limit(RLIMIT_CPU, limits.cpu_s);
  // A sanitizer's shadow memory would count.
  if constexpr (std::string_view(LGABENCH_SANITIZER) == "none") limit(RLIMIT_DATA, limits.data_bytes);
  return job;
}

}  // namespace

Messages::Messages() : open_(::fcntl(3, F_GETFD) != -1) {}

void Messages::at(const PhaseCount& place) const {
  phase_ = place.phase;
  send(to_json(place));
}

void Messages::awaits(const std::string& whom) const { send(to_json(Waiting{whom})); }

void Messages::complain(Complaint complaint) const {
  constexpr std::size_t longest = 2000;  // whatever a plugin throws, the line has room in the pipe
  complaint.reason = complaint.reason.substr(0, longest);
  send(to_json(complaint));
}

void Messages::send(const Json& message) const {
  if (!open_) return;
  const std::string line = message.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  [[maybe_unused]] const ssize_t sent = ::write(3, line.data(), line.size());  // nobody listening: no harm
}

void do_job(const std::function<void(const JsonReader& job, const Messages& messages)>& work) {
  const Messages messages;
  tell_who_is_awaited([&messages](const std::string& whom) { messages.awaits(whom); });
  try {
    const Json job = read_job();
    work(JsonReader(job, "job"), messages);
  } catch (const MethodGone& e) {
    const MethodGone placed(fmt::format("{} in phase {}", e.what(), messages.phase()), e.signal);
    messages.complain({placed.what(), true, e.signal});
    throw placed;
  } catch (const MethodError& e) {
    messages.complain({e.what(), true});
    throw;
  } catch (const PluginError& e) {
    messages.complain({e.what(), true, 0, true});
    throw;
  } catch (const PluginOutOfMemory& e) {
    messages.complain({e.what(), true});
    throw MethodError(e.what());
  } catch (const std::bad_alloc&) {
    const MethodError e("out of memory (the limit is --memory)");
    messages.complain({e.what(), true});
    throw e;
  } catch (const std::exception& e) {
    messages.complain({e.what()});
    throw;
  }
  // All is on the disk. What plugins do at exit can neither help nor harm any more.
  std::fflush(nullptr);
  ::_exit(exit_status::ok);
}

}  // namespace lgabench::worker
