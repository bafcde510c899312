// A server on this machine that gives every request the same bytes, whatever they are.
#pragma once
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <mutex>
#include <string>
#include <thread>

#include <lgabench/core/error.hpp>

namespace lgabench::fuzz {

class Server {
 public:
  /// Listens until the process ends.
  Server() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (::bind(socket_, any, size) != 0 || ::listen(socket_, 16) != 0 || ::getsockname(socket_, any, &size) != 0)
      throw EngineError("no server can be started");
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    std::thread([this] {
      for (;;) answer(::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC));
    }).detach();
  }

  const std::string& url() const { return url_; }
  /// Of every request from now on.
  void give(std::string response) {
    const std::lock_guard lock(mutex_);
    response_ = std::move(response);
  }

 private:
  // The whole request is read first: closing a socket with bytes in it would reset the connection.
  void answer(int connection) {
    std::string request, response;
    char block[1 << 12];
    while (request.find("\r\n\r\n") == request.npos || request.back() != '}') {
      const ssize_t n = ::recv(connection, block, sizeof block, 0);
      if (n <= 0) break;
      request.append(block, static_cast<std::size_t>(n));
    }
    {
      const std::lock_guard lock(mutex_);
      response = response_;
    }
    for (std::size_t done = 0; done < response.size();) {
      const ssize_t n = ::send(connection, response.data() + done, response.size() - done, MSG_NOSIGNAL);
      if (n <= 0) break;
      done += static_cast<std::size_t>(n);
    }
    ::close(connection);
  }

  int socket_;
  std::string url_, response_;
  std::mutex mutex_;
};

}  // namespace lgabench::fuzz
