// Does a result depend on the engine? The same scene and the same action on two of them.
#pragma once
#include <string>
#include <vector>

#include <lgabench/statistics/pairs.hpp>

namespace lgabench::statistics {

/// An episode that one engine calls a success and the other a failure.
struct Disagreement {
  const CellResult* cell = nullptr;  // the first engine's; of the run that was given
  std::string arm;
  std::size_t index = 0;       // of the scene in the arm
  std::string failure_second;  // on the second engine; the first's is the episode's own

  const Episode& episode() const { return cell->episodes.at(arm)[index]; }
};

struct AgreementRow {
  std::string method;     // a row's name; "" for all of them
  EpisodePairs same;      // of scenes that both engines played with the same action, bit for bit
  int other_actions = 0;  // with another one: the policy was trained on what the other engine showed
  Interval interval;      // Wilson's, 95 %, of same.agreed() / same.episodes
};

/// Two engines of one layout.
struct EngineAgreement {
  std::string layout, first, second;
  std::vector<AgreementRow> rows;  // in the order of tables; all of them last, where an action counts once a scene
  std::vector<Disagreement> disagreements;  // likewise once
  int several_steps = 0;  // episodes of scenes that both played, of several steps: no one action decides these, and no
                          // row has them
};

/// Every pair of engines that share a layout; empty for a run on one engine. Pairs cells by scenario, row,
/// demonstrations and training seed, their episodes by arm and index.
std::vector<EngineAgreement> engine_agreement(const RunResults& run);

Json to_json(const std::vector<EngineAgreement>& agreements);

}  // namespace lgabench::statistics
