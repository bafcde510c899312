// Sentences as vectors: committed embeddings of what is shipped, computed once with all-MiniLM-L6-v2; its encoder for
// the rest.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lgabench {

/// One thread.
class SentenceEmbeddings {
 public:
  /// Reads every file of the data directory's embeddings/. @throws InputError naming the file and the place.
  SentenceEmbeddings();

  /// 384 numbers of norm 1, valid as long as this object. A committed embedding comes first, so that weights on one
  /// machine and none on another change nothing that is shipped.
  /// @throws InputError for a sentence that needs the encoder where its weights are not: says how to get them.
  const std::vector<float>& of(const std::string& sentence);
  /// Whether it is a committed one, or was asked for before.
  bool holds(const std::string& sentence) const { return embeddings_.count(sentence) > 0; }

 private:
  std::map<std::string, std::vector<float>> embeddings_;
  std::function<std::vector<float>(const std::string&)> encode_;  // once it was needed
};

}  // namespace lgabench
