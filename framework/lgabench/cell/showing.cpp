#include <lgabench/cell/showing.hpp>

#include <fmt/format.h>

#include <lgabench/cell/picture.hpp>
#include <lgabench/core/base64.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

std::string png(const ShownPicture& shown) {
  const int step = page_step(shown.size), columns = shown.size.columns / step, rows = shown.size.rows / step;
  Picture picture(columns, rows);
  picture.paste(0, 0, columns, rows, 1, [&](int column, int row) {
    const auto at = static_cast<std::size_t>(3 * step * (row * shown.size.columns + column));
    return Rgb{shown.rgb[at], shown.rgb[at + 1], shown.rgb[at + 2]};
  });
  return base64(picture.png());
}

}  // namespace

void Showing::played(const TestScene& test) {
  if (test.abstraction_empty || test.scene.index >= most_shown_scenes) return;
  try {
    const Shown shown = guarded(id_, [&] { return policy_.shown(); });
    if (shown.empty()) return;
    expect_shown(shown);
    ShownScene scene{test.scene.arm, test.scene.index, {}, shown.texts, shown.unread};
    for (const ShownPicture& one : shown.pictures)
      scene.pictures.emplace_back(fmt::format("{}, {} × {}{}{}", one.name, one.size.rows, one.size.columns,
                                              one.note.empty() ? "" : "; ", one.note),
                                  png(one));
    scenes_.push_back(std::move(scene));
  } catch (const MethodError& e) {
    to_stderr("the policy's input in scene {} of {} is not shown: {}\n", test.scene.index, test.scene.arm, e.what());
  }
}

}  // namespace lgabench
