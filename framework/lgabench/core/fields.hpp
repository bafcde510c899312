// Values that are written to JSON or read from it. A type's fields() names its members once; from that come its reader,
// its writer and its JSON Schema. For the .cpp of a record: other code calls its to_json() and its reader.
//
//   void fields(Point& point, Fields& field) {
//     field("x", point.x);
//     field("label", point.label, when(!point.label.empty()));
//   }
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// A place in JSON that a value is read from, written to, or described for. One of the three pointers is not null.
struct Slot {
  const JsonReader* read = nullptr;
  Json* write = nullptr;   // null until the value is written
  Json* schema = nullptr;  // JSON Schema, draft 7; stays null where any value is taken
  bool strict = true;      // an object that is read has no other members

  Slot at(const JsonReader& reader) const { return {&reader, nullptr, nullptr, strict}; }
  Slot at(Json& member) const { return write ? Slot{nullptr, &member} : Slot{nullptr, nullptr, &member}; }
};

/// When a member is written, and which values it may have.
struct Form {
  bool needed = true, written = true;         // needed: else the value stays as it is where the member is not there
  bool may_be_null = false, null = false;     // null: the value that is written
  bool object = false;                        // of JSON
  long long lowest = 0, highest = INT64_MAX;  // of whole numbers; a schema has a highest one below 2^30 alone
  double most = INFINITY;                     // of other numbers, which then begin at 0; a schema has it likewise
  const char *const *words = nullptr, *expectation = nullptr;  // a format for the words; else "a, b or c"
  std::size_t count = 0;                                       // of words
};
inline Form when(bool written) { return {false, written}; }
inline Form may_lack() { return when(true); }
inline Form or_null(bool null, Form form = {}) {
  form.may_be_null = true;
  form.null = null;
  return form;
}
inline Form object(Form form = {}) {
  form.object = true;
  return form;
}
inline Form within(long long lowest, long long highest, Form form = {}) {
  form.lowest = lowest;
  form.highest = highest;
  return form;
}
inline Form up_to(double most, Form form = {}) {
  form.most = most;
  return form;
}
inline Form at_least(long long lowest, Form form = {}) {
  form.lowest = lowest;
  return form;
}
template <class Words>
Form one_of(const Words& words, Form form = {}, const char* expectation = nullptr) {
  form.words = std::data(words);
  form.count = std::size(words);
  form.expectation = expectation;
  return form;
}

/// What fields() names its members to, in the order in which they are read.
class Fields {
 public:
  /// `known` gives the names of all members. @throws InputError where what is read is no object, or has another member.
  explicit Fields(const Slot& slot, const std::vector<std::string>& (*known)() = nullptr);

  template <class T>
  void operator()(const char* name, T&& value, const Form& form = {}) {
    add(name, form, [&](const Slot& slot) { visit(slot, value, form); });
  }
  /// The object that is read, for what forms cannot express; null where none is read.
  const JsonReader* reading() const { return slot_.read; }
  /// Names of the members that were described.
  const std::vector<std::string>& names() const { return names_; }

 private:
  void add(const char* name, const Form& form, const std::function<void(const Slot&)>& visit_in);

  Slot slot_;
  std::vector<std::string> names_;
};

/// Reads, writes or describes a value. Other types have fields(), or a visit() of their own beside them.
void visit(const Slot& slot, std::string& text, const Form& form);
void visit(const Slot& slot, fs::path& path, const Form& form);
void visit(const Slot& slot, bool& value, const Form& form);
void visit(const Slot& slot, double& number, const Form& form);
void visit(const Slot& slot, Json& any, const Form& form);
long long visit_integer(const Slot& slot, long long value, long long highest, const Form& form);
template <class T>
std::enable_if_t<std::is_integral_v<T>> visit(const Slot& slot, T& value, const Form& form) {
  using Limits = std::numeric_limits<T>;
  constexpr long long highest = Limits::digits < 63 ? static_cast<long long>(Limits::max()) : INT64_MAX;
  const long long number = visit_integer(slot, static_cast<long long>(value), std::min(highest, form.highest), form);
  if (slot.read) value = static_cast<T>(number);
}
template <class T>
auto visit(const Slot& slot, T& value, const Form&) -> decltype(fields(value, std::declval<Fields&>()));

template <class T>
void visit(const Slot& slot, std::optional<T>& value, const Form& form) {
  T described{};
  if (slot.read) value = T{};
  if (value || slot.schema) visit(slot, value ? *value : described, form);
}

template <class T>
void visit(const Slot& slot, std::vector<T>& values, const Form& form) {
  T described{};
  if (slot.read)
    for (const JsonReader& element : slot.read->elements()) visit(slot.at(element), values.emplace_back(), form);
  if (slot.write) *slot.write = Json::array();
  if (slot.write)
    for (T& value : values) visit(slot.at(slot.write->emplace_back()), value, form);
  if (slot.schema) (*slot.schema)["type"] = "array";
  if (slot.schema) visit(slot.at((*slot.schema)["items"]), described, form);
}

/// The JSON Schema of what fields() writes, and where its members depend on the value, of that form of it.
template <class T>
Json schema_of(T form = {}) {
  Json schema;
  Fields members({nullptr, nullptr, &schema});
  fields(form, members);
  return schema;
}

template <class T>
auto visit(const Slot& slot, T& value, const Form&) -> decltype(fields(value, std::declval<Fields&>())) {
  Fields members(slot, []() -> const std::vector<std::string>& {
    static const std::vector<std::string> names = [] {
      Json schema;
      T form{};
      Fields described({nullptr, nullptr, &schema});
      fields(form, described);
      return described.names();
    }();
    return names;
  });
  fields(value, members);
}

/// An object that is no type of its own, as a function that names its members.
template <class Members>
std::enable_if_t<std::is_invocable_v<Members&, Fields&>> visit(const Slot& slot, Members& members, const Form&) {
  if (Json schema; slot.read && slot.strict) {
    Fields described({nullptr, nullptr, &schema});
    members(described);
    slot.read->only(described.names());
  }
  Fields named(slot);
  members(named);
}

/// What fields() writes.
template <class T>
Json json_of(T value) {
  Json json;
  visit({nullptr, &json}, value, {});
  return json;
}
/// What fields() reads: other members are refused, or with `strict` false passed over. @throws InputError
template <class T>
T value_of(const JsonReader& reader, bool strict = true) {
  T value{};
  visit({&reader, nullptr, nullptr, strict}, value, {});
  return value;
}

}  // namespace lgabench
