// Limits to how long a connection may last and how much it may send, whatever is done with its bytes.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace lgabench::http {

/// Ends connections that this process accepted on `port` once they lasted longer than `seconds` or sent more than
/// `bytes`, looking ten times a second. httplib has neither limit: its timeout of reading begins anew with each byte,
/// and it reads a head until that ends.
class ConnectionLimits {
 public:
  ConnectionLimits(int port, double seconds, std::uint64_t bytes);
  ~ConnectionLimits();

 private:
  void watch();

  const int port_;
  const double seconds_;
  const std::uint64_t bytes_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace lgabench::http
