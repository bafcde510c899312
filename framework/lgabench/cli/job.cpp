#include <lgabench/cli/job.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <iterator>
#include <new>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench::cli {
namespace {

void limit(int resource, long long value) {
  const rlimit both{static_cast<rlim_t>(value), static_cast<rlim_t>(value)};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

// And sets the limits that it names.
Json read_job() {
  const std::string text((std::istreambuf_iterator<char>(std::cin)), {});
  Json job = parse_json(text, "job");
  const JsonReader limits = JsonReader(job, "job").at("limits");
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 1LL << 28);
  limit(RLIMIT_CPU, limits.at("cpu_s").integer(1, 1LL << 40));
#if !defined(__SANITIZE_ADDRESS__)  // whose shadow memory counts
  limit(RLIMIT_DATA, limits.at("data_bytes").integer(1, 1LL << 60));
#endif
  return job;
}

}  // namespace

Messages::Messages() : open_(::fcntl(3, F_GETFD) != -1) {}

void Messages::send(const Json& message) const {
  if (message.contains("phase")) phase_ = message["phase"];
  if (!open_) return;
  const std::string line = message.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  [[maybe_unused]] const ssize_t sent = ::write(3, line.data(), line.size());  // nobody listening: no harm
}

PluginInfo job_plugin(const JsonReader& reader) {
  PluginInfo info;
  if (reader.has("python")) {
    info.file = reader.at("file").string();
    info.kind = "method";
    info.id = reader.at("id").string();
    info.asks = reader.at("asks").string();
    info.sha256 = sha256_file(info.file);
    info.python = reader.at("python").json();
  } else {
    info = read_plugin(reader.at("file").string());
  }
  if (info.sha256 != reader.at("sha256").string())
    throw PluginError(fmt::format("{}: changed since the run began", info.file.string()));
  return info;
}

void do_job(const std::function<void(const JsonReader& job, const Messages& messages)>& work) {
  const Messages messages;
  const auto complain = [&messages](const std::exception& e, const char* fault, bool refused = false) {
    constexpr std::size_t longest = 2000;  // whatever a plugin throws, the line has room in the pipe
    messages.send({{"reason", std::string(e.what()).substr(0, longest)}, {"fault", fault}, {"refused", refused}});
  };
  try {
    const Json job = read_job();
    work(JsonReader(job, "job"), messages);
  } catch (const MethodGone& e) {
    const MethodGone placed(fmt::format("{} in phase {}", e.what(), messages.phase()), e.signal);
    messages.send({{"reason", placed.what()}, {"fault", "plugin"}, {"signal", e.signal}});
    throw placed;
  } catch (const MethodError& e) {
    complain(e, "plugin");
    throw;
  } catch (const PluginError& e) {
    complain(e, "plugin", true);
    throw;
  } catch (const std::bad_alloc&) {
    const MethodError e("out of memory (the limit is --memory)");
    complain(e, "plugin");
    throw e;
  } catch (const std::exception& e) {
    complain(e, "host");
    throw;
  }
  // All is on the disk. What plugins do at exit can neither help nor harm any more.
  std::fflush(nullptr);
  ::_exit(ok);
}

}  // namespace lgabench::cli
