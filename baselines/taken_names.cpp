// No command is read: likeness is a count, and what the names mean to a sentence encoder. A command whose members have
// something in common that names say ("stripe", "letter") is guessed from one demonstration. The reference row
// most_alike_names, as a mask under a policy.
#include <memory>

#include <lgabench/learning/sentence_embeddings.hpp>
#include <lgabench/plugin/plugin.hpp>

#include "of_taken.hpp"

using namespace lgabench;

class TakenNames : public OfTaken {
 public:
  TakenNames() : OfTaken(by_name()) {}

 private:
  static Score by_name() {
    const auto embeddings = std::make_shared<SentenceEmbeddings>();
    const EmbeddingOf embedding = [embeddings](const std::string& name) -> const std::vector<float>& {
      return embeddings->of(name);
    };
    return [embedding](const Instance& one, const TakenLooks& taken) { return alike_in_name(one, taken, embedding); };
  }
};

LGABENCH_METHOD("taken_names", "0.1",
                "Behaviour cloning on a mask of what is likest in name to what was taken, the command unread",
                TakenNames, "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
