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

using Names = std::vector<std::string>;

// Of each type; the word "plain" stands for the plain colours.
std::map<std::string, Names> textures_of(const char* file, const char* member) {
  const Table table(file);
  const JsonReader of = table.reader.at(member);
  std::map<std::string, Names> read;
  for (const auto& [type, names] : of.json().items())
    for (const std::string& texture : of.at(type).strings()) {
      const Names plain = texture == "plain" ? table.reader.at("plain").strings() : Names{texture};
      read[type].insert(read[type].end(), plain.begin(), plain.end());
    }
  return read;
}

std::map<std::string, Names> confusions_of(const char* file, const char* member) {
  const Table table(file);
  const JsonReader of = table.reader.at(member);
  std::map<std::string, Names> read;
  for (const auto& [name, entry] : of.json().items()) read[name] = of.at(name).at("as").strings();
  return read;
}

}  // namespace

const std::map<std::string, Names>& natural_textures() {
  static const auto all = textures_of("natural_textures.json", "textures");
  return all;
}

const std::map<std::string, Names>& fetch_textures() {
  static const auto all = textures_of("fetch_textures.json", "textures");
  return all;
}

const std::map<std::string, Names>& receiver_textures() {
  static const auto all = textures_of("fetch_textures.json", "receivers");
  return all;
}

const std::map<std::string, Names>& confusions() {
  static const auto all = confusions_of("confusions.json", "confusions");
  return all;
}

const std::map<std::string, Names>& fetch_confusions() {
  static const auto all = confusions_of("fetch_confusions.json", "types");
  return all;
}

const std::map<std::string, Names>& texture_confusions() {
  static const auto all = confusions_of("fetch_confusions.json", "textures");
  return all;
}

}  // namespace lgabench::mobile
