// What runs of earlier versions say, in today's words. The only place that knows of them.
#pragma once
#include <lgabench/core/json.hpp>

namespace lgabench::report {

/// A method's options in a form in which two rows of one id are equal where they mean the same, whatever version of
/// lgabench recorded them: renamed options have today's name, and an option with the value that held before it existed
/// is left out. Compare with each other alone.
Json meaning_of(const Json& options);

}  // namespace lgabench::report
