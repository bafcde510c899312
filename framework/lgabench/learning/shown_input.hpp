// What a policy acts on, as pictures for people. lgabench-worker, which links no learner, opens this library for them.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/selection.hpp>

namespace lgabench {

struct ShownPicture {
  std::string name, note;  // for a caption; "", or how it is read
  PictureSize size;
  int channels = 1;           // 1: a mask of 1, 0 and -1; 3: colours of 0 to 1
  std::vector<float> values;  // rows x columns x channels
};

struct ShownInput {
  std::vector<ShownPicture> pictures;
  std::vector<std::string> texts;   // that the policy reads beside them, in words for a caption
  std::vector<std::string> unread;  // of the method's inputs, what the policy leaves out
};

/// The input of a policy, made by the Featurizer that makes it in training and test. `input`: {"pictures", "text"?,
/// "left_out"?, "policy", "instances", "mask"}, the first three as paper/methods.json has them, the others as options.
/// `selection`: that the mask is made of. @throws InputError for what no such policy sees.
ShownInput shown_input(const JsonReader& input, const Observation& observation, const Selection& selection,
                       const ActionSpace& actions);

}  // namespace lgabench

/// Likewise, by a name that is found in the library.
extern "C" void lgabench_shown_input(const lgabench::JsonReader& input, const lgabench::Observation& observation,
                                     const lgabench::Selection& selection, const lgabench::ActionSpace& actions,
                                     lgabench::ShownInput& shown);
