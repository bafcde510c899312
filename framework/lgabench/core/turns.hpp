// How objects are used in turn: what may be brought next, and when all is done.
#pragma once
#include <vector>

#include <lgabench/core/meaning.hpp>

namespace lgabench {

// Turns are fulfilled one after the other, each by what was brought next:
// - A turn that takes so many takes exactly these. One without a number takes until no other object could join.
// - A turn found nothing if it took nothing: nothing of its sets was there, or fewer than it takes that fit together.
// - A turn `only_if_nothing` is left out unless the turn before found nothing. Where no such turn follows, a turn that
//   takes so many must take them.
//
// What a later turn took was on the table before. What appears later counts as if it had been there from the beginning.
// A meaning without turns is one object of its sets. The order of `brought` counts, that of `on_table` does not.

/// The names of what may be brought next, each once, in the order of `on_table`: those with which, once they are taken,
/// the turns can still be fulfilled with what is on the table. @pre no `which`
std::vector<Named> wanted(const Meaning& meaning, const std::vector<Named>& on_table,
                          const std::vector<Named>& brought);

/// Whether "nothing is left to do" is right: what was brought fulfils the turns, or nothing was brought and they can
/// never be fulfilled. @pre no `which`
bool is_done(const Meaning& meaning, const std::vector<Named>& on_table, const std::vector<Named>& brought);

/// How many takes are left until all is done, if the first of what is wanted is always taken. @pre no `which`
int takes_left(const Meaning& meaning, std::vector<Named> on_table, std::vector<Named> brought);

}  // namespace lgabench
