// all-MiniLM-L6-v2: a sentence as a vector (Reimers and Gurevych 2019; Wang et al. 2020). In a library of its own,
// since LibTorch takes longer to load than most cells take to evaluate.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lgabench {

/// BERT with 6 layers of width 384 and 12 heads, post-norm, exact GELU; mean over tokens, unit norm. One thread.
class SentenceEncoder {
 public:
  /// Computes on one processor; flushes subnormal numbers in this thread. Reads model.safetensors and vocab.txt.
  /// @throws InputError naming the file that is missing or not as expected: the weights are those of one published
  /// file, known by its SHA-256.
  explicit SentenceEncoder(const std::filesystem::path& directory);
  ~SentenceEncoder();

  /// 384 numbers of norm 1; at most 256 tokens of the sentence count. @throws InputError for text that is not UTF-8.
  std::vector<float> encode(const std::string& sentence) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

using Encode = std::function<std::vector<float>(const std::string&)>;
/// What the library exports, by the name of sentence_encoder: encode() of an encoder that it keeps.
Encode make_sentence_encoder(const std::filesystem::path& directory);

}  // namespace lgabench
