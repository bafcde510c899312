// What the worker's verbs that `lgabench` starts have in common: a job on stdin, progress and complaints on
// descriptor 3.
#pragma once
#include <functional>
#include <string>

#include <lgabench/core/json.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::cli {

/// Lines of JSON on descriptor 3, if whoever started us opened it. Made before anything else is opened, or it could be
/// that.
class Messages {
 public:
  Messages();
  void send(const Json& message) const;

 private:
  bool open_;
};

/// Reads the job on stdin and sets its limits: a crash leaves no core; a loop, a leak or a log without end ends with
/// this process. Before any plugin is loaded. @throws InputError
Json read_job();

/// The plugin {"file", "sha256"}. @throws PluginError where it is refused, or another one by now.
PluginInfo job_plugin(const JsonReader& reader);

/// Does it; tells of what it throws, and who is at fault, and throws on.
void complaining(const Messages& messages, const std::function<void()>& work);

}  // namespace lgabench::cli
