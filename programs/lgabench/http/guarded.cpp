#include <lgabench/http/guarded.hpp>

#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>

#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/http/connection_limits.hpp>

namespace lgabench::http {
namespace {

using httplib::Request;
using httplib::Response;

constexpr std::size_t largest_body = 256 << 10, largest_request = 2 * largest_body, most_threads = 128;
constexpr std::size_t stack = 16 << 20, kept_stack = 64 << 10;
constexpr double longest_request_s = 10;
constexpr const char* json_type = "application/json";

// httplib reads a Range by a regular expression that goes deeper with each character of a header: more than the
// system's stack may hold, and what one request took each thread would keep.
void set_stack_of_threads() {
  pthread_attr_t attributes;
  ::pthread_getattr_default_np(&attributes);
  ::pthread_attr_setstacksize(&attributes, stack);
  ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
}

// As httplib's ThreadPool, which ends the program where the system starts fewer threads.
class Pool final : public httplib::TaskQueue {
 public:
  Pool() {
    set_stack_of_threads();
    threads_ = start_helpers(most_threads, [this] { work(); });
    if (threads_.empty()) throw Refused("no thread can be started that answers requests", EAGAIN);
  }
  void enqueue(std::function<void()> task) override {
    {
      const std::lock_guard lock(mutex_);
      tasks_.push_back(std::move(task));
    }
    changed_.notify_one();
  }
  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ends_ || !tasks_.empty(); });
      if (tasks_.empty()) return;
      const std::function<void()> task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

void give_stack_back() {
  pthread_attr_t attributes;
  void* lowest = nullptr;
  std::size_t size = 0;
  if (::pthread_getattr_np(::pthread_self(), &attributes) != 0) return;
  ::pthread_attr_getstack(&attributes, &lowest, &size);
  ::pthread_attr_destroy(&attributes);
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const auto used = static_cast<std::size_t>(reinterpret_cast<char*>(&attributes) - static_cast<char*>(lowest));
  if (used > kept_stack) ::madvise(lowest, (used - kept_stack) / page * page, MADV_DONTNEED);
}

// Answers are whole and as they are: httplib would build one of thousands of ranges in memory, and compress each anew.
void answer_whole(const Request& request) {
  auto& changed = const_cast<Request&>(request);  // httplib's, which it reads after this
  changed.ranges.clear();
  changed.headers.erase("Accept-Encoding");
  give_stack_back();
}

}  // namespace

void reply(Response& response, int status, const Json& json) {
  response.status = status;
  response.set_content(canonical(json), json_type);
}

GuardedServer::GuardedServer(const Listening& where, httplib::Headers headers, Takes takes) : takes_(takes) {
  pages.new_task_queue = [] { return new Pool; };
  pages.set_payload_max_length(largest_body);
  pages.set_read_timeout(10);
  pages.set_keep_alive_max_count(1);  // so that a connection's deadline is a request's
  pages.set_tcp_nodelay(true);
  pages.set_default_headers(std::move(headers));
  pages.set_pre_routing_handler(
      [this](const Request& request, Response& response) { return admit(request, response); });
  pages.set_error_handler([](const Request& request, Response& response) {
    answer_whole(request);  // one that is malformed comes here first
    if (response.body.empty()) response.set_content(fmt::format("{}\n", response.status), "text/plain");
  });
  errno = 0;
  if (where.port == 0)
    port_ = pages.bind_to_any_port(where.address);
  else
    port_ = pages.bind_to_port(where.address, where.port) ? where.port : -1;
  if (port_ <= 0)
    throw InputError(fmt::format("{}:{}: cannot listen there: {}{}", where.address, where.port,
                                 errno == 0 ? "no address of this machine" : std::strerror(errno),
                                 where.port == 0 ? "" : "; take another --port"));
  for (const char* host : {"127.0.0.1", "localhost", "[::1]"}) {
    hosts_.push_back(fmt::format("{}:{}", host, port_));
    if (port_ == 80) hosts_.emplace_back(host);  // a browser leaves HTTP's own port out
  }
  if (!where.host.empty()) hosts_.push_back(where.host);
}

// Another Host is a name that somebody else points here; another Origin is somebody else's page.
httplib::Server::HandlerResponse GuardedServer::admit(const Request& request, Response& response) const {
  answer_whole(request);
  const auto refuse = [&response](int status, const char* why) {
    reply(response, status, {{"error", why}});
    return httplib::Server::HandlerResponse::Handled;
  };
  const std::string host = request.get_header_value("Host");
  if (!contains(hosts_, host)) return refuse(421, "this server does not serve that Host");
  if (request.method == "GET" || request.method == "HEAD") return httplib::Server::HandlerResponse::Unhandled;
  if (takes_ == Takes::nothing) return refuse(405, "GET");
  if (request.method != "POST") return refuse(405, "GET or POST");
  if (const std::string origin = request.get_header_value("Origin");
      !origin.empty() && origin != "http://" + host && origin != "https://" + host)
    return refuse(403, "another Origin");
  if (request.get_header_value("Content-Type") != json_type) return refuse(415, "expected JSON");
  // httplib bounds a body by its Content-Length alone, before it is decompressed.
  if (request.has_header("Content-Encoding")) return refuse(415, "expected a body that is not compressed");
  if (request.has_header("Transfer-Encoding") || !request.has_header("Content-Length"))
    return refuse(411, "expected a Content-Length");
  return httplib::Server::HandlerResponse::Unhandled;
}

void GuardedServer::run() {
  // A thread: with the caller's mask of signals.
  const ConnectionLimits limits(port_, longest_request_s, largest_request);
  pages.listen_after_bind();
}

}  // namespace lgabench::http
