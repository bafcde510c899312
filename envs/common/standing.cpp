// What stands in life and lies on the tabletop, upright: for views from the side.
#include <common/shapes.hpp>

namespace lgabench::common {
namespace {

Drawing standing_soda_can() {
  Drawing drawing;
  add_solid(drawing, disc(.033), {{0, .008}, {.008, 0}, {.108, 0}, {.118, .008}});
  add_solid(drawing, disc(.0265), {{.116, 0}, {.122, 0}});
  return drawing;
}

Drawing standing_water_bottle() {
  Drawing drawing;
  add_solid(drawing, disc(.034),
            {{0, .004}, {.006, 0}, {.062, 0}, {.068, .004}, {.078, .004}, {.084, 0}, {.12, 0}, {.16, .02}});
  add_solid(drawing, disc(.014), {{.16, 0}, {.168, 0}});
  add_solid(drawing, disc(.0165), {{.168, 0}, {.188, 0}});
  return drawing;
}

Drawing standing_juice_box() {
  Drawing drawing{{}, {}, {-.008, 0}};
  add_solid(drawing, rectangle(-.034, -.024, .034, .024), {{0, 0}, {.104, 0}, {.108, .004}});
  // A straw with a bend, whose end reaches .004 beyond the outline.
  const Polygon foot = rectangle(.014, -.004, .022, .004), bend = rectangle(.018, -.004, .026, .004),
                end = rectangle(.03, -.004, .038, .004);
  drawing.parts.push_back({foot, bend, .106, .135});
  drawing.parts.push_back({bend, end, .135, .147});
  return drawing;
}

}  // namespace

const std::vector<Shape>& standing_shapes() {
  static const std::vector<Shape> all{
      {"soda can", standing_soda_can}, {"water bottle", standing_water_bottle}, {"juice box", standing_juice_box}};
  return all;
}

}  // namespace lgabench::common
