// Sentences as vectors: embeddings of the shipped commands, computed once with all-MiniLM-L6-v2.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace lgabench {

/// A value; immutable after construction.
class SentenceEmbeddings {
 public:
  /// Reads every file of the data directory's embeddings/. @throws InputError naming the file and the place.
  SentenceEmbeddings();

  /// 384 numbers of norm 1. @throws InputError for a sentence without an embedding: says how to make it.
  const std::vector<float>& of(const std::string& sentence) const;

 private:
  std::map<std::string, std::vector<float>> embeddings_;
};

}  // namespace lgabench
