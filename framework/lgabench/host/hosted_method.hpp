// A method whose code runs in a process of its own. The worker asks it over a socket (docs/formats/method-protocol.md),
// and says of each Selection where it comes from and what it cost: by what was asked.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/method.hpp>
#include <lgabench/core/plain_directory.hpp>
#include <lgabench/host/host_session.hpp>

namespace lgabench {

/// The largest policy that is kept.
constexpr std::size_t most_saved_bytes = 64 << 20;

/// A method whose code runs in one process or several, which the method's maker ends.
class MethodInProcesses : public Method {
 public:
  /// What the method left in Services::files, as names and bytes: 64 MiB at most. What is left out is said in the log.
  virtual std::vector<std::pair<std::string, std::string>> files() const = 0;
  /// Destroys policy and method in their process, which ends. @throws MethodGone where that fails.
  virtual void end() = 0;
};

/// Options and seed are those of the job, whatever the calls' Services say. What the method throws is thrown here as
/// MethodError (std::bad_alloc where its memory ran out). Where its process ends, is stopped or breaks the protocol,
/// every call throws MethodGone.
class HostedMethod : public MethodInProcesses {
 public:
  /// @throws PluginError where the plugin is refused, MethodGone.
  explicit HostedMethod(const HostJob& job);
  ~HostedMethod() override;

  Needs needs(const Json& options) const override;
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override;
  Selection revise(const Command& command, const Selection& selected, const std::vector<Demonstration>& demonstrations,
                   Services& services) override;
  /// The policy may outlive this object; it acts in the same process.
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override;
  std::unique_ptr<Policy> restore(const std::string& saved, Services&) override { return restore(saved); }
  /// Restores a policy, which may outlive this object. The process has services of its own, and may ask nobody
  /// meanwhile.
  std::unique_ptr<Policy> restore(const std::string& saved);
  std::vector<std::pair<std::string, std::string>> files() const override;
  void end() override;

  /// Names of the system calls that its process was refused so far.
  std::vector<std::string> refused_calls() const;
  /// For check-plugin: destroys the policy or the method. After both, needs() makes a new method in the same process.
  void drop_method();
  void drop_policy();
  /// For check-plugin: what the process of a plugin holds beyond what it held before the plugin was loaded.
  ProcessState state() const;
  /// For check-plugin: whether its process can be asked nothing any more.
  bool is_broken() const { return session_->is_broken(); }
  /// For check-plugin: processes that the plugin started and that are still there, "NUMBER NAME" each.
  std::vector<std::string> processes() const;
  /// What its process used so far.
  ProcessUse used() const { return session_->used(); }

 private:
  PlainDirectory files_;
  FeatureSpace space_;  // that select() was last given
  std::shared_ptr<HostSession> session_;
};

}  // namespace lgabench
