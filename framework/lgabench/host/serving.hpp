// Inside host/: what the hosts of methods and of perturbations share.
#pragma once
#include <new>

#include <lgabench/host/frames.hpp>
#include <lgabench/plugin/guarded.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// Tells the worker what `call` throws; true if nothing was thrown.
template <class Call>
bool told(Channel& channel, Call&& call) {
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

/// The plugin that "hello" names under its kind. @throws PluginError where it is not the one that the worker read.
PluginInfo named_plugin(const Frame& hello, const char* kind);

/// As serve(), of a perturbation.
void serve_perturbation(Channel& channel, Frame hello);

}  // namespace lgabench
