#include <lgabench/leaderboard/titles.hpp>

#include <algorithm>
#include <cctype>

#include <lgabench/core/json.hpp>
#include <lgabench/report/about_suite.hpp>

namespace lgabench::leaderboard {
namespace {

std::string spaced(std::string id) {
  std::replace(id.begin(), id.end(), '_', ' ');
  return id;
}

}  // namespace

Titles::Titles(const std::string& suite) : id_(suite), suite_(spaced(suite)) {
  const fs::path file = report::installed_suite(suite);
  if (file.empty()) return;
  const Json about = read_json(file).value("about", Json::object());
  suite_ = about.value("title", suite_);
  const Json arms = about.value("arms", Json::object());
  for (const auto& [arm, words] : arms.items())
    arms_[arm] = words.is_object() ? words.value("title", spaced(arm)) : spaced(arm);
}

std::string Titles::arm(const std::string& id) const {
  std::string longest;
  for (const auto& [arm, title] : arms_)
    if ((id == arm || id.rfind(arm + "_", 0) == 0) && arm.size() > longest.size()) longest = arm;
  if (longest.empty() || longest == id) return longest.empty() ? spaced(id) : arms_.at(id);
  return arms_.at(longest) + ", " + spaced(id.substr(longest.size() + 1));
}

std::string Titles::scenario(const std::string& id) const {
  if (id.rfind(id_ + "_", 0) == 0) return spaced(id.substr(id_.size() + 1));
  const bool of_a_question =
      id.size() > 3 && id[0] == 'q' && std::isdigit(static_cast<unsigned char>(id[1])) && id[2] == '_';
  return spaced(of_a_question ? id.substr(3) : id);
}

}  // namespace lgabench::leaderboard
