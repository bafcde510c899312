// The other end: a method's process answers a worker's frames with a plugin.
#pragma once
#include <lgabench/host/frames.hpp>

namespace lgabench {

/// Loads the plugin that the first frame names and answers until "bye": true; or until there is no connection any more:
/// false. What the plugin throws is told to the worker. One thread. @throws MethodError for a frame that no worker
/// sends.
bool serve(Channel& channel);

}  // namespace lgabench
