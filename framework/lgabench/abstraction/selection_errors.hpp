// Makes errors in Selections on purpose, to measure how much an error of an abstraction costs.
#pragma once
#include <cstdint>
#include <string>

#include <lgabench/core/json.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/selection.hpp>

namespace lgabench {

/// The probability that a true feature is missing, and that a wrong one is added: 0 to 1.
struct SelectionErrors {
  double missing = 0, added = 0;

  bool none() const { return missing == 0 && added == 0; }
  /// The end of a row's name: "+added=0.2+missing=0.1", "" without errors.
  std::string suffix() const;
};
bool operator==(const SelectionErrors& a, const SelectionErrors& b);

/// {"missing": p, "added": q}, without what is 0.
Json to_json(const SelectionErrors& errors);
/// @throws InputError for another member, or a number outside 0 to 1.
SelectionErrors read_selection_errors(const JsonReader& reader);

/// Why no errors can be made in what is selected for the scenario's commands, in a few words; "" where they can.
std::string why_no_selection_errors(const Scenario& scenario);

/// Returns `selected`, of the scenario's command number `command`, with errors. Each feature has one number in [0, 1),
/// from a stream of (utterance, training seed), and errs if that lies below the probability. A higher probability thus
/// keeps all errors of a lower one, alike for every method. `never_meant`: an object type that no set with errors
/// holds, as the place to bring things to; "" for none.
Selection with_errors(Selection selected, const Scenario& scenario, int command, const SelectionErrors& errors,
                      std::uint64_t training_seed, const std::string& never_meant);
/// The same errors, decided by the numbers of `random`.
Selection with_errors(Selection selected, const Scenario& scenario, int command, const SelectionErrors& errors,
                      RandomStream random, const std::string& never_meant);

}  // namespace lgabench
