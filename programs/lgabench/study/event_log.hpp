// An append-only file of events that survives a kill at any moment.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench::study {

/// A line each: the JSON's length in bytes, the first 16 digits of its SHA-256, the JSON. An event is there once
/// append() has returned, and stays. One thread at a time; one process at a time.
class EventLog {
 public:
  /// Reads what is there. The end of an append that was cut off, which nobody was told of, is dropped from the file if
  /// `repair`, else passed over. @throws InputError naming the file and the line for anything else that is no event.
  explicit EventLog(fs::path file, bool repair = false);

  const fs::path& file() const { return file_; }
  const std::vector<Json>& events() const { return events_; }
  /// Adds `event` to file and events(), on the disk when it returns. @throws InputError where it cannot be written;
  /// file and events are then as they were.
  void append(const Json& event);

 private:
  fs::path file_;
  std::uintmax_t size_ = 0;  // of the whole lines
  std::vector<Json> events_;
};

}  // namespace lgabench::study
