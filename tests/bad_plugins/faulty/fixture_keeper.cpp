// A method that keeps what it is told when its failures are attributed, and goes by that in the cells that follow.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "../fixture.hpp"

namespace {

using namespace lgabench;

// Of the plugin's own folder and file, and of where anybody may write: a number that outlives the process.
class Memory {
 public:
  Memory(std::string folder, std::string file) : folder_(std::move(folder)), file_(std::move(file)) {}

  void keep(int number) const {
    const std::string text = std::to_string(number);
    ::setxattr(folder_.c_str(), name, text.data(), text.size(), 0);
    const timespec times[2] = {{0, UTIME_OMIT}, {beginning + number, 0}};
    ::utimensat(AT_FDCWD, file_.c_str(), times, 0);
    for (const std::string& place : {folder_ + "/kept", std::string("/tmp/lgabench-kept")})
      std::ofstream(place) << text;
  }
  /// 0: nothing was kept.
  int kept() const {
    char text[16] = {};
    if (::getxattr(folder_.c_str(), name, text, sizeof text - 1) > 0) return std::atoi(text);
    struct stat about {};
    if (::stat(file_.c_str(), &about) == 0 && about.st_mtime < beginning + 10000)
      return static_cast<int>(about.st_mtime - beginning);
    int number = 0;
    for (const std::string& place : {folder_ + "/kept", std::string("/tmp/lgabench-kept")})
      if (std::ifstream(place) >> number) return number;
    return 0;
  }

 private:
  static constexpr const char* name = "user.kept";
  static constexpr time_t beginning = 1'000'000'000;
  std::string folder_, file_;
};

int place_in(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

// Fails, so that it is told why.
class Keeper : public Policy {
 public:
  Keeper(FeatureSpace space, Selection own, const Memory* memory)
      : space_(std::move(space)), own_(std::move(own)), memory_(memory) {}
  Action act(const Observation&, const Instruction& told) override {
    const FeatureSet& target = told.selection.target.product();
    const double x = memory_ && memory_->kept() > 0 ? .4 : .5;
    if (memory_ && !(target == own_.target.product()) && !target.object_types.empty())
      memory_->keep(1 + place_in(space_.object_types, target.object_types.front()));
    return fixture::from_to(x, 0, x, 0);
  }

 private:
  FeatureSpace space_;
  Selection own_;
  const Memory* memory_;
};

class KeepingMethod : public Method {
 public:
  Needs needs(const Json&) const override {
    Needs needs;
    needs.targets = Needs::Targets::truth;
    return needs;
  }
  Selection select(const Command&, const FeatureSpace& space, Services& services) override {
    keeps_ = services.options.at("keep") == "yes";
    memory_ =
        Memory(services.options.at("folder"), services.options.at("folder").get<std::string>() + "/fixture_keeper.so");
    space_ = space;
    const int kept = keeps_ ? memory_.kept() : 0;
    const std::size_t last = space.object_types.size() - 1;
    selection_ = {};
    selection_.target.product().object_types = {
        space.object_types[kept > 0 ? static_cast<std::size_t>(kept - 1) : last]};
    selection_.target.product().textures = space.textures;
    selection_.provenance = Provenance::rule;
    return selection_;
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>&, Services& services) override {
    services.log.epoch(1, 1, 0.0);
    return std::make_unique<Keeper>(space_, selection_, keeps_ ? &memory_ : nullptr);
  }

 private:
  bool keeps_ = false;
  Memory memory_{"", ""};
  FeatureSpace space_;
  Selection selection_;
};

constexpr char options[] = R"({
  "keep": {"default": "no", "help": "whether it does", "values": ["no", "yes"], "source": "test fixture"},
  "folder": {"default": "", "help": "the plugin's own", "source": "test fixture"}
})";

}  // namespace

LGABENCH_METHOD("fixture_keeper", "0.1", "keeps the truth that it is told", KeepingMethod, options)
