#include <mobile/tables.hpp>

#include <lgabench/core/json.hpp>

namespace lgabench::mobile {
namespace {

struct Table {
  const Json json;
  const JsonReader reader;
  explicit Table(const char* name)
      : json(read_json(data_directory() / "mobile" / name)), reader(json, std::string("mobile/") + name) {}
};

}  // namespace

const std::map<std::string, std::vector<std::string>>& natural_textures() {
  static const auto all = [] {
    const Table table("natural_textures.json");
    const JsonReader of = table.reader.at("textures");
    std::map<std::string, std::vector<std::string>> read;
    for (const auto& [type, names] : of.json().items()) {
      read[type] = of.at(type).strings();
      if (read[type] == std::vector<std::string>{"plain"}) read[type] = table.reader.at("plain").strings();
    }
    return read;
  }();
  return all;
}

const std::map<std::string, std::vector<std::string>>& confusions() {
  static const auto all = [] {
    const Table table("confusions.json");
    const JsonReader of = table.reader.at("confusions");
    std::map<std::string, std::vector<std::string>> read;
    for (const auto& [type, entry] : of.json().items()) read[type] = of.at(type).at("as").strings();
    return read;
  }();
  return all;
}

}  // namespace lgabench::mobile
