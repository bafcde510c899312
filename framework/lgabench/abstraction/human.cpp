#include <lgabench/abstraction/human.hpp>

#include <utility>

namespace lgabench {

TruthAsHuman::TruthAsHuman(Selection truth) : truth_(std::move(truth)) {
  truth_.provenance = Provenance::truth;
  truth_.source = "true distribution";
}

Selection TruthAsHuman::specify(const Command&) { return truth_; }

Selection TruthAsHuman::edit(const Command&, const Selection& proposal) {
  Selection edited = proposal;
  edited.target.object_types = truth_.target.object_types;
  if (edited.avoid && truth_.avoid) edited.avoid->object_types = truth_.avoid->object_types;
  edited.provenance = Provenance::simulated_edit;
  edited.source += ", object types corrected to the true ones";
  return edited;
}

}  // namespace lgabench
