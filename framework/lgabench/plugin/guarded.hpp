// Every call into a plugin goes through guarded().
#pragma once
#include <new>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <lgabench/core/error.hpp>
#include <lgabench/core/flush_denormals.hpp>

namespace lgabench {

/// The process that a method runs in ended, was stopped or broke the protocol: the cell fails, and the method is at
/// fault.
class MethodGone : public Error {
 public:
  /// `signal_number`: of what ended it, or 0.
  MethodGone(const std::string& what, int signal_number) : Error(what), signal(signal_number) {}
  ~MethodGone() override;

  int signal;
};

/// A plugin's process needed more memory than it may have.
class PluginOutOfMemory : public std::bad_alloc {
 public:
  /// `whom`: the plugin, as "plugin ID (KIND)".
  explicit PluginOutOfMemory(const std::string& whom) : what_(whom + ": out of memory (the limit is --memory)") {}
  ~PluginOutOfMemory() override;
  const char* what() const noexcept override { return what_.c_str(); }

 private:
  std::string what_;
};

/// The exception being handled, as one line: the first of what(), or the name of its type if it has none.
std::string current_exception_text();

/// Sets flush-to-zero again on the way out if a plugin's code cleared it: training would be 20 times slower unnoticed.
struct FlushDenormalsAgain {
  FlushDenormalsAgain() = default;
  FlushDenormalsAgain(const FlushDenormalsAgain&) = delete;
  FlushDenormalsAgain& operator=(const FlushDenormalsAgain&) = delete;
  ~FlushDenormalsAgain() {
    if (!denormals_flushed()) flush_denormals();
  }
};

/// Returns call(). An exception becomes a Fault that reads "plugin ID: ...". Only two stay as they are: an InputError,
/// since an option or a file is to be corrected, not the plugin; and a method's std::bad_alloc, since the machine's
/// memory must not decide an episode. Use the default for methods and their policies (so a method cannot pass its
/// failure off as the engine's), guarded<EngineError> for engines.
template <class Fault = MethodError, class Call>
decltype(auto) guarded(std::string_view plugin_id, Call&& call) {
  const FlushDenormalsAgain on_every_way_out;
  const auto named = [plugin_id] { return "plugin " + std::string(plugin_id) + ": " + current_exception_text(); };
  try {
    return std::forward<Call>(call)();
  } catch (const MethodGone& e) {
    throw MethodGone("plugin " + std::string(plugin_id) + ": " + e.what(), e.signal);
  } catch (const InputError&) {
    throw InputError(named());
  } catch (const std::bad_alloc&) {
    if constexpr (std::is_same_v<Fault, MethodError>) throw;
    throw Fault(named());
  } catch (...) {
    throw Fault(named());
  }
}

}  // namespace lgabench
