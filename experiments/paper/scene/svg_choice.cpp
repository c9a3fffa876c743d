#include "experiments/paper/scene/svg_choice.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "core/error.h"
#include "experiments/paper/scene/join_lines.h"

namespace geoprior::paper {
namespace {

using Shapes = std::vector<const SvgShape*>;

constexpr const char* kEnclosing = "path, polygon, polyline, rect, circle, ellipse";

/// A line encloses nothing, whatever it is filled with.
bool encloses(const SvgShape& shape) { return shape.element != "line"; }

std::string ids_of(const Shapes& shapes) {
  constexpr std::size_t kMostIds = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(shapes.size(), kMostIds); ++i) {
    const std::string& id = shapes[i]->tags.id;
    list += (list.empty() ? "" : ", ") +
            (id.empty() ? "(a " + shapes[i]->element + " without id)" : id);
  }
  return list + (shapes.size() > kMostIds ? ", …" : "");
}

std::string in_millimetres(double metres) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.3g mm", 1e3 * metres);
  return text.data();
}

std::string place_in_millimetres(const Eigen::Vector2d& p) {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "x %.4g mm, y %.4g mm", 1e3 * p.x(), 1e3 * p.y());
  return text.data();
}

/// Where an open line ends, and how far it is to the nearest end of another.
std::string gap_text(const std::vector<SvgSubpath>& open) {
  const Eigen::Vector2d& from = open[0].points.back();
  double nearest = (from - open[0].points.front()).norm();
  for (std::size_t i = 1; i < open.size(); ++i) {
    for (const Eigen::Vector2d& to : {open[i].points.front(), open[i].points.back()})
      nearest = std::min(nearest, (from - to).norm());
  }
  return "the outline is open: from an end at " + place_in_millimetres(from) +
         " (from the lower left corner of the page) the nearest end is " + in_millimetres(nearest) +
         " away";
}

class SvgChooser {
 public:
  SvgChooser(const SvgDocument& drawing, double gap, std::string key,
             std::vector<std::string>& notes)
      : drawing_(drawing), gap_(gap), key_(std::move(key)), notes_(notes) {
    for (const SvgShape& shape : drawing.shapes) {
      all_.push_back(&shape);
      if (encloses(shape)) enclosing_.push_back(&shape);
    }
  }

  [[nodiscard]] SvgChoice of_id(const std::string& id) const {
    Shapes named;
    for (const SvgShape* shape : all_) {
      if (shape->tags.id == id) named.push_back(shape);
    }
    std::vector<int> groups;
    for (int i = 0; i < static_cast<int>(drawing_.groups.size()); ++i) {
      if (drawing_.groups[i].tags.id == id) groups.push_back(i);
    }
    if (named.empty() && groups.empty()) throw unknown(id);
    if (named.size() + groups.size() > 1) {
      throw Error(
          "'" + id + "' is drawn " + std::to_string(named.size() + groups.size()) + " times",
          key_ + drawing_.name, "a shape that is drawn once");
    }
    return groups.empty() ? of_shape(*named[0]) : of_group(groups[0]);
  }

  [[nodiscard]] SvgChoice only_one() const {
    if (enclosing_.size() == 1) return of_shape(*enclosing_[0]);
    if (auto joined = joined_if_it_closes(all_)) return *std::move(joined);
    if (enclosing_.empty()) throw nothing();
    throw Error(std::to_string(enclosing_.size()) + " shapes, and 'path' names none",
                key_ + drawing_.name, ids_of(enclosing_));
  }

 private:
  [[nodiscard]] Error nothing() const {
    return Error("draws no shape that encloses anything", key_ + drawing_.name, kEnclosing);
  }

  [[nodiscard]] Error unknown(const std::string& id) const {
    if (enclosing_.empty()) return nothing();
    return Error("no shape with id '" + id + "'", key_ + drawing_.name, ids_of(enclosing_));
  }

  [[nodiscard]] SvgChoice of_shape(const SvgShape& shape) const {
    const std::string place = drawing_.place(shape.element, shape.tags);
    if (!encloses(shape)) throw Error("a line encloses nothing", key_ + place, kEnclosing);
    // What is not filled is a drawing of the border and of what is cut out of it.
    return {shape.lines, shape.filled && !shape.even_odd, shape.clips, place};
  }

  [[nodiscard]] bool lies_in(const SvgShape& shape, int group) const {
    int around = shape.group;
    while (around >= 0 && around != group) around = drawing_.groups[around].parent;
    return around == group;
  }

  [[nodiscard]] SvgChoice of_group(int index) const {
    const SvgGroup& group = drawing_.groups[index];
    const std::string place = drawing_.place("group", group.tags);
    if (group.hidden) throw Error("is not displayed", key_ + place, "what is drawn");
    Shapes inside;
    for (const SvgShape* shape : all_) {
      if (lies_in(*shape, index)) inside.push_back(shape);
    }
    if (inside.size() == 1) {
      SvgChoice choice = of_shape(*inside[0]);
      choice.where = place + ", " + inside[0]->element;
      return choice;
    }
    if (inside.empty()) throw Error("draws no shape", key_ + place, kEnclosing);
    const SvgJoinedLines joined = joined_lines(inside);
    if (!joined.open.empty()) {
      throw Error(gap_text(joined.open), key_ + place,
                  "lines that touch, within " + in_millimetres(gap_) +
                      " (scene.pattern.tolerance), or the id of one shape: " + ids_of(inside));
    }
    return of_joined(inside, joined, place);
  }

  [[nodiscard]] SvgJoinedLines joined_lines(const Shapes& shapes) const {
    std::vector<SvgSubpath> lines;
    for (const SvgShape* shape : shapes)
      lines.insert(lines.end(), shape->lines.begin(), shape->lines.end());
    return join_svg_lines(lines, gap_);
  }

  /// Of open lines that need each other, and leave none over.
  [[nodiscard]] std::optional<SvgChoice> joined_if_it_closes(const Shapes& shapes) const {
    if (shapes.size() < 2) return std::nullopt;
    const SvgJoinedLines joined = joined_lines(shapes);
    const bool all_joined = joined.open.empty() && joined.closed.size() == 1 && joined.pieces > 1;
    if (!all_joined) return std::nullopt;
    return of_joined(shapes, joined, drawing_.name);
  }

  [[nodiscard]] SvgChoice of_joined(const Shapes& shapes, const SvgJoinedLines& joined,
                                    const std::string& place) const {
    SvgChoice choice{joined.closed, false, {}, place};
    for (const SvgShape* shape : shapes) {
      for (const int clip : shape->clips) {
        if (std::find(choice.clips.begin(), choice.clips.end(), clip) == choice.clips.end())
          choice.clips.push_back(clip);
      }
    }
    std::string note = place + ": " + std::to_string(shapes.size()) +
                       " shapes are one outline of " + std::to_string(joined.closed.size()) +
                       " closed lines, the largest of them "
                       "the border";
    if (joined.pieces > 0) {
      note += "; " + std::to_string(joined.pieces) + " open lines were joined over gaps of up to " +
              in_millimetres(joined.widest_gap);
    }
    notes_.push_back(note);
    return choice;
  }

  const SvgDocument& drawing_;
  double gap_;
  std::string key_;
  std::vector<std::string>& notes_;
  Shapes all_, enclosing_;
};

}  // namespace

SvgChoice choose_lines(const SvgDocument& drawing, const std::optional<std::string>& id, double gap,
                       const std::string& key, std::vector<std::string>& notes) {
  const SvgChooser chooser(drawing, gap, key, notes);
  return id ? chooser.of_id(*id) : chooser.only_one();
}

}  // namespace geoprior::paper
