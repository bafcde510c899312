// Typed errors: who is at fault decides what happens next.
#pragma once
#include <stdexcept>
#include <string>

namespace lgabench {

/// Base of every error the framework throws; what() is one line for a person.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

/// Bad input (configuration, file, option): names the file, the place and what was expected. Exit 2.
class InputError : public Error {
 public:
  using Error::Error;
  ~InputError() override;
};

/// A plugin could not be loaded; names both sides of a mismatch. Exit 4.
class PluginError : public Error {
 public:
  using Error::Error;
  ~PluginError() override;
};

/// A method threw, timed out or returned something unusable: its episodes fail as `method_error`.
class MethodError : public Error {
 public:
  using Error::Error;
  ~MethodError() override;
};

/// The engine or the host failed, not the method: counted as `n_error`, never as a failure of the method.
class EngineError : public Error {
 public:
  using Error::Error;
  ~EngineError() override;
};

}  // namespace lgabench
