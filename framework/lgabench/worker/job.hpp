// What the worker's verbs that `lgabench` starts have in common: a job on stdin, progress and complaints on
// descriptor 3.
#pragma once
#include <functional>
#include <string>

#include <lgabench/core/json.hpp>
#include <lgabench/job/job.hpp>

namespace lgabench::worker {

/// Lines of JSON on descriptor 3, if whoever started us opened it. Made before anything else is opened, or it could be
/// that.
class Messages {
 public:
  Messages();
  void at(const PhaseCount& place) const;
  /// Whose plugin's process has not answered for long; "": none.
  void awaits(const std::string& whom) const;
  void complain(Complaint complaint) const;
  /// The last phase that was told, or "".
  const std::string& phase() const { return phase_; }

 private:
  void send(const Json& message) const;

  bool open_;
  mutable std::string phase_;
};

/// A verb's whole run: reads the job on stdin, sets its limits (a crash leaves no core; a loop, a leak or a log without
/// end ends with this process), does the work and ends the process. Tells of what the work throws, and who is at fault,
/// and throws on. Before any plugin is loaded. @throws InputError
void do_job(const std::function<void(const JsonReader& job, const Messages& messages)>& work);

}  // namespace lgabench::worker
