// What the library shows of itself (abstraction/reading.hpp).
#include <array>
#include <utility>

#include <lgabench/abstraction/reading.hpp>
#include <lgabench/core/files.hpp>
#include <readers/reader.hpp>

namespace lgabench::seeing {
namespace {

class ShippedReader final : public Perceiver {
 public:
  ShippedReader(const fs::path& file, bool balances, const Observation& empty, const FeatureSpace& space)
      : reader_(Model::of(read_file(file)), space), balances_(balances), usual_(colour_of_table(empty)) {}

  Observation read(Observation seen, const FeatureSpace& /*its own*/) override {
    seen.instances = reader_.names(balances_ ? balanced(seen, usual_) : seen);
    return seen;
  }

 private:
  Reader reader_;
  bool balances_;
  std::array<double, 3> usual_;  // the empty place's colour
};

}  // namespace
}  // namespace lgabench::seeing

const lgabench::SeeingLibrary* lgabench_seeing() {
  using namespace lgabench::seeing;
  static const lgabench::SeeingLibrary library{
      segments_by_difference,
      [](const std::filesystem::path& file, bool balances, const lgabench::Observation& empty,
         const lgabench::FeatureSpace& space) -> std::unique_ptr<lgabench::Perceiver> {
        return std::make_unique<ShippedReader>(file, balances, empty, space);
      },
      marked};
  return &library;
}
