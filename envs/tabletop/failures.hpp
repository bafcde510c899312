// Words for a failure that all tasks of the tabletop share (docs/protocol.md, section 2). A task's own are in its file.
#pragma once
#include <lgabench/core/environment.hpp>

namespace lgabench::tabletop::failure {

using namespace lgabench::failure;
inline constexpr const char *missed_object = "missed_object", *wrong_object = "wrong_object";
inline constexpr const char* not_meant = "not_meant";  // belongs to what the command says, and is not the one
inline constexpr const char* left_workspace = "left_workspace";
inline constexpr const char* bad_placement = "bad_placement";  // of every task that sets its target down
// Why an errand is over: it was said to be done, an object was taken, before all was done and after it, or other
// objects moved.
inline constexpr const char *too_early = "too_early", *not_wanted = "not_wanted", *went_on = "went_on";
inline constexpr const char *lost_wanted = "lost_wanted", *knocked_on = "knocked_on";

}  // namespace lgabench::tabletop::failure
