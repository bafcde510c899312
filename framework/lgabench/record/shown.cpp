#include <lgabench/record/shown.hpp>

#include <lgabench/core/fields.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {

static void fields(std::pair<std::string, std::string>& picture, Fields& field) {
  auto& [caption, png] = picture;
  field("png", png);
  if (field.reading() &&
      png.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=") != png.npos)
    field.reading()->at("png").fail("a PNG in base64");
  field("caption", caption);
}

void fields(ShownScene& scene, Fields& field) {
  field("arm", scene.arm);
  field("index", scene.index);
  field("pictures", scene.pictures);
  field("texts", scene.texts);
  field("unread", scene.unread);
}

std::string to_text(const std::vector<ShownScene>& scenes) { return canonical({{"scenes", json_of(scenes)}}) + '\n'; }

std::vector<ShownScene> read_shown_scenes(const fs::path& cell) {
  const fs::path file = cell / cell_file::shown;
  if (std::error_code not_there; !fs::exists(fs::symlink_status(file, not_there))) return {};
  const Json json = read_json(file, Links::refused);
  return value_of<std::vector<ShownScene>>(JsonReader(json, file.string()).at("scenes"), false);
}

}  // namespace lgabench
