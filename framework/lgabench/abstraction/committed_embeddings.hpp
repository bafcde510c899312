// Sentence embeddings of what is shipped, commands and names, computed once with all-MiniLM-L6-v2.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace lgabench {

inline constexpr std::size_t embedding_size = 384;

/// Of every file of the data directory's embeddings/, by sentence: vectors of norm 1. @throws InputError naming the
/// file and the place.
std::map<std::string, std::vector<float>> committed_embeddings();

}  // namespace lgabench
