// Steps with the selected class in them once more: their target in another look, or another member in its place. Looks
// and members are cut out of what was demonstrated, along the simulator's ids.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/abstraction/repaint.hpp>

class ClassCopies {
 public:
  /// `textures`: all of the feature space.
  ClassCopies(const std::vector<lgabench::Demonstration>& shown, lgabench::ActionSpace actions,
              std::vector<std::string> textures)
      : actions_(std::move(actions)),
        textures_(std::move(textures)),
        background_(lgabench::usual_background(shown)),
        moves_(actions_.places.size()) {
    std::vector<std::size_t> near(moves_.size());
    for (const lgabench::Demonstration& one : shown)
      for (const lgabench::Step& step : one.steps) {
        const std::optional<std::uint8_t> id = lgabench::taken(step, actions_);
        for (const lgabench::Instance& instance : step.observation.instances) {
          CutOut object = cut_out(step.observation, instance);
          if (object.pixels.empty() || lgabench::is_place(instance.object_type)) continue;
          if (instance.id == id) {
            for (std::size_t i = 0; i < near.size(); ++i) near[i] += is_near(object, step, actions_.places[i]);
            members_.push_back({object, step.label});
          }
          looks_.push_back(std::move(object));
        }
      }
    for (std::size_t i = 0; i < near.size(); ++i) moves_[i] = i == 0 || 2 * near[i] > members_.size();
  }

  /// Paints what the step takes in another texture that `meaning` has beside its type: a random pattern where it has
  /// all textures, else the colours of an object that was demonstrated. Nothing where none was.
  void another_look(lgabench::Step& step, const lgabench::Meaning& meaning, lgabench::RandomStream& stream) const {
    const std::optional<lgabench::Instance> target = taken_in(step);
    if (!target) return;
    const auto belongs = [&](const std::string& texture) { return meaning.belongs(target->object_type, texture); };
    lgabench::Observation& seen = step.observation;
    if (std::all_of(textures_.begin(), textures_.end(), belongs)) {
      seen = lgabench::repaint(std::move(seen), {target->id}, lgabench::RandomTextures{stream});
      return;
    }
    std::vector<const CutOut*> others;
    for (const CutOut& look : looks_)
      if (look.texture != target->texture && belongs(look.texture)) others.push_back(&look);
    if (others.empty()) return;
    const CutOut object = cut_out(seen, *target), &look = *others[below(others.size(), stream)];
    for (const Pixel& pixel : object.pixels) {
      const Pixel& like =
          *std::min_element(look.pixels.begin(), look.pixels.end(),
                            [&](const Pixel& a, const Pixel& b) { return squares(a, pixel) < squares(b, pixel); });
      paint(seen, object.row + pixel.row, object.column + pixel.column, like.colour);
    }
  }

  /// Takes away what the step takes, and puts a member of `meaning` that was taken in a demonstration where nothing
  /// stands, with the label that takes it there. Nothing where no such member, or no such place, was found.
  void another_member(lgabench::Step& step, const lgabench::Meaning& meaning, lgabench::RandomStream& stream) const {
    constexpr int tries = 50;
    std::vector<const Member*> members;
    for (const Member& one : members_)
      if (meaning.belongs(one.object.object_type, one.object.texture)) members.push_back(&one);
    const std::optional<lgabench::Instance> target = taken_in(step);
    if (members.empty() || !target) return;
    const auto& [object, label] = *members[below(members.size(), stream)];
    lgabench::Observation& seen = step.observation;
    for (int i = 0; i < tries; ++i) {
      const int row = below(seen.size.rows, stream), column = below(seen.size.columns, stream);
      if (!is_free(seen, object, row, column, target->id)) continue;
      seen = lgabench::repaint(std::move(seen), {target->id}, background_);
      for (const Pixel& pixel : object.pixels) paint(seen, row + pixel.row, column + pixel.column, pixel.colour);
      step.label = moved(label, row - object.row, column - object.column, seen.size);
      return;
    }
  }

 private:
  struct Pixel {
    int row, column;  // about the middle
    lgabench::Colour colour;
  };
  struct CutOut {
    std::string object_type, texture;
    int row = 0, column = 0;  // of the middle
    std::vector<Pixel> pixels{};
  };
  struct Member {
    CutOut object;
    lgabench::Action label;  // that takes it where it is
  };

  static CutOut cut_out(const lgabench::Observation& seen, const lgabench::Instance& one) {
    CutOut object{one.object_type, one.texture};
    for (int i = 0; i < static_cast<int>(seen.ids.size()); ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (seen.ids[at] != one.id) continue;
      const std::uint8_t* rgb = &seen.rgb[3 * at];
      object.pixels.push_back({i / seen.size.columns, i % seen.size.columns, {rgb[0], rgb[1], rgb[2]}});
      object.row += object.pixels.back().row;
      object.column += object.pixels.back().column;
    }
    const int count = std::max(1, static_cast<int>(object.pixels.size()));
    object.row /= count;
    object.column /= count;
    for (Pixel& pixel : object.pixels) {
      pixel.row -= object.row;
      pixel.column -= object.column;
    }
    return object;
  }
  static int squares(const Pixel& a, const Pixel& b) {
    return (a.row - b.row) * (a.row - b.row) + (a.column - b.column) * (a.column - b.column);
  }
  static void paint(lgabench::Observation& seen, int row, int column, const lgabench::Colour& colour) {
    std::copy(colour.begin(), colour.end(), &seen.rgb[3 * static_cast<std::size_t>(row * seen.size.columns + column)]);
  }
  template <class Count>
  static Count below(Count count, lgabench::RandomStream& stream) {
    return static_cast<Count>(stream.below(static_cast<std::uint32_t>(count)));
  }

  // Within the object's circle about its middle: what a turn in its place leaves there.
  bool is_near(const CutOut& object, const lgabench::Step& step, const lgabench::PicturePlace& place) const {
    const lgabench::Vec2 at = lgabench::in_picture(actions_, place, step.label, step.observation.size);
    double radius = 0;
    for (const Pixel& pixel : object.pixels) radius = std::max(radius, std::hypot(pixel.row, pixel.column));
    return std::hypot(at.y - object.row - .5, at.x - object.column - .5) <= radius;
  }

  std::optional<lgabench::Instance> taken_in(const lgabench::Step& step) const {
    const std::optional<std::uint8_t> id = lgabench::taken({{}, {step}}, actions_);
    const auto& all = step.observation.instances;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.id == id; });
    return found == all.end() ? std::nullopt : std::optional(*found);
  }

  static bool is_free(const lgabench::Observation& seen, const CutOut& object, int row, int column, std::uint8_t gone) {
    return std::all_of(object.pixels.begin(), object.pixels.end(), [&](const Pixel& pixel) {
      const int r = row + pixel.row, c = column + pixel.column;
      if (r < 0 || c < 0 || r >= seen.size.rows || c >= seen.size.columns) return false;
      const std::uint8_t id = seen.ids[static_cast<std::size_t>(r * seen.size.columns + c)];
      return id == 0 || id == gone;
    });
  }

  // By so many pixels, with the places that move with an object.
  lgabench::Action moved(lgabench::Action label, int down, int across, lgabench::PictureSize size) const {
    const auto add = [&](std::size_t number, double share) {
      const auto& [name, unit, low, high] = actions_.numbers[number];
      label[number] += share * (high - low);
    };
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      if (!moves_[i]) continue;
      add(actions_.places[i].down, static_cast<double>(down) / size.rows);
      add(actions_.places[i].across, static_cast<double>(across) / size.columns);
    }
    return label;
  }

  lgabench::ActionSpace actions_;
  std::vector<std::string> textures_;
  lgabench::Background background_;
  std::vector<bool> moves_;  // of the label's places: the first, and those that mostly lie where the object is
  std::vector<Member> members_;
  std::vector<CutOut> looks_;
};
