#include <readers/grow.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

#include <lgabench/core/error.hpp>

#include <opencv2/core.hpp>
#include <opencv2/ml.hpp>

namespace lgabench::seeing {

Forest grown(const Examples& examples, const std::vector<std::string>& classes, ForestSize size, std::uint64_t seed) {
  const int rows = static_cast<int>(examples.rows.size()), columns = static_cast<int>(examples.rows.at(0).size());
  cv::Mat samples(rows, columns, CV_32F), answers(rows, 1, CV_32S);
  for (int i = 0; i < rows; ++i) {
    const auto& row = examples.rows[static_cast<std::size_t>(i)];
    std::copy(row.begin(), row.end(), samples.ptr<float>(i));
    answers.at<int>(i) = examples.classes[static_cast<std::size_t>(i)];
  }
  constexpr int deepest = 25;  // the most that it allows
  const auto forest = cv::ml::RTrees::create();
  forest->setMaxDepth(deepest);
  forest->setMinSampleCount(2);
  forest->setActiveVarCount(size.tried);
  forest->setTermCriteria({cv::TermCriteria::MAX_ITER, size.trees, 0});
  cv::setNumThreads(0);
  cv::theRNG().state = seed;
  forest->train(cv::ml::TrainData::create(samples, cv::ml::ROW_SAMPLE, answers));

  std::vector<Forest::Tree> trees;
  for (const int root : forest->getRoots()) {
    Forest::Tree tree;
    const std::function<void(int)> copy = [&](int at) {
      const cv::ml::DTrees::Node& node = forest->getNodes()[static_cast<std::size_t>(at)];
      const std::size_t here = tree.size();
      if (here >= Forest::leaf) throw InputError("forest: a tree has too many nodes");
      if (node.split < 0) {
        tree.push_back({Forest::leaf, static_cast<std::uint16_t>(std::lround(node.value)), 0});
        return;
      }
      const cv::ml::DTrees::Split& split = forest->getSplits()[static_cast<std::size_t>(node.split)];
      tree.push_back({static_cast<std::uint16_t>(split.varIdx), 0, split.c});
      copy(split.inversed ? node.right : node.left);
      tree[here].other = static_cast<std::uint16_t>(tree.size());
      copy(split.inversed ? node.left : node.right);
    };
    copy(root);
    trees.push_back(std::move(tree));
  }
  return {classes, static_cast<std::size_t>(columns), std::move(trees)};
}

}  // namespace lgabench::seeing
