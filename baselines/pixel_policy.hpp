// What rows share whose policy sees the picture and the command, and in which what was selected enters elsewhere than
// in the input.
#pragma once
#include <lgabench/abstraction/repaint.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>

class PixelPolicy : public lgabench::CloningMethod {
 public:
  lgabench::Needs needs(const lgabench::Json&) const override {
    lgabench::Needs needs;
    needs.shadows = true;
    return needs;
  }
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    return lgabench::select_as_asked(command, space, services);
  }

 protected:
  lgabench::PolicyInputs inputs(const lgabench::Json&) const override {
    return {{lgabench::PolicyInputs::Picture::rgb}, lgabench::PolicyInputs::Text::utterance};
  }
};
