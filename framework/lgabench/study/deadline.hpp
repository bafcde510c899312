// A limit to how long a connection may last, however slowly its bytes come.
#pragma once
#include <condition_variable>
#include <mutex>
#include <thread>

namespace lgabench::study {

/// Ends connections that this process accepted on `port` once they lasted longer than `seconds`: a client that sends a
/// byte now and then would occupy a thread for ever, since a timeout of reading begins anew with each byte.
class ConnectionDeadline {
 public:
  ConnectionDeadline(int port, double seconds);
  ~ConnectionDeadline();

 private:
  void watch();

  const int port_;
  const double seconds_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace lgabench::study
