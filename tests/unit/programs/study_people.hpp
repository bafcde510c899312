// A study in a temporary directory, and what a page would post.
#pragma once
#include <lgabench/study/study.hpp>

#include "../testing.hpp"

namespace lgabench::study {

/// A shipped protocol with its blanks filled, and a consent file, in `directory`.
inline fs::path ready_protocol(const fs::path& directory, const std::string& name,
                               const Json& changes = Json::object()) {
  std::string text = read_file(data_directory() / "protocols" / (name + ".json.in"));
  text.replace(text.find("@SEED@"), 6, "7");
  if (const std::size_t at = text.find("@PAIRS@"); at != text.npos) text.replace(at, 7, "[]");
  for (std::size_t at = 0; (at = text.find("[[", at)) != text.npos;)
    text.replace(at, text.find("]]", at) + 2 - at, "invented for a test");
  Json json = parse_json(text, name);
  json.update(changes);
  write_file(directory / "protocol.json", json.dump(1));
  write_file(directory / "consent.txt", "I agree.\n");
  return directory / "protocol.json";
}

/// A page of one person: events with keys of their own, by a clock that the test moves.
struct Page {
  std::string name = "page";
  double ms = 0;
  int sent = 0;

  Json event(const std::string& kind, const Json& more = Json::object()) {
    Json json{{"key", name + std::to_string(++sent)}, {"page", name}, {"kind", kind}, {"page_ms", ms}};
    json.update(more);
    return json;
  }
};

inline Json edit(const std::string& feature, const std::vector<std::string>& values, bool on = true) {
  return {{"role", "target"}, {"feature", feature}, {"values", values}, {"on", on}};
}
/// NASA-TLX with one number for all scales.
inline Json tlx(int value) {
  Json json;
  for (const char* scale : {"mental", "physical", "temporal", "performance", "effort", "frustration"})
    json[scale] = value;
  return json;
}
inline Json submitted(const std::vector<std::string>& types, const std::vector<std::string>& textures,
                      double wait_ms = 0) {
  return {{"selection", {{"target", {{"object_types", types}, {"textures", textures}}}}}, {"longest_wait_ms", wait_ms}};
}

}  // namespace lgabench::study
