// A method whose code runs in a process of its own. The worker asks it over a socket (docs/formats/method-protocol.md),
// and says of each Selection where it comes from and what it cost: by what was asked.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/method.hpp>
#include <lgabench/core/plain_directory.hpp>
#include <lgabench/host/process_state.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// What a method's process is started with.
struct HostJob {
  PluginInfo method;
  std::string environment;                      // the cell's
  Json options;                                 // every one
  std::uint64_t seed;                           // as Services::seed
  std::filesystem::path scratch;                // an empty directory of its own
  bool confined = true;                         // see confine.hpp
  std::vector<std::filesystem::path> hidden{};  // unreadable to it wherever they lie, beside lgabench's own data
  long long memory_bytes = 0;                   // 0: no limit
  int perturb = 0;                              // as perturb_heap(), of a plugin's process
  /// Words before the process's own, an absolute path first or none at all: it runs in the foreground
  /// (host_process.hpp).
  std::optional<std::vector<std::string>> debugger{};
  std::string task{};  // of the environment, whose stations the method is told; "": it is told of none
};

/// The most that is kept of a policy.
constexpr std::size_t most_saved_bytes = 64 << 20;

/// A method whose code runs in a process, or several, that whoever made it ends.
class MethodInProcesses : public Method {
 public:
  /// What the method left in Services::files, as names and bytes: 64 MiB at most. What is left out is said in the log.
  virtual std::vector<std::pair<std::string, std::string>> files() const = 0;
  /// Destroys policy and method in their process, which ends. @throws MethodGone where that fails.
  virtual void end() = 0;
};

class HostSession;

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
  /// Likewise: its process has services of its own, and may ask nobody meanwhile.
  std::unique_ptr<Policy> restore(const std::string& saved);
  std::vector<std::pair<std::string, std::string>> files() const override;
  void end() override;

  /// Names of the system calls that its process was refused so far.
  std::vector<std::string> refused_calls() const;
  /// For check-plugin: destroys one of them; after both, needs() makes a new method in the same process.
  void drop_method();
  void drop_policy();
  /// Likewise: what the process of a plugin holds beyond what it held before the plugin was loaded.
  ProcessState state() const;

 private:
  PlainDirectory files_;
  FeatureSpace space_;  // that select() was last given
  std::shared_ptr<HostSession> session_;
};

}  // namespace lgabench
