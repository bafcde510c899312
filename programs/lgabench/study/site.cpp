// What the pages are made of: installed files, and pictures that lgabench-worker draws.
#include <fmt/format.h>
#include <sys/wait.h>

#include <lgabench/core/process.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/study/server.hpp>

namespace lgabench::study {
namespace {

PictureSheet drawn(const std::string& gallery, const fs::path& scratch) {
  const fs::path png = scratch / "sheet.png", cells = scratch / "cells.json";
  const int status = wait_for(start_process({{(program_directory() / "lgabench-worker").string(), "render", "--gallery",
                                              gallery, "--out", png.string(), "--cells", cells.string()},
                                             environment_with({})}));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw InputError("the study's pictures could not be drawn");
  return {read_file(png), read_json(cells)};
}

PictureSheet drawn_pairs(const Protocol& protocol, const fs::path& scratch) {
  if (!protocol.of_pairs()) return {};
  Json pairs = Json::array();
  const auto add = [&pairs](const Item& item) {
    for (const AskedPair& pair : item.pairs)
      pairs.push_back({{"scenario", item.scenario}, {"object_type", pair.object_type}, {"texture", pair.texture}});
  };
  add(protocol.practice);
  for (const Item& item : protocol.sets[0]) add(item);
  write_file(scratch / "pairs.json", pairs.dump());
  return drawn((scratch / "pairs.json").string(), scratch);
}

}  // namespace

Site load_site(const Protocol& protocol) {
  const fs::path installed = data_directory() / "study";
  const Scratch scratch("study");
  return {read_file(installed / "study.html"), read_file(installed / "study.css"), read_file(installed / "study.js"),
          drawn("objects", scratch.path),      drawn("textures", scratch.path),    drawn_pairs(protocol, scratch.path)};
}

}  // namespace lgabench::study
