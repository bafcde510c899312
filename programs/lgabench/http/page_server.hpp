// Pages for this machine's own browsers.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace lgabench::http {

struct Page {
  std::string html;
  int renewed_s = 0;  // seconds after which a browser asks for it again; 0: it does not
};

/// Answers GET on a port of the loopback address that is free. Its pages may hold scripts and styles of their own, and
/// load and send nothing.
class PageServer {
 public:
  /// Binds. `page` gives what stands at a path, or nothing; any thread calls it, one at a time. What it throws is said
  /// in an answer of status 500.
  explicit PageServer(std::function<std::optional<Page>(const std::string& path)> page);
  ~PageServer();

  int port() const;
  /// Serves until stop(), which any thread may call.
  void run();
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Calls `run`, and `stop` once the terminal or a signal says so. Before this no thread of the server may have begun.
void until_stopped(const std::function<void()>& run, const std::function<void()>& stop);

}  // namespace lgabench::http
