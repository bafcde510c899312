#include <lgabench/record/shown.hpp>

#include <limits>

#include <lgabench/core/files.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {

std::string to_text(const std::vector<ShownScene>& scenes) {
  Json all = Json::array();
  for (const auto& [arm, index, pictures, texts, unread] : scenes) {
    Json drawn = Json::array();
    for (const auto& [caption, png] : pictures) drawn.push_back({{"caption", caption}, {"png", png}});
    all.push_back({{"arm", arm}, {"index", index}, {"pictures", drawn}, {"texts", texts}, {"unread", unread}});
  }
  return canonical({{"scenes", all}}) + '\n';
}

std::vector<ShownScene> read_shown_scenes(const fs::path& cell) {
  const fs::path file = cell / cell_file::shown;
  std::vector<ShownScene> scenes;
  if (std::error_code not_there; !fs::exists(fs::symlink_status(file, not_there))) return scenes;
  const Json json = read_json(file, Links::refused);
  for (const JsonReader& one : JsonReader(json, file.string()).at("scenes").elements()) {
    ShownScene& scene = scenes.emplace_back();
    scene.arm = one.at("arm").string();
    scene.index = static_cast<int>(one.at("index").integer(0, std::numeric_limits<int>::max()));
    for (const JsonReader& picture : one.at("pictures").elements()) {
      const std::string png = picture.at("png").string();
      if (png.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=") != png.npos)
        picture.at("png").fail("a PNG in base64");
      scene.pictures.emplace_back(picture.at("caption").string(), png);
    }
    scene.texts = one.at("texts").strings();
    scene.unread = one.at("unread").strings();
  }
  return scenes;
}

}  // namespace lgabench
