// JSON Schemas in docs/formats of records that fields() names. The record gives a schema its members, types and bounds;
// docs/descriptions gives it what only a person can say: descriptions, and constraints that no Form has, such as
// patterns, or which members go together. LGABENCH_WRITE_GOLDEN=1 writes the schemas.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include <lgabench/core/fields.hpp>

namespace lgabench {

using OrderedJson = nlohmann::ordered_json;

/// What a person says of a node, completed by what the record declares of it. Members stand as the person orders them;
/// a text is a member's description. `problems`: of members without one, and of words about a member that is not there.
inline OrderedJson completed(const OrderedJson& said, const OrderedJson& declared, const std::string& place,
                             std::vector<std::string>& problems) {
  if (said.is_object() && said.contains("$ref")) return said;  // to a definition, which is completed in its place
  OrderedJson node = OrderedJson::object();
  const OrderedJson person = said.is_string() ? OrderedJson{{"description", said}} : said;
  for (const char* first : {"$schema", "title", "description", "type", "required"})
    for (const OrderedJson* from : {&person, &declared})
      if (from->contains(first)) node[first] = from->at(first);
  if (person.is_object()) node.update(person);
  for (const auto& [key, value] : declared.items()) {
    if (key == "properties") {
      OrderedJson members = OrderedJson::object();
      for (const auto& [name, member] : node[key].items())
        if (value.contains(name))
          members[name] = completed(member, value.at(name), place + '/' + name, problems);
        else if (member.is_object())
          members[name] = member;  // one that the person alone knows
        else
          problems.push_back(place + '/' + name + ": no such member");
      for (const auto& [name, member] : value.items())
        if (!members.contains(name)) members[name] = completed({}, member, place + '/' + name, problems);
      for (const auto& [name, member] : value.items())
        if (!members[name].contains("description")) problems.push_back(place + '/' + name + ": no description");
      node[key] = members;
    } else if (key == "required") {
      for (const OrderedJson& name : value)
        if (std::find(node[key].begin(), node[key].end(), name) == node[key].end()) node[key].push_back(name);
    } else if (value.is_object()) {
      node[key] = completed(node.value(key, OrderedJson::object()), value, place + '/' + key, problems);
    } else if (!value.is_null() && !node.contains(key)) {
      node[key] = value;
    }
  }
  return node;
}

/// On one line, or with `indent` on a line for each member, but on one what fits there.
inline std::string text_of(const OrderedJson& node, std::optional<std::size_t> indent = 0, std::size_t before = 0) {
  constexpr std::size_t longest = 140;
  if (!node.is_structured()) return node.dump();
  if (indent)
    if (const std::string line = text_of(node, {}); line.size() + *indent + before < longest || node.empty())
      return line;
  const std::string pad = indent ? '\n' + std::string(*indent, ' ') : "", more = indent ? pad + "  " : "";
  const char* const ends = node.is_object() ? "{}" : "[]";
  std::string text;
  for (const auto& [name, value] : node.items()) {
    const std::string key = node.is_object() ? OrderedJson(name).dump() + ": " : "";
    text += (text.empty() ? "" : indent ? "," : ", ") + more + key;
    text += text_of(value, indent ? std::optional(*indent + 2) : std::nullopt, key.size());
  }
  return ends[0] + text + pad + ends[1];
}

/// Expects that the schema says at `place` what is declared and described there, and nothing else. What stands around
/// it is written by hand.
inline void expect_schema(const std::string& name, const Json& declared, const std::string& place = "") {
  const fs::path folder = LGABENCH_FORMATS, file = folder / (name + ".schema.json");
  const OrderedJson::json_pointer at(place);
  OrderedJson described = OrderedJson::parse(read_file(folder.parent_path() / "descriptions" / (name + ".json")));
  if (place.empty()) described["$schema"] = "http://json-schema.org/draft-07/schema#";
  const std::string there = fs::exists(file) ? read_file(file) : "{}";
  OrderedJson wanted = OrderedJson::parse(there);
  std::vector<std::string> problems;
  wanted[at] = completed(described.at(at), OrderedJson::parse(declared.dump()), name + place, problems);
  const std::string text = text_of(wanted) + '\n';
  if (std::getenv("LGABENCH_WRITE_GOLDEN")) write_file(file, text);
  EXPECT_EQ(problems, std::vector<std::string>()) << "docs/descriptions/" << name << ".json";
  EXPECT_TRUE(there == text) << "docs/formats/" << name << ".schema.json: LGABENCH_WRITE_GOLDEN=1 writes it";
}

}  // namespace lgabench
