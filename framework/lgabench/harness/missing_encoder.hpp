// What a command of one's own needs where a policy reads it: the sentence encoder's weights.
#pragma once
#include <string>
#include <vector>

namespace lgabench {

/// One line for the user about the first of those commands whose embedding is not committed, if the sentence encoder's
/// weights are not there to compute it; "" if nothing is missing. Reads the committed embeddings in that case alone.
std::string missing_encoder(const std::vector<std::string>& commands);

}  // namespace lgabench
