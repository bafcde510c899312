// What a run kept of a learned policy: the bytes as a cell's file, and as what a policy saved, whose kind the first
// names.
#include <array>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/record/kept_policy.hpp>
#include <lgabench/record/layout.hpp>

#include "fuzz.hpp"

namespace {

using namespace lgabench;

class Masked : public CloningMethod {
 public:
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }
};

// Restoring asks nobody.
class NoModel : public LanguageModel {
  std::vector<bool> answer(const Command&, const FeatureSpace&, const std::vector<Question>&) override { return {}; }
  std::string model() const override { return {}; }
  Provenance provenance() const override { return {}; }
  SelectionCost cost() const override { return {}; }
};
class NoHuman : public HumanAnswers {
  Selection specify(const Command&) override { return {}; }
  Selection edit(const Command&, const Selection& proposal) override { return proposal; }
};
class NoLog : public TrainingLog {
  void epoch(int, long long, double) override {}
};

Json options_of(std::uint8_t kind) {
  constexpr std::array kinds{"centroid", "heat_map", "regression"};
  return {{"policy", kinds[kind % kinds.size()]},
          {"epochs", 1},
          {"batch_size", 1},
          {"learning_rate", .1},
          {"batches", "drawn"},
          {"network", "plain"},
          {"loss", "norm"}};
}

void read_file_of(std::string_view text) {
  try {
    read_kept_policy(fuzz::write(fuzz::directory() / cell_file::policy, text).parent_path());
  } catch (const InputError&) {
  }
}

void restore(std::uint8_t kind, const std::string& saved) {
  static const EnvironmentType& tabletop = find_environment("tabletop");
  static const ActionSpace actions = tabletop.action_space();
  const Json options = options_of(kind);
  NoModel model;
  NoHuman human;
  NoLog log;
  Services services{model, human, options, 1, log, actions};
  try {
    const auto policy = Masked().restore(saved, services);
    const PictureSize picture = tabletop.picture_size();
    const Observation one_object{picture,
                                 std::vector<std::uint8_t>(3 * picture.pixels()),
                                 std::vector<std::uint8_t>(picture.pixels(), 1),
                                 {{1, "heart", "red", 9}}};
    Selection all;
    all.target = Meaning({"heart"}, {"red"});
    policy->act(one_object, {"the heart", all});
  } catch (const InputError&) {
  } catch (const MethodError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  read_file_of(fuzz::text_of(data, size));
  restore(data[0], std::string(fuzz::text_of(data + 1, size - 1)));
  return 0;
}
