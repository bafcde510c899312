#include <lgabench/drawn/lexicon.hpp>

#include <algorithm>
#include <set>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/meaning.hpp>
#include <lgabench/core/read_space.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench::drawn {
namespace {

using Names = std::vector<std::string>;

// In the order of the space.
Names read_names(const JsonReader& reader, const Names& space) {
  std::set<std::string> found;
  for (const JsonReader& pattern : reader.elements()) {
    const std::size_t before = found.size();
    for (const std::string& name : space)
      if (!is_place(name) && fits(pattern.string(), name)) found.insert(name);
    if (found.size() == before) pattern.fail("a name of the feature space that the list does not have yet");
  }
  Names ordered;
  for (const std::string& name : space)
    if (found.count(name) > 0) ordered.push_back(name);
  return ordered;
}

Names without(const Names& names, const Names& others) {
  Names rest;
  for (const std::string& name : names)
    if (!contains(others, name)) rest.push_back(name);
  return rest;
}

struct Sets {
  Names members, undecided, near;
};

Sets read_sets(const JsonReader& entry, const char* members, const Names& space) {
  Sets sets{read_names(entry.at(members), space), {}, {}};
  if (sets.members.empty()) entry.at(members).fail("at least one name");
  if (entry.has("undecided")) sets.undecided = read_names(entry.at("undecided"), space);
  for (const std::string& name : sets.undecided)
    if (contains(sets.members, name)) entry.at("undecided").fail("none of the members");
  if (!entry.has("near")) return sets;
  sets.near = without(without(read_names(entry.at("near"), space), sets.members), sets.undecided);
  if (sets.near.empty()) entry.at("near").fail("at least one name that is neither a member nor undecided");
  return sets;
}

std::string read_words(const JsonReader& reader, std::set<std::string>& known) {
  const std::string words = reader.string();
  if (words.empty() || words != one_line(words)) reader.fail("words, in a line");
  if (!known.insert(words).second) reader.fail("words that no other entry has");
  return words;
}

std::vector<Things> read_things(const JsonReader& list, const FeatureSpace& space, std::set<std::string>& known) {
  std::vector<Things> all;
  for (const JsonReader& entry : list.elements()) {
    entry.only({"a", "many", "ref", "types", "undecided", "near", "why"});
    Sets sets = read_sets(entry, "types", space.object_types);
    Things things{{}, {}, {}, std::move(sets.members), std::move(sets.undecided), std::move(sets.near), {}};
    for (const auto& [member, words] : {std::pair{"a", &things.a}, {"many", &things.many}, {"ref", &things.ref}})
      if (entry.has(member)) *words = read_words(entry.at(member), known);
    if (things.a.empty() && things.many.empty()) entry.fail("\"a\" or \"many\"");
    if (!things.ref.empty() && things.types.size() > 1)
      entry.at("ref").fail("one type, for words that point at one thing");
    things.why = entry.at("why").string();
    all.push_back(std::move(things));
  }
  return all;
}

}  // namespace

bool fits(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] != '*') return !name.empty() && name[0] == pattern[0] && fits(pattern.substr(1), name.substr(1));
  return fits(pattern.substr(1), name) || (!name.empty() && fits(pattern, name.substr(1)));
}

Lexicon read_lexicon(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  reader.only({"space", "note", "names", "classes", "looks", "orders"});
  Lexicon lexicon;
  lexicon.space = read_space(reader.at("space"));
  std::set<std::string> known;
  lexicon.names = read_things(reader.at("names"), lexicon.space, known);
  lexicon.classes = read_things(reader.at("classes"), lexicon.space, known);
  for (const JsonReader& entry : reader.at("looks").elements()) {
    entry.only({"words", "textures", "undecided", "near", "why", "named"});
    entry.at("near");
    Sets sets = read_sets(entry, "textures", lexicon.space.textures);
    lexicon.looks.push_back({read_words(entry.at("words"), known), std::move(sets.members), std::move(sets.undecided),
                             std::move(sets.near), entry.at("why").string(),
                             entry.has("named") && entry.at("named").boolean()});
  }
  for (const JsonReader& entry : reader.at("orders").elements()) {
    entry.only({"first", "last", "order", "why"});
    Order order{read_words(entry.at("first"), known), read_words(entry.at("last"), known), entry.at("order").strings(),
                entry.at("why").string()};
    order.of_textures = without(order.names, lexicon.space.textures).empty();  // "orange" is a name of both
    const Names& space = order.of_textures ? lexicon.space.textures : lexicon.space.object_types;
    for (const JsonReader& name : entry.at("order").elements()) {
      if (!contains(space, name.string()))
        name.fail("a name of the feature space: object types alone, or textures alone");
      if (std::count(order.names.begin(), order.names.end(), name.string()) > 1) name.fail("each name once");
    }
    if (order.names.size() < 2) entry.at("order").fail("at least two names");
    lexicon.orders.push_back(std::move(order));
  }
  for (const bool named : {true, false})
    if (std::none_of(lexicon.looks.begin(), lexicon.looks.end(), [&](const Look& one) { return one.named == named; }))
      reader.at("looks").fail("some with \"named\": true, and some without");
  for (const char* list : {"names", "classes", "looks", "orders"})
    if (reader.at(list).json().empty()) reader.at(list).fail("at least one entry");
  return lexicon;
}

Lexicon load_lexicon(const fs::path& file) {
  const fs::path shipped = data_directory() / "lexicons" / "household.json";
  const fs::path& read = file.empty() ? shipped : file;
  return read_lexicon(read_json(read), read.string());
}

}  // namespace lgabench::drawn
