// How objects may be used, and what demonstrations say of it: Bayes' rule over a finite list.
#pragma once
#include <optional>
#include <utility>
#include <vector>

#include <lgabench/core/meaning.hpp>

namespace lgabench {

/// One step of somebody who knows how: what stood on the table, what was brought before, and what was taken; none:
/// "done".
struct Chosen {
  std::vector<Named> on_table, brought;
  std::optional<Named> took;
};

/// The ways of hows.json in which objects of a meaning's sets may be used, each with its probability. `first` and
/// `second` are the sets of two turns, `either` is all of them. Who knows a way takes any of what is wanted with equal
/// odds, and says "done" where that is right.
class Hows {
 public:
  struct How {
    Meaning meaning;
    double probability;
  };
  struct Odds {
    double done = 0;
    std::vector<std::pair<Named, double>> wanted;  // that taking it is right, of each name on the table once
  };

  /// Before anything is shown. `meaning` gives the sets alone.
  explicit Hows(const Meaning& meaning);

  /// Bayes' rule for one step. A step that no way explains tells nothing.
  void saw(const Chosen& step);

  const std::vector<How>& all() const { return all_; }
  /// The first of the most probable.
  const Meaning& likeliest() const;
  /// That what may come next is right.
  Odds odds(const std::vector<Named>& on_table, const std::vector<Named>& brought) const;

 private:
  std::vector<How> all_;
};

}  // namespace lgabench
