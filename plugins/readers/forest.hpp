// A forest of decision trees (Breiman, Machine Learning 2001). OpenCV grew it (grow.hpp), and it is kept as numbers: no
// version of OpenCV has to read it, and every one reads the same from it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lgabench::seeing {

class Forest {
 public:
  /// Inner: to the next node if the feature is at most the threshold, else to the tree's node number `other`. A leaf's
  /// feature is `leaf`, its `other` the class.
  struct Node {
    std::uint16_t feature, other;
    float threshold;
  };
  static constexpr std::uint16_t leaf = 0xffff;
  using Tree = std::vector<Node>;

  Forest() = default;
  /// @throws InputError where a node leads backwards or nowhere, or names no feature or class.
  Forest(std::vector<std::string> classes, std::size_t features, std::vector<Tree> trees);

  const std::vector<std::string>& classes() const { return classes_; }
  /// How many trees say each class. @throws InputError for a row of another length than the examples'.
  std::vector<int> votes(const std::vector<float>& row) const;

  /// Bytes, the same on every machine.
  void save(std::string& bytes) const;
  /// Reads what save() wrote from the front of `bytes`, and takes it away. @throws InputError for other bytes.
  static Forest load(std::string_view& bytes);

 private:
  std::vector<std::string> classes_;
  std::size_t features_ = 0;
  std::vector<Tree> trees_;
};

}  // namespace lgabench::seeing
