#include <lgabench/learning/heat_map.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <lgabench/core/error.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/core/stations.hpp>
#include <lgabench/learning/heat_map_network.hpp>
#include <lgabench/learning/motion.hpp>
#include <lgabench/learning/places.hpp>

namespace lgabench {
namespace {

constexpr PictureSize grid = HeatMapNetwork::grid, padded = HeatMapNetwork::padded;
constexpr int cells = HeatMapNetwork::cells;
constexpr int steps = 300, batch_size = 16;
constexpr double learning_rate = 3e-3;
constexpr double label_m = .015;   // standard deviation of the map that is taught
constexpr double near_m = .05;     // of the peak: what the taken point is the mean of
constexpr double one_way_m = .05;  // more spread of later places is another way to move
constexpr float least_prior = 1e-4f;

bool is_mask(const SampleShape::Picture& picture) { return picture.channels == 1; }

// What the network sees of one row.
struct View {
  Numbers planes;               // padded x planes
  std::vector<float> prior;     // of each cell; empty without a mask
  const float* mask = nullptr;  // of the row that is viewed, like the text; null without one
  const float* text = nullptr;
  std::size_t mask_pixels = 0;

  const float* prior_or_null() const { return prior.empty() ? nullptr : prior.data(); }
  bool shows_target() const {
    return !mask || std::any_of(mask, mask + mask_pixels, [](float v) { return v > 0; });
  }
};

// What a row teaches.
struct Lesson {
  View view;
  std::vector<float> wanted{};  // of each cell; empty where it teaches nothing
  Vec2 taken_m{};
  std::size_t group = 0;
  std::vector<float> station{};  // of each cell, of the map that finds it; empty where it teaches none
};

}  // namespace

struct HeatMap::Impl {
  const SampleShape shape;
  const Field field;
  const std::uint64_t seed;
  const double penalty;  // of a copy's map that differs from that of the row it was made of
  int unaltered = 0;     // rows, before the copies
  int planes = 0;
  std::optional<std::size_t> mask;                         // the first, of the pictures
  int mask_plane = 0;                                      // its first of two
  std::vector<std::vector<float>> usual;                   // of each picture; empty for a mask
  std::vector<Lesson> lessons;                             // of each row that begin() was given
  std::optional<HeatMapNetwork> network, station_network;  // the latter where actions have stations
  bool tells_second = false;                               // the mask tells the second set from the target
  std::vector<float> station_prior;
  std::optional<Action> mean;
  std::optional<Motion> motion;  // none where no target was seen
  bool takes = true;             // pose0 is the taken point
  View seen;                     // by predict()
  std::vector<float> outputs;

  Impl(const SampleShape& of_a_row, std::uint64_t from, double of_copies)
      : shape(of_a_row), field(shape.actions), seed(from), penalty(of_copies), usual(shape.pictures.size()) {
    for (std::size_t i = 0; i < shape.pictures.size(); ++i) {
      const SampleShape::Picture& picture = shape.pictures[i];
      const bool fits = is_mask(picture)
                            ? picture.size.rows % grid.rows == 0 && picture.size.columns % grid.columns == 0
                            : picture.size == grid;
      if (!fits)
        throw InputError(
            "inputs: expected masks of a multiple of 32 x 64 pixels and colours of 32 x 64 for policy=heat_map");
      if (is_mask(picture) && !mask) mask = i, mask_plane = planes;
      planes += is_mask(picture) ? 2 : picture.channels;
    }
    if (planes == 0) throw InputError("inputs: expected a picture for policy=heat_map");
    seen = new_view();
  }

  View new_view() const {
    View view;
    view.planes = Numbers(size(padded.rows * padded.columns * planes));
    if (mask) {
      view.prior.resize(cells);
      view.mask_pixels = shape.pictures[*mask].size.pixels();
    }
    return view;
  }

  float* plane(View& view, int cell, int number) const {
    const int row = cell / grid.columns + HeatMapNetwork::border, column = cell % grid.columns + HeatMapNetwork::border;
    return view.planes + (row * padded.columns + column) * planes + number;
  }

  void look(const Samples& samples, int row, View& view) const {
    int number = 0;
    for (std::size_t i = 0; i < shape.pictures.size(); ++i) {
      const float* const picture = samples.picture(i, row);
      const int channels = shape.pictures[i].channels;
      if (is_mask(shape.pictures[i])) {
        look_at_mask(picture, shape.pictures[i].size, number, view);
        if (i == mask) {
          view.mask = picture;
          set_prior(number, view);
        }
        number += 2;
        continue;
      }
      for (int at = 0; at < cells * channels; ++at)
        *plane(view, at / channels, number + at % channels) = picture[at] - usual[i][size(at)];
      number += channels;
    }
    if (shape.text) view.text = samples.text.data() + std::ptrdiff_t{row} * text_size;
  }

  // The share of each cell that is the target's, and that is to be avoided.
  void look_at_mask(const float* picture, PictureSize of, int number, View& view) const {
    const int high = of.rows / grid.rows, wide = of.columns / grid.columns;  // pixels of a cell
    for (int cell = 0; cell < cells; ++cell) {
      const float* const corner = picture + cell / grid.columns * high * of.columns + cell % grid.columns * wide;
      int target = 0, avoid = 0;
      for (int y = 0; y < high; ++y)
        for (int x = 0; x < wide; ++x) {
          target += corner[y * of.columns + x] > 0;
          avoid += corner[y * of.columns + x] < 0;
        }
      *plane(view, cell, number) = static_cast<float>(target) / static_cast<float>(high * wide);
      *plane(view, cell, number + 1) = static_cast<float>(avoid) / static_cast<float>(high * wide);
    }
  }

  FieldMask field_mask(const View& view) const { return {view.mask, shape.pictures[*mask].size, field}; }
  Vec2 middle_of_cell(int cell) const { return field.middle_of(grid, cell / grid.columns, cell % grid.columns); }

  void set_prior(int number, View& view) const { set_prior(number, view, view.prior); }

  void set_prior(int number, View& view, std::vector<float>& prior) const {
    for (int cell = 0; cell < cells; ++cell)
      prior[size(cell)] = std::log(std::max(*plane(view, cell, number), least_prior));
  }

  // Of the map that finds the station: the second set, or all of a mask that does not tell it. Null without a mask.
  const float* prior_of_station(View& view) {
    if (!mask) return nullptr;
    station_prior.resize(cells);
    set_prior(mask_plane + (tells_second ? 1 : 0), view, station_prior);
    return station_prior.data();
  }

  // A Gaussian about a point, within what the prior holds.
  std::vector<float> wanted(const std::vector<float>& prior, Vec2 point) const {
    std::vector<float> map(cells);
    double sum = 0;
    for (int cell = 0; cell < cells; ++cell) {
      const double away = norm(middle_of_cell(cell) - point) / label_m;
      const bool within = prior.empty() || prior[size(cell)] > std::log(least_prior);
      map[size(cell)] = within ? static_cast<float>(std::exp(-away * away / 2)) : 0;
      sum += map[size(cell)];
    }
    if (sum < 1e-6) return {};
    for (float& value : map) value = static_cast<float>(value / sum);
    return map;
  }

  void begin(const Samples& samples);
  void make_networks(std::size_t groups);
  void begin_stations(const std::vector<Demonstrated>& shown, const std::vector<std::size_t>& rows);
  double teach(int row, double weight);
  Vec2 taken_point(const std::vector<float>& map) const;
  Action act();
};

void HeatMap::Impl::begin(const Samples& samples) {
  for (std::size_t i = 0; i < usual.size(); ++i)
    if (!is_mask(shape.pictures[i])) usual[i] = usual_picture(samples, i);

  unaltered = samples.unaltered;
  std::vector<Action> labels;
  std::vector<Demonstrated> shown;
  std::vector<std::size_t> rows;  // of those
  for (int row = 0; row < samples.rows; ++row) {
    const Action done = executable(shape.actions, samples.label(row));
    labels.push_back(done);
    look(samples, row, lessons.emplace_back(Lesson{new_view()}).view);
    const View& view = lessons.back().view;
    if (!view.shows_target()) continue;
    Demonstrated demonstrated{done, {place_of(shape.actions, done, 0)}, {}};
    for (std::size_t i = 0; i < shape.actions.places.size(); ++i)
      demonstrated.on_target.push_back(view.mask ? field_mask(view).on_target(place_of(shape.actions, done, i))
                                                 : i == 0);
    if (view.mask) demonstrated.places.second_m = field_mask(view).avoided();
    shown.push_back(demonstrated);
    rows.push_back(size(row));
  }
  mean = mean_action(shape.actions, labels);
  const Stations& stations = shape.actions.stations;
  if (!stations.all.empty()) mean = led_to(stations, station_of(stations, *mean), *mean);

  takes = !mask || mostly_on_target(shown, 0);
  Eye eye;
  for (std::size_t i = 0; i < shown.size() && !takes; ++i) {
    Demonstrated& one = shown[i];
    const Vec2 begin = place_of(shape.actions, one.label, 0);
    one.places.taken_m = *eye.taken(field_mask(lessons[rows[i]].view), &begin);
  }
  Groups groups = one_group(shown);
  if (!shown.empty()) {
    motion.emplace(shape.actions, shown, groups, takes, true);
    if (motion->spread_m() > one_way_m) {
      groups = by_push(shape.actions, shown);
      motion.emplace(shape.actions, shown, groups, takes, true);
    }
  }
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const std::size_t member : groups[g]) {
      Lesson& lesson = lessons[rows[member]];
      lesson.taken_m = shown[member].places.taken_m;
      lesson.wanted = wanted(lesson.view.prior, lesson.taken_m);
      lesson.group = g;
    }
  make_networks(groups.size());
  if (!stations.all.empty()) begin_stations(shown, rows);
}

void HeatMap::Impl::make_networks(std::size_t groups) {
  constexpr std::uint64_t another = std::uint64_t{1} << 63;  // initial weights of its own
  const Kernels& kernels = *available_kernels().front();
  network.emplace(field, planes, shape.text, groups, seed, kernels);
  if (!shape.actions.stations.all.empty())
    station_network.emplace(field, planes, shape.text, 1, seed ^ another, kernels);
}

void HeatMap::Impl::begin_stations(const std::vector<Demonstrated>& shown, const std::vector<std::size_t>& rows) {
  tells_second = std::any_of(shown.begin(), shown.end(), [](const auto& one) { return one.places.second_m; });
  const Stations& stations = shape.actions.stations;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    Lesson& lesson = lessons[rows[i]];
    prior_of_station(lesson.view);
    lesson.station = wanted(station_prior, stations.all[station_of(stations, shown[i].label)].seen);
  }
}

// Adds the gradients of one row, and returns its loss.
double HeatMap::Impl::teach(int row, double weight) {
  auto& [view, wanted, taken_m, group, station] = lessons[size(row)];
  double loss = 0;
  if (!wanted.empty()) {
    std::vector<float> like;
    if (penalty > 0 && row >= unaltered) {
      View& original = lessons[size(row % unaltered)].view;
      like = network->map(original.planes, original.prior_or_null(), original.text);
    }
    network->map(view.planes, view.prior_or_null(), view.text);
    loss += network->teach(wanted, taken_m, group, weight, like, penalty);
  }
  if (!station.empty()) {
    station_network->map(view.planes, prior_of_station(view), view.text);
    loss += station_network->teach(station, {}, 0, weight);
  }
  return loss;
}

// The mean of what is near the highest sum of 3 x 3 cells.
Vec2 HeatMap::Impl::taken_point(const std::vector<float>& map) const {
  int peak = 0;
  double highest = -1;
  for (int cell = 0; cell < cells; ++cell) {
    const int row = cell / grid.columns, column = cell % grid.columns;
    double sum = 0;
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, grid.rows - 1); ++r)
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, grid.columns - 1); ++c)
        sum += map[size(r * grid.columns + c)];
    if (sum > highest) {
      highest = sum;
      peak = cell;
    }
  }
  Vec2 moment;
  double mass = 0;
  for (int cell = 0; cell < cells; ++cell) {
    const Vec2 middle = middle_of_cell(cell);
    if (norm(middle - middle_of_cell(peak)) > near_m) continue;
    moment = moment + double{map[size(cell)]} * middle;
    mass += map[size(cell)];
  }
  return 1 / mass * moment;
}

Action HeatMap::Impl::act() {
  if (!motion || !seen.shows_target()) return *mean;
  Places places{taken_point(network->map(seen.planes, seen.prior_or_null(), seen.text))};
  if (seen.mask) {
    places.taken_m = field_mask(seen).onto_target(places.taken_m);
    places.second_m = field_mask(seen).avoided();
  }
  const std::vector<float>& groups = network->groups(places.taken_m);
  const auto likeliest = std::max_element(groups.begin(), groups.end()) - groups.begin();
  Action action = motion->act(places, static_cast<std::size_t>(likeliest));
  if (!station_network) return action;
  const Vec2 second = taken_point(station_network->map(seen.planes, prior_of_station(seen), seen.text));
  return led_to(shape.actions.stations, nearest_station(shape.actions.stations, second), std::move(action));
}

HeatMap::HeatMap(const SampleShape& shape, std::uint64_t seed, double copy_penalty) {
  flush_denormals();
  impl_ = std::make_unique<Impl>(shape, seed, copy_penalty);
}
HeatMap::~HeatMap() = default;

TrainingOptions HeatMap::schedule(const TrainingOptions&, int samples) const {
  const int batches = samples / std::min(batch_size, samples);
  return {(steps + batches - 1) / batches, batch_size, learning_rate, Batches::shuffled, true};
}

void HeatMap::begin(const Samples& samples) { impl_->begin(samples); }

const std::vector<float>& HeatMap::predict(const Samples& samples) {
  impl_->outputs.clear();
  for (int row = 0; row < samples.rows; ++row) {
    impl_->look(samples, row, impl_->seen);
    const Action action = as_stored(impl_->shape.actions, impl_->act());
    impl_->outputs.insert(impl_->outputs.end(), action.begin(), action.end());
  }
  return impl_->outputs;
}

std::vector<float> HeatMap::features(const Samples& samples) {
  std::vector<float> all;
  for (int row = 0; row < samples.rows; ++row) {
    View& seen = impl_->seen;
    impl_->look(samples, row, seen);
    impl_->network->map(seen.planes, seen.prior_or_null(), seen.text);
    const std::vector<float> of_cells = impl_->network->highest_and_mean();
    all.insert(all.end(), of_cells.begin(), of_cells.end());
    if (seen.text) all.insert(all.end(), seen.text, seen.text + text_size);
  }
  return all;
}

double HeatMap::backward(const Samples&, const std::vector<int>& batch) {
  impl_->network->clear_gradients();
  if (impl_->station_network) impl_->station_network->clear_gradients();
  double loss = 0;
  const double weight = 1. / static_cast<double>(batch.size());
  for (const int row : batch) loss += weight * impl_->teach(row, weight);
  return loss;
}

void HeatMap::update(double rate) {
  impl_->network->update(rate);
  if (impl_->station_network) impl_->station_network->update(rate);
}

std::vector<float> HeatMap::parameters() const {
  std::vector<float> all;
  for (auto* network : {&impl_->network, &impl_->station_network}) {
    if (!*network) continue;
    const std::vector<float> values = (*network)->parameters().values();
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

bool HeatMap::learned(Archive& archive) {
  Impl& i = *impl_;
  const std::vector<std::vector<float>> made = i.usual;
  archive(i.usual);
  name_motion(i.motion, i.mean, i.shape.actions, archive);
  archive(i.tells_second);
  if (archive.reads()) {
    for (std::size_t p = 0; p < made.size(); ++p)
      if (i.usual.size() != made.size() ||
          i.usual[p].size() != (is_mask(i.shape.pictures[p]) ? 0 : size(i.shape.pictures[p].numbers())))
        Archive::fail();
    i.make_networks(i.motion ? i.motion->groups() : 1);
  }
  i.network->parameters().learned(archive);
  if (i.station_network) i.station_network->parameters().learned(archive);
  return true;
}

void HeatMap::set_parameters(const std::vector<float>& parameters) { impl_->network->parameters().set(parameters); }
std::vector<float> HeatMap::gradients() const { return impl_->network->parameters().gradients(); }

}  // namespace lgabench
