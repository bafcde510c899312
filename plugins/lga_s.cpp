// LGA-S: as LGA, with the picture beside the goal mask, each through a tower of its own (paper, section 5, ablation),
// or both through one.
#include <memory>

#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using lgabench::Samples;
using lgabench::SampleShape;

// Shows a learner all pictures as one: the channels of the first, then those of the next.
class Fused : public lgabench::Learner {
 public:
  // @pre the pictures have one size
  static SampleShape shape(SampleShape of) {
    for (; of.pictures.size() > 1; of.pictures.pop_back()) of.pictures.front().channels += of.pictures.back().channels;
    return of;
  }
  explicit Fused(std::unique_ptr<Learner> inner) : inner_(std::move(inner)) {}

  lgabench::TrainingOptions schedule(const lgabench::TrainingOptions& asked, int samples) const override {
    return inner_->schedule(asked, samples);
  }
  void begin(const Samples& samples) override {
    shown_ = std::make_unique<Samples>(fused(samples));
    inner_->begin(*shown_);
  }
  const std::vector<float>& predict(const Samples& samples) override { return inner_->predict(fused(samples)); }
  std::vector<float> features(const Samples& samples) override { return inner_->features(fused(samples)); }
  double backward(const Samples&, const std::vector<int>& batch) override { return inner_->backward(*shown_, batch); }
  void update(double rate) override { inner_->update(rate); }
  std::vector<float> parameters() const override { return inner_->parameters(); }
  bool learned(lgabench::Archive& archive) override { return inner_->learned(archive); }

 private:
  static Samples fused(const Samples& samples) {
    Samples one(shape(samples.shape), samples.rows);
    one.unaltered = samples.unaltered;
    one.labels = samples.labels;
    one.state = samples.state;
    if (samples.stops) one.stops = std::make_shared<Samples>(fused(*samples.stops));
    const auto all = static_cast<std::size_t>(one.shape.pictures.front().channels);
    std::size_t channel = 0;
    for (std::size_t i = 0; i < samples.pictures.size(); ++i)
      for (int c = 0; c < samples.shape.pictures[i].channels; ++c, ++channel) {
        const auto step = static_cast<std::size_t>(samples.shape.pictures[i].channels);
        for (std::size_t pixel = 0; pixel * step < samples.pictures[i].size(); ++pixel)
          one.pictures.front()[pixel * all + channel] = samples.pictures[i][pixel * step + static_cast<std::size_t>(c)];
      }
    return one;
  }

  std::unique_ptr<Learner> inner_;
  std::unique_ptr<Samples> shown_;
};

}  // namespace

class LgaS : public lgabench::CloningMethod {
 public:
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    return lgabench::select_as_asked(command, space, services);
  }

 protected:
  lgabench::PolicyInputs inputs(const lgabench::Json&) const override {
    using Picture = lgabench::PolicyInputs::Picture;
    return {{Picture::mask, Picture::rgb}};
  }
  std::unique_ptr<lgabench::Learner> learner(const SampleShape& shape,
                                             const lgabench::Services& services) const override {
    if (services.options.value("fusion", "late") == "late") return CloningMethod::learner(shape, services);
    return std::make_unique<Fused>(CloningMethod::learner(Fused::shape(shape), services));
  }
};

LGABENCH_METHOD("lga_s", "0.1", "Behaviour cloning on a language model's goal mask and the picture", LgaS,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_MASK_OPTIONS R"(,
  "fusion": {"added": true, "default": "late", "values": ["late", "early"],
             "help": "mask and picture each through a tower of its own, or as channels of one picture, as heat_map has them in any case",
             "needs": {"early": {"policy": ["regression"]}}, "source": "late: paper, section 5; early: ours"}})")
