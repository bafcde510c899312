// A method that selects alone. Another method, in a process of its own, learns and acts with what it selected.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/host/hosted_method.hpp>

namespace lgabench {

/// Asks the one for select() and revise() alone, the other, the shipped LGA, to learn and act. The first one's process
/// and all that it started are at their end before the second one's begins: nothing they do can reach what acts. Throws
/// as the two do.
class SelectedBy : public MethodInProcesses {
 public:
  using Make = std::function<std::unique_ptr<HostedMethod>()>;
  SelectedBy(std::unique_ptr<HostedMethod> selects, Make acts)
      : selects_(std::move(selects)), make_acts_(std::move(acts)) {}

  /// LGA's needs, and revise(), which returns what was selected where the selecting method does not revise.
  Needs needs(const Json& options) const override;
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override;
  Selection revise(const Command& command, const Selection& selected, const std::vector<Demonstration>& demonstrations,
                   Services& services) override;
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override;

  /// Files of the method that selects.
  std::vector<std::pair<std::string, std::string>> files() const override;
  void end() override;

 private:
  void end_selecting();

  std::unique_ptr<HostedMethod> selects_, acts_;
  Make make_acts_;
  std::vector<std::pair<std::string, std::string>> files_;  // once what selects is at its end
};

}  // namespace lgabench
