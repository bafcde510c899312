// What readers are shown in the place of a suite's ids.
#pragma once
#include <map>
#include <string>

namespace lgabench::leaderboard {

/// From "about" of the installed suite; where that says nothing, or there is no such suite, the words of the id.
class Titles {
 public:
  explicit Titles(const std::string& suite);

  const std::string& suite() const { return suite_; }
  /// That of "seen" and the rest of the id for "seen_members_1", an arm of a variant.
  std::string arm(const std::string& id) const;
  /// Without the name of a suite before it.
  std::string scenario(const std::string& id) const;

 private:
  std::string id_, suite_;
  std::map<std::string, std::string> arms_;
};

}  // namespace lgabench::leaderboard
