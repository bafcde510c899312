// The lexicon: words for sets of object types and of textures, from which commands are made.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <lgabench/core/feature_space.hpp>

namespace lgabench::drawn {

/// Words for a set of object types: what they are called, what they are, or what they are for.
struct Things {
  std::string a, many, ref;  // "a fork", "forks", "the fork"; empty where nobody would say it so
  std::vector<std::string> types, undecided,
      near;  // what they hold, what may be disputed, what is of a neighbouring set
  std::string why;
};

/// Words for a set of textures, which follow a noun: "with stripes".
struct Look {
  std::string words;
  std::vector<std::string> textures, undecided, near;
  std::string why;
  bool named = false;  // one texture, by its own name
};

/// Words for the first or the last of an order: "that comes first in the alphabet".
struct Order {
  std::string first, last;
  std::vector<std::string> names;  // object types or textures
  std::string why;
  bool of_textures = false;
};

/// Sets in the order of the space, without the type of the place that things are brought to.
struct Lexicon {
  FeatureSpace space;
  std::vector<Things> names, classes;
  std::vector<Look> looks;
  std::vector<Order> orders;
};

/// A name that the pattern fits, in which a * stands for any text.
bool fits(std::string_view pattern, std::string_view name);

/// A lexicon's file; none: the shipped one. @throws InputError with file and place, also for a name that fits nothing,
/// what is a member and undecided both, and words that two entries have.
Lexicon load_lexicon(const std::filesystem::path& file);
Lexicon read_lexicon(const Json& json, const std::string& file);

}  // namespace lgabench::drawn
