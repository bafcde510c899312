// Inside host/: what the hosts of methods and of perturbations share.
#pragma once
#include <cfenv>
#include <new>

#include <lgabench/host/frames.hpp>
#include <lgabench/host/process_state.hpp>
#include <lgabench/plugin/guarded.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// Tells the worker what `call` throws; true if nothing was thrown.
template <class Call>
bool report_errors_of(Channel& channel, Call&& call) {
  const auto tell = [&channel](const char* kind, const std::string& reason) {
    channel.send({{"type", "error"}, {"kind", kind}, {"reason", reason.substr(0, 2000)}});
  };
  try {
    call();
    return true;
  } catch (const std::bad_alloc&) {
    tell("memory", "out of memory");
  } catch (const PluginError& e) {
    tell("plugin", e.what());
  } catch (...) {
    tell("method", current_exception_text());
  }
  return false;
}

/// Whether a plugin left the processor's arithmetic as it was.
struct Arithmetic {
  bool flushed = true, rounds = true;  // as in ProcessState

  void note() {
    flushed = flushed && denormals_flushed();
    rounds = rounds && std::fegetround() == FE_TONEAREST;
  }
  void tell(ProcessState& state) const {
    state.flushed = flushed;
    state.rounds = rounds;
  }
};

/// Notes it at the end of a call, however that is left; before FlushDenormalsAgain, if it is made after it.
class NotesArithmetic {
 public:
  explicit NotesArithmetic(Arithmetic& noted) : noted_(noted) {}
  ~NotesArithmetic() { noted_.note(); }
  NotesArithmetic(const NotesArithmetic&) = delete;
  NotesArithmetic& operator=(const NotesArithmetic&) = delete;

 private:
  Arithmetic& noted_;
};

/// The plugin that "hello" names under its kind. @throws PluginError where it is not the one that the worker read.
PluginInfo named_plugin(const Frame& hello, const char* kind);

/// Serves a perturbation or a perceiver, as serve() does a method.
bool serve_perturbation(Channel& channel, Frame hello);

}  // namespace lgabench
