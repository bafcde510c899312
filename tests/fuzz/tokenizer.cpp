// A tokenizer's vocabulary, and after an empty line texts to embed.
#include <cstdlib>

#include <lgabench/core/error.hpp>
#include <lgabench/learning/word_pieces.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  constexpr std::size_t most = 16;
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t end = text.find("\n\n");
  const std::string_view vocabulary = text.substr(0, end);
  const std::size_t words = fuzz::split(vocabulary, "\n").size();
  try {
    const WordPieces tokenizer(fuzz::write(fuzz::directory() / "vocab.txt", vocabulary));
    const std::vector<std::int64_t> ids = tokenizer.ids(std::string(text.substr(std::min(end, text.size()))), most);
    if (ids.size() < 2 || ids.size() > most) std::abort();
    for (const std::int64_t id : ids)
      if (id < 0 || static_cast<std::size_t>(id) >= words) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
