#include "models/sketch/drawing/drawing.h"

#include <algorithm>
#include <cstddef>

namespace geoprior::sketch {

double length(const Stroke& stroke) {
  double sum = 0;
  for (std::size_t i = 1; i < stroke.points.size(); ++i)
    sum += (stroke.points[i] - stroke.points[i - 1]).norm();
  if (stroke.closed && !stroke.points.empty())
    sum += (stroke.points.front() - stroke.points.back()).norm();
  return sum;
}

const View* Drawing::find(ViewKind kind) const {
  for (const View& view : views) {
    if (view.kind == kind) return &view;
  }
  return nullptr;
}

Eigen::Matrix3d view_frame(ViewKind kind) {
  Eigen::Matrix3d frame;
  switch (kind) {
    case ViewKind::side:
      frame << 0, 0, -1, 0, 1, 0, 1, 0, 0;
      break;
    case ViewKind::top:
      frame << 1, 0, 0, 0, 0, -1, 0, 1, 0;
      break;
    default:
      frame.setIdentity();
  }
  return frame;
}

ViewAxis view_axis(const Eigen::Matrix3d& frame, int coordinate) {
  ViewAxis found;
  frame.row(coordinate).cwiseAbs().maxCoeff(&found.axis);
  found.sign = frame(coordinate, found.axis);
  return found;
}

const char* view_name(ViewKind kind) {
  switch (kind) {
    case ViewKind::front:
      return "front";
    case ViewKind::side:
      return "side";
    case ViewKind::top:
      return "top";
    default:
      return "photo";
  }
}

std::vector<const Stroke*> strokes_of(const View& view, StrokeKind kind) {
  std::vector<const Stroke*> found;
  for (const Stroke& stroke : view.strokes) {
    if (stroke.kind == kind) found.push_back(&stroke);
  }
  return found;
}

std::vector<std::string> panels_in(const std::string& text) {
  std::vector<std::string> names;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find('+', begin), text.size());
    std::string name = text.substr(begin, end - begin);
    name.erase(0, std::min(name.find_first_not_of(' '), name.size()));
    name.erase(name.find_last_not_of(' ') + 1);
    if (!name.empty()) names.push_back(name);
    begin = end + 1;
  }
  return names;
}

bool may_meet(const std::vector<std::string>& panels, const std::vector<std::string>& others) {
  return panels.empty() || others.empty() ||
         std::find_first_of(panels.begin(), panels.end(), others.begin(), others.end()) !=
             panels.end();
}

bool bounds(const std::vector<std::string>& panels, const std::string& name) {
  return std::find(panels.begin(), panels.end(), name) != panels.end();
}

bool is_named_flat(const std::string& panel) { return panel.starts_with("flat"); }

bool is_ruling(const Stroke& stroke) {
  return stroke.kind == StrokeKind::ruling || stroke.kind == StrokeKind::silhouette;
}

std::vector<std::string> panels_of(const View& view) {
  std::vector<std::string> names;
  for (const Stroke* border : strokes_of(view, StrokeKind::border)) {
    for (const std::string& name : panels_in(border->name)) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

}  // namespace geoprior::sketch
