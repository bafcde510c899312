// Words for a failure that all tasks of the tabletop share (docs/protocol.md, section 2). A task's own are in its file.
#pragma once
#include <lgabench/core/environment.hpp>

namespace lgabench::tabletop::failure {

using namespace lgabench::failure;
inline constexpr const char *missed_object = "missed_object", *wrong_object = "wrong_object";
inline constexpr const char* not_meant = "not_meant";  // belongs to what the command says, and is not the one
inline constexpr const char* left_workspace = "left_workspace";
inline constexpr const char* bad_placement = "bad_placement";  // of every task that sets its target down

}  // namespace lgabench::tabletop::failure
