// A perturbation whose levels behave, each in its way: level 1 as it should.
#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

// Each row brighter by what is drawn for it.
void brighten(Observation& seen, RandomStream& stream) {
  const std::size_t row = 3 * static_cast<std::size_t>(seen.size.columns);
  for (std::size_t begin = 0; begin < seen.rgb.size(); begin += row) {
    const int more = 1 + static_cast<int>(30 * stream.uniform());
    for (std::size_t i = begin; i < begin + row; ++i)
      seen.rgb[i] = static_cast<std::uint8_t>(std::min(255, seen.rgb[i] + more));
  }
}

std::string opened(const std::string& path) {
  return ::open(path.c_str(), O_RDONLY) >= 0 ? "reached" : ::strerrorname_np(errno);
}

class Axis : public ObservationPerturbation {
 public:
  Observation perceive(Observation seen, int level, RandomStream stream) override {
    enum { good = 1, dead, leaking, throwing, crashing, hanging, wrong_size, unknown_id, unknown_name, reading };
    if (level == dead) return seen;
    if (level == throwing) throw std::runtime_error("its own failure");
    if (level == crashing) std::raise(SIGSEGV);
    for (; level == hanging;) ::pause();
    if (level == reading)
      throw std::runtime_error(
          "scenario: " + opened(std::getenv("LGABENCH_DATA") + std::string("/scenarios/heart.json")) +
          ", the method's directory: " + opened("../method"));
    brighten(seen, stream);
    if (level == leaking) *std::find_if(seen.ids.begin(), seen.ids.end(), [](int id) { return id != 0; }) = 0;
    if (level == wrong_size) seen.rgb.resize(3);
    if (level == unknown_id) seen.ids[0] = 200;
    if (level == unknown_name) seen.instances[0].texture = "of glass";
    return seen;
  }
};

}  // namespace

LGABENCH_PERTURBATION("fixture_axis", "0.1", "Behaves at each level in its way", Axis, R"({
  "levels": ["as it should", "dead", "leaking", "throwing", "crashing", "hanging", "wrong size", "unknown id",
             "unknown name", "reading"],
  "changes": ["rgb"], "named": true})")
