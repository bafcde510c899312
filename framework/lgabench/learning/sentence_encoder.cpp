#include <lgabench/learning/sentence_encoder.hpp>

#include <ATen/ATen.h>
#include <ATen/Parallel.h>
#include <c10/core/GradMode.h>
#include <fmt/format.h>

#include <cmath>

#include <boost/dll/alias.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/learning/safetensors.hpp>
#include <lgabench/learning/word_pieces.hpp>

// OpenBLAS, where ATen uses it, has a pool of threads that does not heed at::set_num_threads.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace lgabench {
namespace {

using at::Tensor;

constexpr std::int64_t width = 384, heads = 12, inner = 1536, layers = 6, words = 30522, positions = 512;
constexpr std::size_t most_tokens = 256;
constexpr double epsilon = 1e-12;
constexpr const char* weights_sha256 = "53aa51172d142c89d9012cce15ae4d6cc0ca6895895114379cacb4fab128d9db";

}  // namespace

struct SentenceEncoder::Impl {
  WordPieces tokenizer;
  Safetensors weights;

  Tensor get(const std::string& name, const std::vector<std::int64_t>& shape) const {
    return at::from_blob(const_cast<float*>(weights.get(name, shape)), shape, at::kFloat);
  }
  Tensor linear(const std::string& name, const Tensor& x, std::int64_t out) const {
    return at::linear(x, get(name + ".weight", {out, x.size(-1)}), get(name + ".bias", {out}));
  }
  Tensor normalised(const std::string& name, const Tensor& x) const {
    return at::layer_norm(x, {width}, get(name + ".weight", {width}), get(name + ".bias", {width}), epsilon);
  }

  Tensor attention(const std::string& name, const Tensor& x) const {
    const std::int64_t tokens = x.size(0);
    const auto part = [&](const char* which) {  // heads x tokens x width of a head
      return linear(name + ".self." + which, x, width).view({tokens, heads, width / heads}).transpose(0, 1);
    };
    const Tensor scores = at::matmul(part("query"), part("key").transpose(1, 2)) / std::sqrt(double{width} / heads);
    const Tensor mixed = at::matmul(at::softmax(scores, -1), part("value")).transpose(0, 1).reshape({tokens, width});
    return normalised(name + ".output.LayerNorm", x + linear(name + ".output.dense", mixed, width));
  }

  Tensor embed(std::vector<std::int64_t> ids) const {
    const auto tokens = static_cast<std::int64_t>(ids.size());
    Tensor x = get("embeddings.word_embeddings.weight", {words, width})
                   .index_select(0, at::from_blob(ids.data(), {tokens}, at::kLong));
    x = x + get("embeddings.position_embeddings.weight", {positions, width}).narrow(0, 0, tokens);
    x = normalised("embeddings.LayerNorm", x + get("embeddings.token_type_embeddings.weight", {2, width})[0]);
    for (std::int64_t i = 0; i < layers; ++i) {
      const std::string layer = fmt::format("encoder.layer.{}", i);
      x = attention(layer + ".attention", x);
      const Tensor hidden = at::gelu(linear(layer + ".intermediate.dense", x, inner));
      x = normalised(layer + ".output.LayerNorm", x + linear(layer + ".output.dense", hidden, width));
    }
    const Tensor mean = x.mean(0);
    return mean / mean.norm();
  }
};

SentenceEncoder::SentenceEncoder(const fs::path& directory)
    : impl_(
          new Impl{WordPieces(directory / "vocab.txt"), Safetensors(directory / "model.safetensors", weights_sha256)}) {
  at::set_num_threads(1);
  if (openblas_set_num_threads) openblas_set_num_threads(1);
  flush_denormals();
}

SentenceEncoder::~SentenceEncoder() = default;

std::vector<float> SentenceEncoder::encode(const std::string& sentence) const {
  const c10::NoGradGuard no_grad;
  const Tensor embedding = impl_->embed(impl_->tokenizer.ids(sentence, most_tokens)).contiguous();
  const float* values = embedding.data_ptr<float>();
  return {values, values + embedding.numel()};
}

Encode make_sentence_encoder(const fs::path& directory) {
  return [encoder = std::make_shared<SentenceEncoder>(directory)](const std::string& sentence) {
    return encoder->encode(sentence);
  };
}
BOOST_DLL_ALIAS(lgabench::make_sentence_encoder, sentence_encoder)

}  // namespace lgabench
