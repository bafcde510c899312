// The worker's end of a conversation with a plugin's process (docs/formats/method-protocol.md).
#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/host/host_process.hpp>
#include <lgabench/host/messages.hpp>
#include <lgabench/plugin/guarded.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// What a plugin's process is started with.
struct HostJob {
  PluginInfo plugin;                            // a method, a perturbation or a perceiver
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
  std::string task{};     // of the environment, whose stations and state a method is told; "": it is told of none
  bool may_stop = false;  // as in Services
  bool trusted = false, offline = false;  // of an environment: as in HostCommand
  double reply_limit_s = 0;               // of each call; 0: no limit
};

/// Calls `tell` in all later conversations of this process: with the plugin whose process has not answered for half a
/// second, and with "" once it did.
void tell_who_is_awaited(std::function<void(const std::string& whom)> tell);

/// The connection, from the process's start to its end. Once the process ended, was stopped or broke the protocol,
/// every call throws MethodGone.
class HostSession {
 public:
  /// @throws PluginError where the plugin is refused, MethodGone.
  explicit HostSession(const HostJob& job);

  using Meanwhile = std::function<bool(const Frame& frame, Channel& channel)>;

  /// Whether nothing can be asked any more.
  bool is_broken() const { return !broken_.empty(); }

  /// Sends the request and returns the reply of that type. `meanwhile` takes the frames that come before it; one that
  /// it does not know breaks the protocol. @throws MethodError, PluginOutOfMemory, PluginError as the reply says.
  Frame call(const Json& request, const char* reply, const Meanwhile& meanwhile = {}, const Descriptor* file = nullptr);

  /// Returns what a reply holds. @throws MethodGone
  template <class Call>
  auto read(Call&& call) -> decltype(call()) {
    return guarded_by_protocol([&] { return host::read_or_malformed(call); });
  }

  const host::Layout& layout() const { return layout_; }
  const std::vector<std::string>& refused_calls() const { return process_.refused_calls(); }
  host::SharedMemory& observation() { return observation_; }
  /// What a C++ plugin's process holds beyond what it held before the plugin came.
  ProcessState state();
  /// Processes that the plugin started and that are still there, "NUMBER NAME" each.
  std::vector<std::string> processes() const { return process_.started(); }
  ProcessUse used() const { return process_.used(); }

 private:
  template <class Call>
  auto guarded_by_protocol(Call&& call) -> decltype(call()) {
    if (!broken_.empty()) throw MethodGone(broken_, 0);
    try {
      return call();
    } catch (const MethodGone& e) {
      broken_ = e.what();
      throw;
    } catch (const Malformed& e) {
      broken_ = std::string("sent a malformed frame (does it write to descriptor 3, where lgabench talks with it?): ") +
                e.what();
      throw MethodGone(broken_, 0);
    }
  }

  void wait(short events);
  void raise(const JsonReader& error);
  void await_begins();
  void await_ends();

  using Clock = std::chrono::steady_clock;
  const std::string whom_;  // "plugin ID (KIND)"
  const host::Layout layout_;
  Clock::time_point asked_{};
  const double reply_limit_s_;
  bool is_told_ = false;    // that this one is awaited
  std::string last_words_;  // of what ends its process
  std::unique_ptr<Confinement> confinement_;
  HostProcess process_;
  Channel channel_;
  host::SharedMemory observation_;
  std::string broken_;  // why nothing can be asked any more
};

}  // namespace lgabench
