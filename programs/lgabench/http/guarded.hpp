// httplib's server with the limits that all of this project's have. For sources: httplib takes long to compile.
#pragma once
#include <httplib.h>

#include <string>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench::http {

/// Answers with JSON.
void reply(httplib::Response& response, int status, const Json& json);

struct Listening {
  std::string address = "127.0.0.1";
  int port = 0;      // 0: any that is free
  std::string host;  // the name that a proxy passes on; "": only this machine's own names are answered to
};

/// What is answered beside GET and HEAD.
enum class Takes { nothing, json };

/// A request has 512 KiB and 10 s; its Host is one of this machine's names or `host`; its answer is whole, whatever
/// ranges and encodings it asks for. A POST is JSON of at most 256 KiB, not compressed, from a page of its own Origin.
class GuardedServer {
 public:
  /// Binds. `headers` go with every answer. @throws InputError where the address cannot be had.
  GuardedServer(const Listening& where, httplib::Headers headers, Takes takes);

  httplib::Server pages;  // is told what to answer before run()

  int port() const { return port_; }
  /// Serves until stop(), which any thread may call.
  void run();
  void stop() { pages.stop(); }

 private:
  httplib::Server::HandlerResponse admit(const httplib::Request& request, httplib::Response& response) const;

  const Takes takes_;
  std::vector<std::string> hosts_;  // what a Host header may say
  int port_ = 0;
};

}  // namespace lgabench::http
