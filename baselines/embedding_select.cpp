// LGA without a language model: a feature matters if its name lies near the command among sentence embeddings (Reimers
// and Gurevych 2019, all-MiniLM-L6-v2). After OTTER (ICML 2025, arXiv 2503.03734), which keeps what CLIP aligns with
// the text: names in place of patches of a picture.
#include <algorithm>
#include <numeric>

#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/learning/sentence_embeddings.hpp>
#include <lgabench/plugin/plugin.hpp>

using namespace lgabench;

class EmbeddingSelect : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    Selection selection;
    selection.target = {near(command.utterance, space.object_types, services.options),
                        near(command.utterance, space.textures, services.options)};
    if (command.second)  // an embedding of the whole command does not tell the two sets apart
      selection.second = {selection.target.product(), command.second->id};
    return selection;
  }

 private:
  // All names where none is near enough to tell.
  std::vector<std::string> near(const std::string& utterance, const std::vector<std::string>& names,
                                const Json& options) {
    const std::vector<float>& words = embeddings_.of(utterance);
    std::vector<double> similarities;
    for (const std::string& name : names) {
      const std::vector<float>& other = embeddings_.of(name);
      similarities.push_back(std::inner_product(words.begin(), words.end(), other.begin(), 0.));
    }
    const double best = *std::max_element(similarities.begin(), similarities.end());
    if (best < options.at("floor").get<double>()) return names;
    std::vector<std::string> found;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (similarities[i] >= best - options.at("margin").get<double>()) found.push_back(names[i]);
    return found;
  }

  SentenceEmbeddings embeddings_;
};

LGABENCH_METHOD("embedding_select", "0.1",
                "Behaviour cloning on a goal mask of what a sentence embedding finds near the command", EmbeddingSelect,
                "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS R"(,
  "floor": {"default": 0.4, "min": -1, "max": 1, "help": "cosine similarity to the command below which no name tells anything: all are kept", "source": "chosen once, on the commands of q3"},
  "margin": {"default": 0.15, "min": 0, "max": 2, "help": "names this much less similar than the best are kept too", "source": "chosen once, on the commands of q3"}})")
