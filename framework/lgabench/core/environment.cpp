#include <lgabench/core/environment.hpp>

#include <lgabench/core/error.hpp>

namespace lgabench {

std::string to_string(Failure failure) {
  switch (failure) {
    case Failure::none:
      return "none";
    case Failure::missed_object:
      return "missed_object";
    case Failure::wrong_object:
      return "wrong_object";
    case Failure::bad_placement:
      return "bad_placement";
    case Failure::bad_angle:
      return "bad_angle";
    case Failure::missed_zone:
      return "missed_zone";
    case Failure::touched_obstacle:
      return "touched_obstacle";
    case Failure::left_workspace:
      return "left_workspace";
    case Failure::truncated:
      return "truncated";
    case Failure::abstraction_empty:
      return "abstraction_empty";
    case Failure::method_error:
      return "method_error";
  }
  throw Error("a Failure outside its enumeration");
}

}  // namespace lgabench
