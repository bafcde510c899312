// BERT's uncased tokenizer: words, and the pieces of words that a vocabulary holds.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

namespace lgabench {

/// A value; immutable after construction.
class WordPieces {
 public:
  /// `vocabulary`: a token a line, its number the line's, from 0; a piece inside a word begins with "##".
  /// @throws InputError with the file where it cannot be read or lacks [CLS], [SEP] or [UNK].
  explicit WordPieces(const std::filesystem::path& vocabulary);

  /// Numbers of [CLS], the text's pieces and [SEP], at most `most` in all: what is too long loses its end.
  /// Lower case, accents dropped, control characters too; punctuation and Chinese characters stand alone; a word of
  /// over 100 characters, or with a piece that the vocabulary lacks, is [UNK]. The names of special tokens mean nothing
  /// in a text. @throws InputError for text that is not UTF-8.
  std::vector<std::int64_t> ids(const std::string& text, std::size_t most) const;

 private:
  std::int64_t special(const std::string& token) const;
  void add_word(const std::u32string& word, std::vector<std::int64_t>& ids) const;

  std::filesystem::path file_;
  std::unordered_map<std::string, std::int64_t> numbers_;
  std::int64_t begin_, end_, unknown_;
};

}  // namespace lgabench
