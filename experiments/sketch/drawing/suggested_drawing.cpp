#include "experiments/sketch/drawing/suggested_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

#include "experiments/sketch/fabrication/escaped_text.h"
#include "experiments/sketch/pattern/sheet_text.h"

namespace geoprior::sketch {
namespace {

constexpr double kMillimetres = 1000;
constexpr double kMarginMm = 20;
constexpr double kPriceOfAChange = 0.01;  ///< m

std::string decimal(double value) {
  std::array<char, 48> text;
  std::snprintf(text.data(), text.size(), "%.3f", value == 0 ? 0 : value);
  return text.data();
}

/// Text of a stroke's attributes for what it means; colours are those of docs/sketching.md.
const char* meaning_of(StrokeKind kind) {
  switch (kind) {
    case StrokeKind::silhouette:
      return "data-kind=\"silhouette\" stroke=\"#000000\"";
    case StrokeKind::border:
      return "data-kind=\"border\" stroke=\"#0000ff\"";
    case StrokeKind::seam:
      return "data-kind=\"seam\" stroke=\"#ff0000\"";
    case StrokeKind::fold:
      return "data-kind=\"fold\" stroke=\"#00aa00\"";
    default:
      return nullptr;  // of a single view
  }
}

const char* depth_of(DepthSide side) {
  return side == DepthSide::back ? "back" : side == DepthSide::both ? "both" : "front";
}

std::string path_element(const Stroke& stroke) {
  const char* meaning = meaning_of(stroke.kind);
  if (meaning == nullptr) return {};
  std::string text = "    <path id=\"" + xml_text(label_text(stroke.id, 200)) + "\" " + meaning;
  if (stroke.kind == StrokeKind::seam || stroke.kind == StrokeKind::fold)
    text += std::string(" data-depth=\"") + depth_of(stroke.side) + "\"";
  if (stroke.fold_angle_deg) text += " data-fold-angle=\"" + decimal(*stroke.fold_angle_deg) + "\"";
  if (stroke.fold_width)
    text += " data-fold-width=\"" + decimal(kMillimetres * *stroke.fold_width) + "mm\"";
  text += "\n          d=\"";
  for (std::size_t i = 0; i < stroke.points.size(); ++i) {
    text += (i == 0 ? "M " : " L ") + decimal(kMillimetres * stroke.points[i].x()) + " " +
            decimal(kMillimetres * stroke.points[i].y());
  }
  return text + (stroke.closed ? " Z\"/>\n" : "\"/>\n");
}

/// Of each segment of a line the view and side from which it is drawn: the cheapest sequence, where
/// a segment costs its length times one minus the cosine between normal and view.
struct Seen {
  std::size_t view = 0;
  bool back = false;
};

std::vector<Seen> seen_from(const Eigen::MatrixX3d& line, const Eigen::MatrixX3d& normals,
                            const std::vector<View>& views) {
  const std::size_t segments = std::max<Eigen::Index>(line.rows() - 1, 0);
  const std::size_t states = 2 * views.size();
  std::vector<std::vector<double>> cost(segments, std::vector<double>(states));
  std::vector<std::vector<std::size_t>> before(segments, std::vector<std::size_t>(states, 0));
  for (std::size_t i = 0; i < segments; ++i) {
    const Eigen::RowVector3d normal = (normals.row(i) + normals.row(i + 1)).normalized();
    const double size = (line.row(i + 1) - line.row(i)).norm();
    for (std::size_t s = 0; s < states; ++s) {
      const double sign = s % 2 == 0 ? 1 : -1;
      const double facing = sign * view_frame(views[s / 2].kind).row(2).dot(normal);
      // What faces away is seen by another view.
      cost[i][s] = size * (facing > 0.05 ? 1 - facing : 100);
      if (i == 0) continue;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t from = 0; from < states; ++from) {
        const double sum = cost[i - 1][from] + (from == s ? 0 : kPriceOfAChange);
        if (sum >= least) continue;
        least = sum;
        before[i][s] = from;
      }
      cost[i][s] += least;
    }
  }
  std::vector<Seen> seen(segments);
  if (segments == 0) return seen;
  std::size_t state =
      std::min_element(cost.back().begin(), cost.back().end()) - cost.back().begin();
  for (std::size_t i = segments; i-- > 0; state = before[i][state])
    seen[i] = {state / 2, state % 2 == 1};
  return seen;
}

/// Adds a line as strokes of the views.
void add_line(const Eigen::MatrixX3d& line, const Eigen::MatrixX3d& normals, const std::string& id,
              std::vector<View>& views) {
  const std::vector<Seen> seen = seen_from(line, normals, views);
  int part = 0;
  for (std::size_t i = 0; i < seen.size();) {
    std::size_t end = i;
    while (end < seen.size() && seen[end].view == seen[i].view && seen[end].back == seen[i].back)
      ++end;
    View& view = views[seen[i].view];
    Stroke stroke;
    stroke.id = id + "-" + std::to_string(++part);
    stroke.kind = StrokeKind::seam;
    stroke.side = seen[i].back ? DepthSide::back : DepthSide::front;
    for (std::size_t k = i; k <= end; ++k) {
      stroke.points.emplace_back(view_frame(view.kind).topRows<2>() * line.row(k).transpose());
    }
    view.strokes.push_back(std::move(stroke));
    i = end;
  }
}

void add_lines(const CutLines& lines, const std::string& id, std::vector<View>& views) {
  for (std::size_t k = 0; k < lines.points.size(); ++k)
    add_line(lines.points[k], lines.normals[k], id + "-" + std::to_string(k + 1), views);
}

}  // namespace

std::string suggested_drawing_svg(const Drawing& aligned,
                                  const std::vector<SuggestedSeam>& suggestions) {
  std::vector<View> views;
  for (const View& view : aligned.views) {
    if (view.kind != ViewKind::photo) views.push_back(view);
  }
  for (std::size_t i = 0; i < suggestions.size(); ++i) {
    add_lines(suggestions[i].lines, "suggestion-" + std::to_string(i + 1), views);
  }
  if (!suggestions.empty()) add_lines(suggestions.back().opening_lines, "opening", views);
  std::string body;
  double right = kMarginMm, height = 0;
  for (const View& view : views) {
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector2d high = -low;
    for (const Stroke* stroke : strokes_of(view, StrokeKind::silhouette)) {
      for (const Eigen::Vector2d& p : stroke->points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    body += std::string("  <g inkscape:groupmode=\"layer\" inkscape:label=\"view:") +
            view_name(view.kind) + "\" transform=\"translate(" +
            decimal(right - kMillimetres * low.x()) + " " +
            decimal(kMarginMm + kMillimetres * high.y()) + ") scale(1 -1)\">\n";
    for (const Stroke& stroke : view.strokes) body += path_element(stroke);
    body += "  </g>\n";
    right += kMillimetres * (high.x() - low.x()) + 2 * kMarginMm;
    height = std::max(height, kMillimetres * (high.y() - low.y()) + 2 * kMarginMm);
  }
  const std::string size_mm = decimal(right) + "mm\" height=\"" + decimal(height) + "mm\"";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
         "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"\n     width=\"" +
         size_mm + " viewBox=\"0 0 " + decimal(right) + " " + decimal(height) +
         "\" fill=\"none\" stroke-width=\"1.2\">\n" + body + "</svg>\n";
}

}  // namespace geoprior::sketch
