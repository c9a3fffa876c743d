#include "baselines/sketch/frustum_formula.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/frame_loop.h"
#include "models/sketch/drawing/ellipse_fit.h"

namespace geoprior::sketch {
namespace {

/// Tilt (rad) below which depth is not determined: both circles are seen along the axis.
constexpr double kLeastTilt = 1e-3;

struct DrawnEllipse {
  int stroke;
  Ellipse ellipse;
};

std::vector<DrawnEllipse> drawn_ellipses(const View& view) {
  std::vector<DrawnEllipse> drawn;
  const bool arcs = !strokes_of(view, StrokeKind::arc).empty();
  for (int i = 0; i < std::ssize(view.strokes); ++i) {
    const Stroke& stroke = view.strokes[i];
    const bool rim =
        arcs ? stroke.kind == StrokeKind::arc : stroke.kind == StrokeKind::border && stroke.closed;
    if (!rim) continue;
    const EllipseFit fit = fit_ellipse(stroke.points, "stroke '" + stroke.id + "'");
    drawn.push_back({i, fit.ellipse});
  }
  if (drawn.size() < 2) {
    throw Error("has " + std::to_string(drawn.size()) + " circles", "view:photo",
                "two or more arcs or closed borders");
  }
  return drawn;
}

double tilt(const Ellipse& ellipse) {
  return std::acos(std::min(ellipse.minor / ellipse.major, 1.0));
}

/// Axis with the ellipse's tilt, along its minor axis on the side of `forwards`.
Eigen::Vector3d axis_along(const Ellipse& ellipse, const Eigen::Vector2d& forwards, double depth) {
  Eigen::Vector2d minor(-ellipse.direction.y(), ellipse.direction.x());
  if (minor.dot(forwards) < 0) minor = -minor;
  const double phi = tilt(ellipse);
  const Eigen::Vector2d in_picture = std::sin(phi) * minor;
  return {in_picture.x(), in_picture.y(), depth * std::cos(phi)};
}

/// The picture's point on the circle's plane.
Eigen::Vector3d on_plane(const EllipseCircle& circle, const Eigen::Vector2d& p) {
  const Eigen::Vector2d d = p - circle.centre.head<2>();
  const double z = circle.centre.z() - circle.axis.head<2>().dot(d) / circle.axis.z();
  return {p.x(), p.y(), z};
}

Part formula_strokes(const std::vector<EllipseCircle>& circles, const View& view) {
  Part part;
  part.kind = Part::Kind::lines;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> stroke, drawn_at;
  for (const EllipseCircle& circle : circles) {
    std::vector<int> line;
    for (std::size_t i = 0; i < circle.points.size(); ++i) {
      line.push_back(static_cast<int>(points.size()));
      points.push_back(circle.points[i]);
      stroke.push_back(circle.stroke);
      drawn_at.push_back(static_cast<double>(i));
    }
    if (view.strokes[circle.stroke].closed) line.push_back(line.front());
    part.lines.push_back(std::move(line));
  }
  const Eigen::Index n = points.size();
  part.points.resize(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) part.points.row(i) = points[i].transpose();
  using On = NamedArray::On;
  part.arrays = {{"stroke", "1", On::points, Eigen::Map<Eigen::VectorXd>(stroke.data(), n)},
                 {"drawn_at", "1", On::points, Eigen::Map<Eigen::VectorXd>(drawn_at.data(), n)}};
  return part;
}

/// Strips between points of one circle and the next at equal shares of their strokes.
Part formula_surface(const std::vector<EllipseCircle>& circles, int around) {
  const int row = around + 1, rows = static_cast<int>(circles.size());
  Part part;
  part.points.resize(Eigen::Index{row} * rows, 3);
  part.triangles.resize(Eigen::Index{2} * around * (rows - 1), 3);
  for (int r = 0; r < rows; ++r) {
    const std::vector<Eigen::Vector3d>& points = circles[r].points;
    for (int k = 0; k <= around; ++k) {
      const double at = static_cast<double>(points.size() - 1) * k / around;
      const auto i = std::min(static_cast<std::size_t>(at), points.size() - 2);
      const double share = at - static_cast<double>(i);
      part.points.row(Eigen::Index{r} * row + k) =
          ((1 - share) * points[i] + share * points[i + 1]).transpose();
    }
  }
  Eigen::Index t = 0;
  for (int r = 0; r + 1 < rows; ++r) {
    for (int k = 0; k < around; ++k) {
      const int a = r * row + k, b = a + 1, c = a + row, d = c + 1;
      part.triangles.row(t++) << a, b, c;
      part.triangles.row(t++) << b, d, c;
    }
  }
  for (const char* name : {"border", "seam", "fold"}) {
    part.arrays.push_back(
        {name, "1", NamedArray::On::points, Eigen::MatrixXd::Zero(part.points.rows(), 1)});
  }
  return part;
}

class FrustumFormula final : public FrameModel {
 public:
  FrustumFormula(const View& view, const FrustumFormulaOptions& options)
      : view_(view), options_(options) {}
  [[nodiscard]] int frame_count() const override { return 1; }
  void record(int /*number*/, FrameSink& sink, RunContext& context) override {
    std::vector<EllipseCircle> circles;
    {
      const Phase phase(context, "reconstruct");
      circles = frustum_formula(view_, options_);
    }
    const Phase phase(context, "record");
    Frame frame;
    frame.parts["surface"] = formula_surface(circles, options_.around);
    frame.parts["strokes"] = formula_strokes(circles, view_);
    sink.frame(std::move(frame));
  }

 private:
  const View& view_;  ///< of the process, which outlives its model
  FrustumFormulaOptions options_;
};

}  // namespace

void describe(OptionVisitor& v, FrustumFormulaOptions& options) {
  static constexpr std::array<std::string_view, 2> kReadings{"towards", "away"};
  describe_choice(v, "reading", options.reading, kReadings,
                  {.doc = "where the body's axis points, which one picture cannot tell"});
  v.value("around", options.around, {.doc = "segments of a rim", .min = 8, .max = 2000});
}

std::vector<EllipseCircle> frustum_formula(const View& view, const FrustumFormulaOptions& options) {
  const std::vector<DrawnEllipse> drawn = drawn_ellipses(view);
  const double depth = options.reading == FrustumReading::towards ? 1 : -1;
  std::vector<EllipseCircle> circles;
  double z = 0;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const Ellipse& ellipse = drawn[k].ellipse;
    if (k > 0) {
      const Ellipse& before = drawn[k - 1].ellipse;
      const double phi = (tilt(before) + tilt(ellipse)) / 2;
      if (!(phi > kLeastTilt)) {
        throw Error("circles are seen along their axis, and depth is not determined",
                    "stroke '" + view.strokes[drawn[k].stroke].id + "'", "a view from the side");
      }
      z += depth * (ellipse.centre - before.centre).norm() / std::tan(phi);
    }
    const std::size_t next = std::min(k + 1, drawn.size() - 1), last = k > 0 ? k - 1 : 0;
    EllipseCircle circle;
    circle.stroke = drawn[k].stroke;
    circle.centre = {ellipse.centre.x(), ellipse.centre.y(), z};
    circle.axis =
        axis_along(ellipse, drawn[next].ellipse.centre - drawn[last].ellipse.centre, depth);
    circle.radius = ellipse.major;
    for (const Eigen::Vector2d& p : view.strokes[circle.stroke].points) {
      const Eigen::Vector2d foot = ellipse.point(ellipse.anomaly(p));
      circle.points.push_back(on_plane(circle, foot));
    }
    circles.push_back(std::move(circle));
  }
  return circles;
}

std::unique_ptr<Process> make_frustum_formula_process(const View& view,
                                                      const FrustumFormulaOptions& options) {
  return frame_process(
      [view, options](RunContext&) { return std::make_unique<FrustumFormula>(view, options); });
}

}  // namespace geoprior::sketch
