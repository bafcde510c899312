#include <readers/forest.hpp>

#include <cstring>
#include <utility>

#include <lgabench/core/error.hpp>

namespace lgabench::seeing {
namespace {

static_assert(sizeof(Forest::Node) == 8 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "a file has the memory's bytes");

template <class T>
void put(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}
void put_count(std::string& bytes, std::size_t count) {
  const auto number = static_cast<std::uint32_t>(count);
  put(bytes, &number, 1);
}

template <class T>
void take(std::string_view& bytes, T* values, std::size_t count) {
  if (bytes.size() / sizeof(T) < count) throw InputError("forest: it is cut off");
  if (count > 0) std::memcpy(values, bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
}
// A count of what takes so many bytes each.
std::size_t take_count(std::string_view& bytes, std::size_t each) {
  std::uint32_t count = 0;
  take(bytes, &count, 1);
  if (count > bytes.size() / each) throw InputError("forest: it is cut off");
  return count;
}

}  // namespace

Forest::Forest(std::vector<std::string> classes, std::size_t features, std::vector<Tree> trees)
    : classes_(std::move(classes)), features_(features), trees_(std::move(trees)) {
  for (const Tree& tree : trees_) {
    if (tree.empty()) throw InputError("forest: a tree without nodes");
    for (std::size_t i = 0; i < tree.size(); ++i) {  // ways lead on alone: every one ends
      const Node& node = tree[i];
      const bool good = node.feature == leaf
                            ? node.other < classes_.size()
                            : node.feature < features_ && node.other > i + 1 && node.other < tree.size();
      if (!good) throw InputError("forest: a node points outside its tree");
    }
  }
}

std::vector<int> Forest::votes(const std::vector<float>& row) const {
  if (row.size() != features_) throw InputError("forest: a row with another number of features");
  std::vector<int> votes(classes_.size());
  for (const Tree& tree : trees_) {
    std::size_t at = 0;
    while (tree[at].feature != leaf) at = row[tree[at].feature] <= tree[at].threshold ? at + 1 : tree[at].other;
    ++votes[tree[at].other];
  }
  return votes;
}

void Forest::save(std::string& bytes) const {
  put_count(bytes, classes_.size());
  for (const std::string& name : classes_) {
    put_count(bytes, name.size());
    bytes += name;
  }
  put_count(bytes, features_);
  put_count(bytes, trees_.size());
  for (const Tree& tree : trees_) {
    put_count(bytes, tree.size());
    put(bytes, tree.data(), tree.size());
  }
}

Forest Forest::load(std::string_view& bytes) {
  std::vector<std::string> classes(take_count(bytes, sizeof(std::uint32_t)));
  for (std::string& name : classes) {
    name.resize(take_count(bytes, 1));
    take(bytes, name.data(), name.size());
  }
  const std::size_t features = take_count(bytes, 1);
  std::vector<Tree> trees(take_count(bytes, sizeof(std::uint32_t)));
  for (Tree& tree : trees) {
    tree.resize(take_count(bytes, sizeof(Node)));
    take(bytes, tree.data(), tree.size());
  }
  return {std::move(classes), features, std::move(trees)};
}

}  // namespace lgabench::seeing
