#include <lgabench/http/page_server.hpp>

#include <pthread.h>

#include <csignal>
#include <mutex>
#include <thread>
#include <utility>

#include <lgabench/core/refused.hpp>
#include <lgabench/http/guarded.hpp>

namespace lgabench::http {
namespace {

const httplib::Headers pages_alone{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; "
     "form-action 'none'; frame-ancestors 'none'"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
    {"X-Content-Type-Options", "nosniff"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
};

}  // namespace

struct PageServer::Impl {
  GuardedServer server{{}, pages_alone, Takes::nothing};
  std::mutex one_at_a_time;
};

PageServer::PageServer(std::function<std::optional<Page>(const std::string&)> page) : impl_(std::make_unique<Impl>()) {
  impl_->server.pages.Get(".*",
                          [this, page = std::move(page)](const httplib::Request& request, httplib::Response& response) {
                            const std::lock_guard lock(impl_->one_at_a_time);
                            try {
                              const std::optional<Page> found = page(request.path);
                              if (!found) {
                                response.status = 404;
                                return;
                              }
                              response.set_content(found->html, "text/html; charset=utf-8");
                              if (found->renewed_s > 0)
                                response.set_header("Refresh", std::to_string(found->renewed_s));
                            } catch (const std::exception& e) {
                              response.status = 500;
                              response.set_content(e.what(), "text/plain; charset=utf-8");
                            }
                          });
}
PageServer::~PageServer() = default;
int PageServer::port() const { return impl_->server.port(); }
void PageServer::run() { impl_->server.run(); }
void PageServer::stop() { impl_->server.stop(); }

void until_stopped(const std::function<void()>& run, const std::function<void()>& stop) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // before any thread of the server
  std::thread stopper = start_thread([&signals, &stop] {
    int which = 0;
    ::sigwait(&signals, &which);
    stop();
  });
  run();
  stopper.join();
}

}  // namespace lgabench::http
