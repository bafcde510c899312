#include <lgabench/cell/selected_by.hpp>

namespace lgabench {

Needs SelectedBy::needs(const Json&) const {
  Needs needs;
  needs.revise = true;
  return needs;
}

Selection SelectedBy::select(const Command& command, const FeatureSpace& space, Services& services) {
  return selects_->select(command, space, services);
}

Selection SelectedBy::revise(const Command& command, const Selection& selected,
                             const std::vector<Demonstration>& demonstrations, Services& services) {
  return selects_->revise(command, selected, demonstrations, services);
}

std::unique_ptr<Policy> SelectedBy::learn(const std::vector<Demonstration>& demonstrations, Services& services) {
  end_selecting();
  acts_ = make_acts_();
  return acts_->learn(demonstrations, services);
}

std::vector<std::pair<std::string, std::string>> SelectedBy::files() const {
  return selects_ ? selects_->files() : files_;
}

void SelectedBy::end() {
  end_selecting();
  if (acts_) acts_->end();
}

void SelectedBy::end_selecting() {
  if (!selects_) return;
  files_ = selects_->files();
  selects_->end();
  selects_.reset();
}

}  // namespace lgabench
