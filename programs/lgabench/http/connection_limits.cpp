#include <lgabench/http/connection_limits.hpp>

#include <arpa/inet.h>
#include <linux/tcp.h>  // netinet/tcp.h's tcp_info lacks the bytes that were received
#include <sys/socket.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <string>

#include <lgabench/core/refused.hpp>

namespace lgabench::http {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

int port_of(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
  if (address.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
  return -1;
}

// Descriptor and peer of each connection that was accepted on the port.
std::map<std::pair<int, std::string>, Clock::time_point> connections(int port) {
  std::map<std::pair<int, std::string>, Clock::time_point> all;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator("/proc/self/fd", gone)) {
    const int fd = std::stoi(entry.path().filename().string());
    sockaddr_storage local{}, peer{};
    socklen_t local_size = sizeof local, peer_size = sizeof peer;
    if (::getsockname(fd, reinterpret_cast<sockaddr*>(&local), &local_size) == 0 && port_of(local) == port &&
        ::getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &peer_size) == 0)
      all.try_emplace({fd, std::string(reinterpret_cast<const char*>(&peer), peer_size)}, Clock::now());
  }
  return all;
}

std::uint64_t bytes_received(int connection) {
  tcp_info info{};
  socklen_t size = sizeof info;
  return ::getsockopt(connection, IPPROTO_TCP, TCP_INFO, &info, &size) == 0 ? info.tcpi_bytes_received : 0;
}

}  // namespace

ConnectionLimits::ConnectionLimits(int port, double seconds, std::uint64_t bytes)
    : port_(port), seconds_(seconds), bytes_(bytes), thread_(start_thread([this] { watch(); })) {}

ConnectionLimits::~ConnectionLimits() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

void ConnectionLimits::watch() {
  std::map<std::pair<int, std::string>, Clock::time_point> before;
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, std::chrono::milliseconds(100), [this] { return end_; })) {
    auto now = connections(port_);
    for (auto& [connection, since] : now) {
      if (const auto seen = before.find(connection); seen != before.end()) since = seen->second;
      if (std::chrono::duration<double>(Clock::now() - since).count() > seconds_ ||
          bytes_received(connection.first) > bytes_)
        ::shutdown(connection.first, SHUT_RDWR);
    }
    before = std::move(now);
  }
}

}  // namespace lgabench::http
