#include <lgabench/abstraction/asked_model.hpp>

#include <fmt/format.h>

#include <string_view>

#include <lgabench/core/hash.hpp>

namespace lgabench {
namespace {

constexpr std::string_view of_prompt = " (prompt ";

}  // namespace

Json AskedModel::request(const Json& messages) const {
  Json body = fields;
  body["model"] = name;
  body["messages"] = messages;
  return body;
}

AskedModel AskedModel::of(const std::string& name, const JsonReader& request) {
  if (!request.json().is_object()) request.fail("an object");
  AskedModel model{name, request.json()};
  model.fields.erase("model");
  model.fields.erase("messages");
  return model;
}

AskedModel asked_model(const std::string& name, const std::string& patch_text, const std::string& prompt) {
  const Json json = patch_text.empty() ? Json::object() : parse_json(patch_text, "--request");
  const JsonReader patch(json, "--request");
  if (!patch.json().is_object()) patch.fail("an object, a JSON merge patch");
  for (const char* member : {"model", "messages", "stream"})
    if (patch.has(member)) patch.at(member).fail("no such member, which lgabench sets");
  for (const std::string_view mark : {std::string_view(" {"), of_prompt})
    if (name.find(mark) != std::string::npos)
      throw InputError(fmt::format("--model {}: expected no \"{}\" in it", name, mark));
  AskedModel model{name};
  model.fields.merge_patch(json);
  if (!prompt.empty()) model.prompt = sha256(prompt);
  return model;
}

Json patch_of(const AskedModel& model) {
  const Json usual = AskedModel().fields;
  Json patch = Json::object();
  for (const auto& [field, value] : model.fields.items())
    if (!usual.contains(field) || usual[field] != value) patch[field] = value;
  for (const auto& field : usual.items())
    if (!model.fields.contains(field.key())) patch[field.key()] = nullptr;
  return patch;
}

std::string to_text(const AskedModel& model) {
  const Json patch = patch_of(model);
  return model.name + (patch.empty() ? "" : " " + canonical(patch)) +
         (model.prompt.empty() ? "" : fmt::format("{}{})", of_prompt, model.prompt));
}

AskedModel read_asked_model(const std::string& text) {
  if (const std::size_t at = text.rfind(of_prompt); at != text.npos && text.back() == ')') {
    AskedModel model = read_asked_model(text.substr(0, at));
    model.prompt = text.substr(at + of_prompt.size(), text.size() - at - of_prompt.size() - 1);
    return model;
  }
  const std::size_t blank = text.find(" {");
  return blank == std::string::npos ? AskedModel{text} : asked_model(text.substr(0, blank), text.substr(blank + 1));
}

std::string command_words(const AskedModel& model) {
  const Json patch = patch_of(model);
  std::string quoted;  // for a shell, and for JSON as well
  for (const char c : canonical(patch)) quoted += c == '\'' ? std::string("\\u0027") : std::string(1, c);
  return "--model " + model.name + (patch.empty() ? "" : fmt::format(" --request '{}'", quoted)) +
         (model.prompt.empty() ? "" : " --prompt FILE");
}

}  // namespace lgabench
