#include <lgabench/core/fields.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace lgabench {
namespace {

template <class T>
void leaf(const Slot& slot, T& value, T (JsonReader::*read)() const, const char* type) {
  if (slot.read) value = (slot.read->*read)();
  if (slot.write) *slot.write = value;
  if (slot.schema) (*slot.schema)["type"] = type;
}

}  // namespace

Fields::Fields(const Slot& slot, const std::vector<std::string>& (*known)()) : slot_(slot) {
  if (slot.read && slot.strict && known) slot.read->only(known());
  if (slot.read && !slot.read->json().is_object()) slot.read->fail("an object");
  if (slot.write) *slot.write = Json::object();
  if (slot.schema) (*slot.schema)["type"] = "object";
  if (slot.schema) (*slot.schema)["additionalProperties"] = false;
}

void Fields::add(const char* name, const Form& form, const std::function<void(const Slot&)>& visit_in) {
  if (slot_.read && (form.needed || slot_.read->has(name))) {
    const JsonReader member = slot_.read->at(name);
    if (!form.may_be_null || !member.json().is_null()) visit_in(slot_.at(member));
  }
  if (slot_.write && form.written) {
    Json& member = (*slot_.write)[name];
    if (!form.null) visit_in(slot_.at(member));
  }
  if (!slot_.schema) return;
  names_.emplace_back(name);
  Json& member = (*slot_.schema)["properties"][name];
  visit_in(slot_.at(member));
  if (form.may_be_null && form.words)
    member["enum"].push_back(nullptr);
  else if (form.may_be_null)
    member["type"] = {member["type"], "null"};
  if (form.needed) (*slot_.schema)["required"].push_back(name);
}

void visit(const Slot& slot, bool& value, const Form&) { leaf(slot, value, &JsonReader::boolean, "boolean"); }

void visit(const Slot& slot, double& number, const Form& form) {
  leaf(slot, number, &JsonReader::number, "number");
  if (std::isinf(form.most)) return;
  if (slot.schema) (*slot.schema)["minimum"] = 0;
  if (slot.schema && form.most < 1 << 30) (*slot.schema)["maximum"] = form.most;
  if (slot.read && !(number >= 0 && number <= form.most))
    slot.read->fail(fmt::format("a number from 0 to {:g}", form.most));
}

void visit(const Slot& slot, std::string& text, const Form& form) {
  leaf(slot, text, &JsonReader::string, "string");
  if (!form.words) return;
  const char *const *const last = form.words + form.count - 1, *const *const end = last + 1;
  if (slot.schema) *slot.schema = {{"enum", std::vector<std::string>(form.words, end)}};
  if (!slot.read || std::find(form.words, end, text) != end) return;
  slot.read->fail(form.expectation ? fmt::format(fmt::runtime(form.expectation), fmt::join(form.words, end, ", "))
                                   : fmt::format("{} or {}", fmt::join(form.words, last, ", "), *last));
}

void visit(const Slot& slot, fs::path& path, const Form& form) {
  std::string text = path.string();
  visit(slot, text, form);
  if (slot.read) path = text;
}

void visit(const Slot& slot, Json& any, const Form& form) {
  if (slot.read && form.object && !slot.read->json().is_object()) slot.read->fail("an object");
  if (slot.read) any = slot.read->json();
  if (slot.write) *slot.write = any;
  if (slot.schema && form.object) (*slot.schema)["type"] = "object";
}

long long visit_integer(const Slot& slot, long long value, long long highest, const Form& form) {
  if (slot.read) return slot.read->integer(form.lowest, highest);
  if (slot.write) *slot.write = value;
  if (slot.schema) *slot.schema = {{"type", "integer"}, {"minimum", form.lowest}};
  if (slot.schema && form.highest < 1 << 30) (*slot.schema)["maximum"] = form.highest;
  return value;
}

}  // namespace lgabench
