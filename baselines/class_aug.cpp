// The selected class in the data: in half of each step's copies its target has another look that was selected, in half
// another member stands elsewhere in its place. After ROSIE (arXiv 2302.11550) and copy-paste augmentation (Ghiasi et
// al., CVPR 2021, arXiv 2012.07177): what was demonstrated in place of generated pictures, ids in place of a segmenter.
#include <fmt/format.h>

#include <lgabench/plugin/plugin.hpp>

#include "class_copies.hpp"
#include "pixel_policy.hpp"

using namespace lgabench;

class ClassAug : public PixelPolicy {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    if (command.second)
      throw MethodError(
          fmt::format("class_aug: expected a command of a target alone, got one with {}, on which the label of a "
                      "member elsewhere depends",
                      command.second->phrase));
    Selection selection = PixelPolicy::select(command, space, services);
    if (selection.target.which || !selection.target.turns.empty())
      throw MethodError(
          "class_aug: expected a meaning without a rule or turns, since a member elsewhere may not be the one meant");
    textures_ = space.textures;
    return selection;
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    class_.emplace(demonstrations, services.actions, textures_);
    return PixelPolicy::learn(demonstrations, services);
  }

 protected:
  int copies(const Json& options) const override { return options.at("copies").get<int>(); }
  void augment(Step& step, const Selection& selection, int copy, RandomStream& stream) const override {
    if (copy % 2 == 0)
      class_->another_look(step, selection.target, stream);
    else
      class_->another_member(step, selection.target, stream);
  }

 private:
  std::vector<std::string> textures_;
  std::optional<ClassCopies> class_;
};

LGABENCH_METHOD("class_aug", "0.1",
                "Behaviour cloning on the picture, with more of the selected class put into the data", ClassAug,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_NO_MASK_OPTIONS "," LGABENCH_COPIES_OPTION R"(,
  "copies": {"default": 6, "min": 1, "max": 64, "help": "of each step: half in other looks, half with a member elsewhere", "source": "ours"}})")
