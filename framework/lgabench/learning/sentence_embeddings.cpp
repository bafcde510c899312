#include <lgabench/learning/sentence_embeddings.hpp>

#include <fmt/format.h>

#include <boost/dll/import.hpp>
#include <boost/dll/runtime_symbol_info.hpp>

#include <lgabench/abstraction/committed_embeddings.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/learning/sentence_encoder.hpp>

namespace lgabench {
namespace {

decltype(&make_sentence_encoder) load_encoder() {
#if defined(LGABENCH_ENCODER_LIBRARY)
  // Never unloaded, since LibTorch in a process cannot be. By its path: AddressSanitizer calls dlopen in this library's
  // stead, and then this library's run path does not count.
  static const auto& library = *new boost::dll::shared_library(
      boost::dll::this_line_location().parent_path() / LGABENCH_ENCODER_LIBRARY, boost::dll::load_mode::rtld_local);
  return library.get_alias<decltype(make_sentence_encoder)>("sentence_encoder");
#else
  throw InputError("the sentence encoder needs LibTorch, which this lgabench was built without (LGABENCH_TORCH=OFF)");
#endif
}

}  // namespace

SentenceEmbeddings::SentenceEmbeddings() : embeddings_(committed_embeddings()) {}

const std::vector<float>& SentenceEmbeddings::of(const std::string& sentence) {
  const auto found = embeddings_.find(sentence);
  if (found != embeddings_.end()) return found->second;
  if (!encode_) {
    const fs::path directory = encoder_directory();
    if (!has_encoder_library() || !fs::exists(directory / "model.safetensors"))
      throw InputError(
          fmt::format("\"{}\": expected a sentence with a committed embedding, or the sentence encoder in {}; {}, "
                      "$LGABENCH_ENCODER names another directory",
                      sentence, directory.string(), encoder_remedy()));
    encode_ = load_encoder()(directory);
  }
  return embeddings_.emplace(sentence, encode_(sentence)).first->second;
}

}  // namespace lgabench
