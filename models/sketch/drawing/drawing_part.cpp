#include "models/sketch/drawing/drawing_part.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace geoprior::sketch {
namespace {

/// Between views, of the larger side of the front.
constexpr double kGap = 0.15;

Eigen::AlignedBox2d box_of(const View& view) {
  Eigen::AlignedBox2d box;
  for (const Stroke& stroke : view.strokes) {
    for (const Eigen::Vector2d& p : stroke.points) box.extend(p);
  }
  return box;
}

/// What is added to the places of a view: it may have been drawn anywhere on the page.
Eigen::Vector2d sheet_offset(ViewKind kind, const Eigen::AlignedBox2d& box,
                             const Eigen::AlignedBox2d& front, double gap) {
  if (kind == ViewKind::side)
    return {front.min().x() - gap - box.max().x(), front.min().y() - box.min().y()};
  if (kind == ViewKind::top)
    return {front.max().x() + gap - box.min().x(), front.center().y() - box.center().y()};
  return {0, 0};
}

}  // namespace

Part drawing_part(const Drawing& drawing) {
  Part part;
  part.kind = Part::Kind::lines;
  std::vector<Eigen::Vector2d> points;
  std::vector<double> kinds;
  const View* first = drawing.find(ViewKind::front);
  if (first == nullptr && !drawing.views.empty()) first = &drawing.views.front();
  const Eigen::AlignedBox2d front = first == nullptr ? Eigen::AlignedBox2d() : box_of(*first);
  const double gap = front.isEmpty() ? 0 : kGap * front.sizes().maxCoeff();
  for (const View& view : drawing.views) {
    const Eigen::Vector2d offset =
        &view == first ? Eigen::Vector2d(0, 0) : sheet_offset(view.kind, box_of(view), front, gap);
    for (const Stroke& stroke : view.strokes) {
      if (stroke.points.size() < 2) continue;  // a mark at a point
      std::vector<int>& line = part.lines.emplace_back();
      const auto begin = static_cast<int>(points.size());
      for (const Eigen::Vector2d& p : stroke.points) {
        line.push_back(static_cast<int>(points.size()));
        points.emplace_back(p + offset);
      }
      if (stroke.closed) line.push_back(begin);
      kinds.push_back(static_cast<double>(stroke.kind));
    }
  }
  part.points.setZero(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    part.points.row(i).head<2>() = points[i].transpose();
  part.arrays.push_back({"kind", "1", NamedArray::On::cells,
                         Eigen::Map<const Eigen::VectorXd>(kinds.data(), kinds.size())});
  return part;
}

}  // namespace geoprior::sketch
