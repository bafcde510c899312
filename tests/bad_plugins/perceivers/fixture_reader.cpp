// A perceiver that behaves in one of several ways, which a file beside the plugin names; without one as it should: it
// names every segment alike.
#include <fcntl.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <list>
#include <set>
#include <stdexcept>
#include <string>

#include <dlfcn.h>

#include <lgabench/core/files.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

std::string way() {
  Dl_info own;
  if (::dladdr(reinterpret_cast<void*>(&way), &own) == 0) return "";
  const fs::path file = fs::path(own.dli_fname).parent_path() / "way";
  return fs::exists(file) ? read_file(file) : "";
}

class Reader : public Perceiver {
 public:
  Observation read(Observation seen, const FeatureSpace& space) override {
    const std::string how = way();
    if (!seen.instances.empty()) throw std::runtime_error("it was told the names");
    if (how == "throws") throw std::runtime_error("its own failure");
    if (how == "crashes") std::raise(SIGSEGV);
    for (; how == "hangs";) ::pause();
    for (std::list<std::string> held; how == "allocates";) held.emplace_back(std::size_t{1} << 24, 'x');
    if (how == "truth")
      throw std::runtime_error(
          std::string("scenario: ") +
          (::open((std::getenv("LGABENCH_DATA") + std::string("/scenarios/heart.json")).c_str(), O_RDONLY) >= 0
               ? "reached"
               : ::strerrorname_np(errno)));
    std::set<std::uint8_t> ids(seen.ids.begin(), seen.ids.end());
    ids.erase(0);
    for (const std::uint8_t id : ids) seen.instances.push_back({id, space.object_types[0], space.textures[0], 0});
    if (how == "changes" && ++calls_ > 3)
      seen.instances.at(0).texture = space.textures[static_cast<std::size_t>(calls_) % 7];
    if (how == "wrong size") seen.rgb.resize(3);
    if (how == "unknown id") seen.ids[0] = 200;
    if (how == "unknown name") seen.instances.at(0).texture = "of glass";
    if (how == "two names") seen.instances.push_back(seen.instances.at(0));
    return seen;
  }

 private:
  int calls_ = 0;
};

}  // namespace

LGABENCH_PERCEIVER("fixture_reader", "0.1", "Names every segment alike", Reader)
