// hows.json, as CMake puts it into the library.
#pragma once
#include <lgabench/core/json.hpp>

namespace lgabench {

const Json& hows_json();

}  // namespace lgabench
