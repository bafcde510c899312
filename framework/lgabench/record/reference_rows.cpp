#include <lgabench/record/reference_rows.hpp>

#include <algorithm>

namespace lgabench {

const std::vector<ReferenceRow>& reference_rows() {
  static const std::vector<ReferenceRow> all{
      {"constant_action", true, true,
       "The best constant action: the same in every scene, from the training actions alone"},
      {"random_object", false, true, "A visible object, drawn at random and handled as the expert would"},
      {"oracle", false, true, "The expert, who knows the target: what success there can be"},
      {"most_demonstrated", true, true,
       "The visible object whose type and texture the command's demonstrations took most often"},
      {"least_demonstrated", true, false, "The visible object that is least like anything demonstrations took"},
      {"most_shared", false, false, "The visible object that shares types and textures with most others"},
      {"never_demonstrated", true, false, "A visible object that is like no demonstrated target"}};
  return all;
}

const ReferenceRow* find_reference_row(const std::string& id) {
  const std::vector<ReferenceRow>& all = reference_rows();
  const auto found = std::find_if(all.begin(), all.end(), [&id](const ReferenceRow& row) { return row.id == id; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace lgabench
