#include <lgabench/record/train_on.hpp>

#include <limits>

#include <lgabench/record/fields.hpp>

namespace lgabench {
namespace {

constexpr const char* any = "any";

}  // namespace

Json to_json(const TrainOn& through) { return {{through.axis, through.level ? Json(*through.level) : Json(any)}}; }

TrainOn read_train_on(const JsonReader& reader) {
  const Json& json = reader.json();
  if (!json.is_object() || json.size() != 1) reader.fail("an object with one axis and its level, or \"any\"");
  const std::string axis = json.begin().key();
  const JsonReader level = reader.at(axis);
  if (level.json() == any) return {axis, {}};
  if (!level.json().is_number_integer()) level.fail("a level, or \"any\"");
  return {axis, static_cast<int>(level.integer(1, std::numeric_limits<int>::max()))};
}

void visit(const Slot& slot, TrainOn& through, const Form&) {
  if (slot.read) through = read_train_on(*slot.read);
  if (slot.write) *slot.write = to_json(through);
}

}  // namespace lgabench
