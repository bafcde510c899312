// Tables of errands by the names of what stands there: members of a class, near misses, what other commands mean.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/meaning.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench::tabletop {

/// Things to draw from: a type with equal odds, then a texture.
class Pool {
 public:
  void add(const std::string& type, const std::string& texture);
  bool empty() const { return types_.empty(); }
  bool holds(const Named& one) const;
  /// @pre it is not empty
  Named draw(RandomStream& random) const;
  /// Of its type or, as often, of its texture, where there are such.
  Named draw_like(const Named& other, RandomStream& random) const;
  template <class Which>
  Pool only(const Which& which) const {
    Pool some;
    for (std::size_t i = 0; i < types_.size(); ++i)
      for (const std::string& texture : textures_[i])
        if (which(Named{types_[i], texture})) some.add(types_[i], texture);
    return some;
  }

 private:
  std::vector<std::string> types_;
  std::vector<std::vector<std::string>> textures_;  // of each type
};

/// What some commands are about, and what else stands on their tables.
struct ErrandClass {
  std::vector<FeatureSet> sets;
  std::vector<Pool> members;     // of each of its parts: what turns of their own take
  Pool near;                     // what is nearly a member
  std::vector<Pool> others;      // what commands of each other class mean; where there is none, all else
  std::pair<int, int> belong{};  // so many members, fewest and most, stand in a test scene
};

struct Things {
  std::vector<Named> things;
  std::optional<Named> later = {};  // stands there after the first take
  std::optional<Named> meant = {};  // of a table to refuse: may stand in the last one's place
};

constexpr int test_things = 7, training_things = 5;

/// One draw of a test scene: none unless it tells the pair's commands apart, and each needs so many takes. `appears`:
/// something comes later.
std::optional<Things> draw_test(const ErrandClass& of, const std::vector<Meaning>& pair, std::pair<int, int> needed,
                                bool appears, RandomStream& random);
/// One draw of a demonstrated scene: none unless somebody takes something.
std::optional<Things> draw_training(const ErrandClass& of, const Meaning& meaning, RandomStream& random);
/// So many things of which none is meant, and one that is.
Things draw_to_refuse(const ErrandClass& of, int count, RandomStream& random);

}  // namespace lgabench::tabletop
