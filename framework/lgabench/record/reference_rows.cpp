#include <lgabench/record/reference_rows.hpp>

#include <algorithm>

namespace lgabench {
namespace {

// Words for the members of a row that are true or false.
constexpr bool learns = true, in_every_suite = true, is_bound = true;

}  // namespace

const std::vector<ReferenceRow>& reference_rows() {
  static const std::vector<ReferenceRow> all{
      {"constant_action",
       "best constant action",
       "The best constant action: the same in every scene, from the training actions alone",
       learns,
       in_every_suite,
       {2, 3},
       RowMark{"baseline_not_learned", "†",
               "below the best constant action with as many demonstrations: nothing was learned"}},
      {random_object,
       "random visible object",
       "A visible object, drawn at random and handled as the expert would",
       !learns,
       in_every_suite,
       {8, 3, 2, 3},
       RowMark{"below_random_object", "§", "below the random visible object, which needs no demonstration"}},
      {"oracle",
       "oracle",
       "The expert, who knows the target: what success there can be",
       !learns,
       in_every_suite,
       {},
       {},
       is_bound},
      {"most_demonstrated",
       "most demonstrated",
       "The visible object whose type and texture the command's demonstrations took most often",
       learns,
       in_every_suite,
       {4, 2}},
      {"least_demonstrated",
       "least demonstrated",
       "The visible object that is least like anything demonstrations took",
       learns,
       !in_every_suite,
       {1, 4}},
      {"most_alike_names",
       "most alike in name",
       "The visible object whose names mean most nearly what the names of demonstrated targets mean, counted too",
       learns,
       !in_every_suite,
       {5, 1}},
      {"most_shared",
       "most shared features",
       "The visible object that shares types and textures with most others",
       !learns,
       !in_every_suite,
       {1, 2}},
      {"never_demonstrated",
       "never demonstrated",
       "A visible object that is like no demonstrated target",
       learns,
       !in_every_suite,
       {6, 2}},
      {"stops_at_once", "stops at once", "Says at once that nothing is left to do", !learns, !in_every_suite, {1, 3}},
      {"two_then_stops",
       "any two, then stops",
       "Two visible objects, drawn at random; then nothing is left to do",
       !learns,
       !in_every_suite,
       {3, 2, 1, 2}},
      {"stops_at_random",
       "stops at random",
       "At each step with odds of 0.3 nothing is left to do, else a visible object, drawn at random",
       !learns,
       !in_every_suite,
       {7, 3, 1, 3}}};
  return all;
}

const ReferenceRow* find_reference_row(const std::string& id) {
  const std::vector<ReferenceRow>& all = reference_rows();
  const auto found = std::find_if(all.begin(), all.end(), [&id](const ReferenceRow& row) { return row.id == id; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace lgabench
