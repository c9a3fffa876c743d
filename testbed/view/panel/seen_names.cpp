#include "testbed/view/panel/seen_names.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "testbed/view/figure/named_values.h"
#include "testbed/view/panel/actors.h"

namespace geoprior {
namespace {

constexpr int kMostCells = 500;        ///< of the buffer along the picture's longer side
constexpr int kLeastCells = 4;         ///< that a thing must show
constexpr double kTowardsEye = 0.004;  ///< of lines towards the eye, of the window's height
constexpr int kNothing = -1;           ///< no thing, or one without a name

/// Things are numbered in the order in which their names are met.
using ThingNumbers = std::map<std::string, int>;

/// What is nearest to the eye in each cell of the picture.
class DepthBuffer {
 public:
  DepthBuffer(const ViewWindow& window, int width_px, int height_px)
      : window_(window),
        cell_((std::max(width_px, height_px) + kMostCells - 1) / kMostCells),
        width_(std::max(1, width_px / cell_)),
        height_(std::max(1, height_px / cell_)),
        scale_(width_px / window.width_m / cell_),
        depth_(static_cast<std::size_t>(width_) * height_,
               -std::numeric_limits<double>::infinity()),
        thing_(depth_.size(), kNothing) {}

  [[nodiscard]] int cell() const { return cell_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int thing(int x, int y) const {
    return x < 0 || y < 0 || x >= width_ || y >= height_ ? kNothing : thing_[index(x, y)];
  }

  /// Cells to the right, cells down, metres towards the eye.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = point - window_.center;
    return {width_ / 2.0 + scale_ * p.dot(window_.right),
            height_ / 2.0 - scale_ * p.dot(window_.up), p.dot(window_.direction)};
  }

  void put(int x, int y, double depth, int thing) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_ || !(depth > depth_[index(x, y)])) return;
    depth_[index(x, y)] = depth;
    thing_[index(x, y)] = thing;
  }

  void put_triangle(const std::array<Eigen::Vector3d, 3>& corners, int thing) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& corner : corners) {
      if (!corner.allFinite()) return;
      box.extend(corner.head<2>());
    }
    Eigen::Matrix3d plane;  // of the corners in homogeneous coordinates: weights of a cell's centre
    for (int k = 0; k < 3; ++k) plane.col(k) << corners[k].x(), corners[k].y(), 1;
    if (std::abs(plane.determinant()) < 1e-12) return;
    const Eigen::Matrix3d weights = plane.inverse();
    const Eigen::Vector3d depths(corners[0].z(), corners[1].z(), corners[2].z());
    for (int y = first(box.min().y()); y <= last(box.max().y(), height_); ++y) {
      for (int x = first(box.min().x()); x <= last(box.max().x(), width_); ++x) {
        const Eigen::Vector3d w = weights * Eigen::Vector3d(x + 0.5, y + 0.5, 1);
        if (w.minCoeff() >= 0) put(x, y, w.dot(depths), thing);
      }
    }
  }

  void put_segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int thing) {
    const double steps = std::ceil(2 * (to - from).head<2>().norm());
    if (!(steps < 4.0 * (width_ + height_))) return;  // far outside, or not finite
    for (double i = 0; i <= steps; ++i) {
      const Eigen::Vector3d p = from + (steps > 0 ? i / steps : 0) * (to - from);
      put(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
          p.z() + kTowardsEye * window_.height_m, thing);
    }
  }

  void put_ball(const Eigen::Vector3d& center, double radius_m, int thing) {
    if (!center.allFinite()) return;
    const double radius = scale_ * radius_m;
    for (int y = first(center.y() - radius); y <= last(center.y() + radius, height_); ++y) {
      for (int x = first(center.x() - radius); x <= last(center.x() + radius, width_); ++x) {
        const double r = std::hypot(x + 0.5 - center.x(), y + 0.5 - center.y()) / radius;
        if (r <= 1) put(x, y, center.z() + radius_m * std::sqrt(1 - r * r), thing);
      }
    }
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * width_ + x;
  }
  static int first(double low) { return static_cast<int>(std::clamp(low, 0.0, 1e6)); }
  static int last(double high, int size) {
    return static_cast<int>(std::clamp(high, -1.0, size - 1.0));
  }

  const ViewWindow& window_;
  int cell_, width_, height_;
  double scale_;  ///< cells a metre
  std::vector<double> depth_;
  std::vector<int> thing_;
};

/// The things that the elements of a part are.
class Things {
 public:
  Things(const Part& part, const std::string& array, ThingNumbers& numbers)
      : array_(named_array(part, array)) {
    if (array_ == nullptr) return;
    for (const std::string& name : array_->names)
      of_code_.push_back(numbers.emplace(name, static_cast<int>(numbers.size())).first->second);
  }

  /// Of a cell; an array over points says it by one of the cell's points.
  [[nodiscard]] int of(Eigen::Index cell, Eigen::Index point) const {
    if (array_ == nullptr) return kNothing;
    const double code = array_->values(array_->on == NamedArray::On::cells ? cell : point, 0);
    if (!(code >= 0 && code < static_cast<double>(of_code_.size()))) return kNothing;
    return of_code_[static_cast<std::size_t>(code)];
  }

 private:
  const NamedArray* array_;
  std::vector<int> of_code_;
};

void put_part(const Part& part, const Things& things, double ball_m, DepthBuffer& buffer) {
  if (part.kind == Part::Kind::grid) return;
  std::vector<Eigen::Vector3d> points;
  for (const auto& point : part.points.rowwise()) points.push_back(buffer.project(point));
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    const auto corners = part.triangles.row(t);
    buffer.put_triangle({points[corners[0]], points[corners[1]], points[corners[2]]},
                        things.of(t, corners[0]));
  }
  for (int l = 0; l < std::ssize(part.lines); ++l) {
    const std::vector<int>& line = part.lines[l];
    for (std::size_t i = 1; i < line.size(); ++i)
      buffer.put_segment(points[line[i - 1]], points[line[i]], things.of(l, line[i]));
  }
  if (part.kind != Part::Kind::points) return;
  for (int i = 0; i < std::ssize(points); ++i) buffer.put_ball(points[i], ball_m, things.of(i, i));
}

using Cell = Eigen::Vector2i;

/// Connected cells of one thing.
struct SeenPiece {
  int thing = kNothing;
  std::vector<Cell> cells;
};

/// Cells touch by sides or corners.
std::vector<SeenPiece> pieces_of(const DepthBuffer& buffer) {
  std::vector<SeenPiece> pieces;
  std::vector<char> known(static_cast<std::size_t>(buffer.width()) * buffer.height());
  const auto take = [&](const Cell& cell, SeenPiece& piece) {
    if (buffer.thing(cell.x(), cell.y()) != piece.thing) return;
    char& seen = known[static_cast<std::size_t>(cell.y()) * buffer.width() + cell.x()];
    if (seen != 0) return;
    seen = 1;
    piece.cells.push_back(cell);
  };
  for (int y = 0; y < buffer.height(); ++y) {
    for (int x = 0; x < buffer.width(); ++x) {
      SeenPiece piece{buffer.thing(x, y), {}};
      if (piece.thing == kNothing) continue;
      take({x, y}, piece);
      for (std::size_t i = 0; i < piece.cells.size(); ++i) {
        const Cell cell = piece.cells[i];
        for (int n = 0; n < 9; ++n) take(cell + Cell(n % 3 - 1, n / 3 - 1), piece);
      }
      if (!piece.cells.empty()) pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

/// The cell of the piece nearest to its centroid, not on its border unless all are.
Eigen::Vector2d inner_point(const SeenPiece& piece, const DepthBuffer& buffer) {
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  for (const Cell& cell : piece.cells) centroid += cell.cast<double>();
  centroid /= static_cast<double>(piece.cells.size());
  const auto is_inner = [&](const Cell& c) {
    return buffer.thing(c.x() - 1, c.y()) == piece.thing &&
           buffer.thing(c.x() + 1, c.y()) == piece.thing &&
           buffer.thing(c.x(), c.y() - 1) == piece.thing &&
           buffer.thing(c.x(), c.y() + 1) == piece.thing;
  };
  const auto rank = [&](const Cell& cell) {
    return std::pair(!is_inner(cell), (cell.cast<double>() - centroid).squaredNorm());
  };
  const Cell best =
      *std::min_element(piece.cells.begin(), piece.cells.end(),
                        [&](const Cell& a, const Cell& b) { return rank(a) < rank(b); });
  return buffer.cell() * (best.cast<double>() + Eigen::Vector2d(0.5, 0.5));
}

}  // namespace

std::vector<SeenName> seen_names(const PanelParts& parts, const ViewWindow& window,
                                 const std::string& array, int width_px, int height_px) {
  DepthBuffer buffer(window, width_px, height_px);
  ThingNumbers numbers;
  const double ball_m = overlay_ball_radius(window);
  for (const Part* part : parts.parts)
    put_part(*part, Things(*part, array, numbers), ball_m, buffer);
  for (const PanelOverlay& overlay : parts.overlays)
    put_part(*overlay.part, Things(*overlay.part, array, numbers), ball_m, buffer);
  std::vector<SeenName> seen(numbers.size());
  std::vector<std::size_t> largest(numbers.size(), 0);
  const double pixels_a_cell = buffer.cell() * buffer.cell();
  for (const auto& [name, number] : numbers) seen[number].name = name;
  for (const SeenPiece& piece : pieces_of(buffer)) {
    SeenName& thing = seen[piece.thing];
    thing.pixels += pixels_a_cell * static_cast<double>(piece.cells.size());
    if (piece.cells.size() <= largest[piece.thing]) continue;
    largest[piece.thing] = piece.cells.size();
    thing.at = inner_point(piece, buffer);
  }
  std::erase_if(seen,
                [&](const SeenName& thing) { return thing.pixels < kLeastCells * pixels_a_cell; });
  return seen;
}

}  // namespace geoprior
