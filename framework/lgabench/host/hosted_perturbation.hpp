// A perturbation, or a perceiver, whose code runs in a process of its own, confined like a method's: it is sent
// pictures, and levels or the names that there are.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <lgabench/core/observation_perturbation.hpp>
#include <lgabench/core/perceiver.hpp>
#include <lgabench/host/host_session.hpp>

namespace lgabench {

/// What the plugin throws is thrown here as MethodError (std::bad_alloc where its memory ran out). Where its
/// process ends, is stopped or breaks the protocol, every call throws MethodGone.
class HostedPerturbation : public ObservationPerturbation, public Perceiver {
 public:
  /// @throws PluginError where the plugin is refused, MethodGone.
  explicit HostedPerturbation(const HostJob& job);
  ~HostedPerturbation() override;

  /// Pictures and ids have the size of the environment's; instances are as the plugin made them, their pixels counted.
  /// Shadows are those of the instances that are left.
  Observation perceive(Observation seen, int level, RandomStream stream) override;

  /// What a perceiver reads; it is sent no instances. What comes back is as that of perceive().
  Observation read(Observation seen, const FeatureSpace& space) override;

  /// Names of the system calls that its process was refused so far.
  std::vector<std::string> refused_calls() const;
  /// For check-plugin: destroys it; perceive() makes another one in the same process.
  void drop();
  /// For check-plugin, of a C++ plugin: what its process holds beyond what it held before the plugin was loaded.
  ProcessState state() const;

 private:
  Observation answer_to(const Observation& seen, Json request);

  std::unique_ptr<HostSession> session_;
};

}  // namespace lgabench
