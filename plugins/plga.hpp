// PLGA: as LGA, with what the person leaves unsaid, as far as what they take shows it (after Peng et al., HRI 2024).
#pragma once
#include <lgabench/abstraction/preference.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>

template <lgabench::AskPerson ask>
class Plga : public lgabench::CloningMethod {
 public:
  lgabench::Needs needs(const lgabench::Json& options) const override {
    lgabench::Needs needs = CloningMethod::needs(options);
    needs.revise = true;
    return needs;
  }
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    space_ = space;
    return lgabench::select_as_asked(command, space, services);
  }
  lgabench::Selection revise(const lgabench::Command& command, const lgabench::Selection& selected,
                             const std::vector<lgabench::Demonstration>& demonstrations,
                             lgabench::Services& services) override {
    return lgabench::preferred(command, selected, space_, demonstrations, services, ask);
  }

 private:
  lgabench::FeatureSpace space_;
};
