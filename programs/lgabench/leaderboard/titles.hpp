// What readers are shown in the place of a suite's ids.
#pragma once
#include <string>

#include <lgabench/statistics/about_suite.hpp>

namespace lgabench::leaderboard {

/// The words of an id.
std::string spaced(std::string id);

/// Titles of a suite, its arms and scenarios, from "about" of the installed suite; where that says nothing, or there is
/// no such suite, the words of the id.
class Titles {
 public:
  explicit Titles(const std::string& suite);

  std::string suite() const;
  std::string arm(const std::string& id) const;
  /// Without the name of a suite before it.
  std::string scenario(const std::string& id) const;

 private:
  std::string id_;
  statistics::AboutSuite about_;
};

}  // namespace lgabench::leaderboard
