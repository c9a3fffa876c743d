#include "solvers/sketch/hidden/completed_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

namespace geoprior::sketch {

CompletedView as_drawn(const View& view) {
  CompletedView out;
  out.view = view;
  for (int s = 0; s < std::ssize(view.strokes); ++s) {
    std::vector<DrawnPlace> places;
    for (std::size_t k = 0; k < view.strokes[s].points.size(); ++k)
      places.push_back({s, static_cast<double>(k)});
    out.places.push_back(std::move(places));
    if (view.strokes[s].kind == StrokeKind::border) out.drawn_length += length(view.strokes[s]);
  }
  return out;
}

void put_strokes(const View& view, const std::vector<PartialBorder>& borders,
                 const std::vector<Stroke>& added_pairs, CompletedView& out) {
  std::vector<Stroke> hidden;
  std::map<int, int> number_of;  // strokes of the drawing in the result
  for (int s = 0; s < std::ssize(view.strokes); ++s) {
    Stroke stroke = view.strokes[s];
    std::vector<DrawnPlace> places;
    if (stroke.kind != StrokeKind::border || stroke.points.size() < 2) {
      for (std::size_t k = 0; k < stroke.points.size(); ++k)
        places.push_back({s, static_cast<double>(k)});
    } else {
      const auto border = std::find_if(borders.begin(), borders.end(),
                                       [&](const PartialBorder& b) { return b.stroke == s; });
      if (border == borders.end()) continue;  // it is part of another
      stroke.points.clear();
      stroke.closed = border->closed;
      Stroke run;
      run.kind = StrokeKind::occlusion;
      int number = 0;
      const Stretch& points = border->stretches.front();
      for (std::size_t k = 0; k <= points.size(); ++k) {
        const bool guessed = k < points.size() && points[k].place.stroke < 0;
        if (k < points.size()) {
          stroke.points.push_back(points[k].p);
          places.push_back(points[k].place);
        }
        if (guessed) {
          run.points.push_back(points[k].p);
          continue;
        }
        run.id = stroke.id + "-hidden-" + std::to_string(number + 1);
        if (run.points.size() > 1) {
          hidden.push_back(run);
          ++number;
        }
        run.points.clear();
      }
    }
    out.places.push_back(std::move(places));
    number_of[s] = static_cast<int>(out.view.strokes.size());
    out.view.strokes.push_back(std::move(stroke));
  }
  for (std::array<int, 2>& copy : out.copies)
    for (int& stroke : copy) stroke = number_of.at(stroke);
  hidden.insert(hidden.end(), added_pairs.begin(), added_pairs.end());
  for (Stroke& stroke : hidden) {
    out.places.emplace_back(stroke.points.size());
    out.view.strokes.push_back(std::move(stroke));
  }
}

void close_panels(const std::vector<PartialBorder>& borders, double snap, CompletedView& out) {
  std::map<std::string, std::vector<const PartialBorder*>> members;
  for (const PartialBorder& border : borders)
    for (const std::string& name : border.panels) members[name].push_back(&border);
  for (const auto& [name, around] : members) {
    if (!is_named_flat(name)) continue;
    std::vector<Eigen::Vector2d> ends;
    bool closed = false;
    for (const PartialBorder* border : around) {
      closed = closed || border->closed;
      ends.push_back(border->stretches.front().front().p);
      ends.push_back(border->stretches.front().back().p);
    }
    if (closed) continue;
    std::vector<Eigen::Vector2d> open;
    for (std::size_t e = 0; e < ends.size(); ++e) {
      bool met = false;
      for (std::size_t f = 0; f < ends.size(); ++f)
        met = met || (f / 2 != e / 2 && (ends[e] - ends[f]).norm() <= snap);
      if (!met) open.push_back(ends[e]);
    }
    if (open.size() != 2 || (open[0] - open[1]).norm() <= snap) continue;
    Stroke line;
    line.id = name + "-closing";
    line.kind = StrokeKind::border;
    line.name = name;
    constexpr int kPoints = 24;
    for (int k = 0; k <= kPoints; ++k)
      line.points.emplace_back(open[0] + (open[1] - open[0]) * (static_cast<double>(k) / kPoints));
    Stroke hidden = line;
    hidden.id += "-hidden";
    hidden.kind = StrokeKind::occlusion;
    hidden.name.clear();
    out.guesses.push_back({name, "a straight line", length(line)});
    for (Stroke& stroke : std::array<Stroke, 2>{line, hidden}) {
      out.places.emplace_back(stroke.points.size());
      out.view.strokes.push_back(std::move(stroke));
    }
  }
}

DrawnPlace CompletedView::place(int stroke, double at) const {
  const std::vector<DrawnPlace>& of = places[static_cast<std::size_t>(stroke)];
  const double low = std::floor(at);
  const DrawnPlace& a = of[static_cast<std::size_t>(low) % of.size()];
  if (at == low || a.stroke < 0) return a;
  const DrawnPlace& b = of[(static_cast<std::size_t>(low) + 1) % of.size()];
  if (b.stroke != a.stroke) return {};
  // The last point of a closed stroke is followed by its first.
  const double step = std::abs(b.at - a.at) > 1 ? 1 : b.at - a.at;
  return {a.stroke, a.at + (at - low) * step};
}

std::string completion_note(const CompletedView& completed) {
  if (completed.guesses.empty()) return "";
  std::array<char, 80> share{};
  std::snprintf(
      share.data(), share.size(), "%.0f %% of the length of all borders",
      100 * completed.guessed_length / (completed.drawn_length + completed.guessed_length));
  std::string text = "hidden parts of borders are guessed, " + std::string(share.data()) + ":";
  for (std::size_t k = 0; k < completed.guesses.size(); ++k) {
    const GuessedStretch& guess = completed.guesses[k];
    text += (k > 0 ? ", '" : " '") + guess.border + "' from " + guess.from;
  }
  return text;
}

}  // namespace geoprior::sketch
