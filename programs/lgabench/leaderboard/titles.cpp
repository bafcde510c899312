#include <lgabench/leaderboard/titles.hpp>

#include <algorithm>
#include <cctype>

namespace lgabench::leaderboard {

std::string spaced(std::string id) {
  std::replace(id.begin(), id.end(), '_', ' ');
  return id;
}

Titles::Titles(const std::string& suite) : id_(suite), about_(statistics::about_suite(suite)) {}

std::string Titles::suite() const { return about_.title == id_ ? spaced(id_) : about_.title; }

std::string Titles::arm(const std::string& id) const { return spaced(about_.arm_title(id)); }

std::string Titles::scenario(const std::string& id) const {
  if (id.rfind(id_ + "_", 0) == 0) return spaced(id.substr(id_.size() + 1));
  const bool of_a_question =
      id.size() > 3 && id[0] == 'q' && std::isdigit(static_cast<unsigned char>(id[1])) && id[2] == '_';
  return spaced(of_a_question ? id.substr(3) : id);
}

}  // namespace lgabench::leaderboard
