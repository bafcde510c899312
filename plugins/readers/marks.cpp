// A picture with numbers in it, for whoever is asked which of the things it shows are meant.
#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>

#include <readers/reader.hpp>

namespace lgabench::seeing {
namespace {

constexpr int zoom = 6, gap = 1, near = 5, height = 9,
              width_of_digit = 7;  // all but zoom in pixels of the small picture

// Where a label of that size hides least, then is least near to anything else, of eight places around what it belongs
// to; the first of equal ones. `taken`: segments and labels, `mask`: what it belongs to.
cv::Rect place_beside(const cv::Mat& mask, cv::Size label, const cv::Mat& taken) {
  const cv::Rect segment = cv::boundingRect(mask);
  const cv::Mat others = taken & ~mask;
  const int left = segment.x - label.width - gap, right = segment.x + segment.width + gap;
  const int above = segment.y - label.height - gap, below = segment.y + segment.height + gap;
  const int x = segment.x + (segment.width - label.width) / 2, y = segment.y + (segment.height - label.height) / 2;
  const cv::Rect all(0, 0, taken.cols, taken.rows);
  cv::Rect best;
  int least = std::numeric_limits<int>::max();
  for (const cv::Point& corner : {cv::Point(right, y),
                                  {left, y},
                                  {x, above},
                                  {x, below},
                                  {right, above},
                                  {left, above},
                                  {right, below},
                                  {left, below}}) {
    const cv::Rect place(cv::Point(std::clamp(corner.x, 0, taken.cols - label.width),
                                   std::clamp(corner.y, 0, taken.rows - label.height)),
                         label);
    const cv::Rect around(place.x - near, place.y - near, place.width + 2 * near, place.height + 2 * near);
    const int bad = all.area() * cv::countNonZero(taken(place)) + cv::countNonZero(others(around & all));
    if (bad >= least) continue;
    least = bad;
    best = place;
  }
  return best;
}

}  // namespace

Observation marked(const Observation& seen, const std::vector<std::uint8_t>& ids) {
  const int rows = seen.size.rows, columns = seen.size.columns;
  const cv::Mat small(rows, columns, CV_8UC3, const_cast<std::uint8_t*>(seen.rgb.data()));
  const cv::Mat segments(rows, columns, CV_8UC1, const_cast<std::uint8_t*>(seen.ids.data()));
  cv::Mat large, taken = segments != 0;
  cv::resize(small, large, {}, zoom, zoom, cv::INTER_CUBIC);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    const cv::Size label(width_of_digit * static_cast<int>(number.size()) + 2, height);
    const cv::Rect place = place_beside(segments == ids[i], label, taken);
    taken(place) = 255;
    const cv::Rect shown(place.x * zoom, place.y * zoom, place.width * zoom, place.height * zoom);
    cv::rectangle(large, shown, {255, 255, 255}, cv::FILLED);
    cv::rectangle(large, shown, {0, 0, 0}, 2);
    cv::putText(large, number, {shown.x + zoom, shown.y + shown.height - zoom - 3}, cv::FONT_HERSHEY_SIMPLEX, 1.6,
                {0, 0, 0}, 4);
  }
  Observation picture;
  picture.size = {large.rows, large.cols};
  picture.rgb.assign(large.datastart, large.dataend);
  return picture;
}

}  // namespace lgabench::seeing
