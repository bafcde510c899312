#include <lgabench/core/error.hpp>

namespace lgabench {

// Out of line, so that each type has one type_info that every library shares.
Error::~Error() = default;
InputError::~InputError() = default;
PluginError::~PluginError() = default;
MethodError::~MethodError() = default;
EngineError::~EngineError() = default;

}  // namespace lgabench
