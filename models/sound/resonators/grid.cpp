#include "models/sound/resonators/grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/mesh.h"
#include "models/paper/sheet/pattern_locator.h"
#include "models/sound/resonators/remeshing.h"

namespace geoprior::sound {

using Eigen::Vector2d;

SoundGrid sound_grid(const Pattern& pattern, double spacing) {
  const Eigen::AlignedBox2d box = bounding_box(pattern);
  constexpr double kMostCells = 1 << 22;
  const Vector2d size = box.sizes();
  if (!(spacing > 0) || spacing > size.minCoeff() ||
      size.x() / spacing * (size.y() / spacing) > kMostCells) {
    throw Error("cells of " + std::to_string(spacing) + " m do not fit the pattern", "spacing",
                "wide enough for 4 million cells, and no wider than the pattern");
  }
  SoundGrid grid;
  grid.spacing = spacing;
  grid.columns = static_cast<int>(std::ceil(size.x() / spacing - 1e-9));
  grid.rows = static_cast<int>(std::ceil(size.y() / spacing - 1e-9));
  // Centred: a symmetric sheet is seen symmetrically.
  grid.corner = box.center() - spacing / 2 * Vector2d(grid.columns, grid.rows);
  grid.inside.resize(grid.count());
  for (int c = 0; c < grid.count(); ++c) {
    grid.inside[c] = contains(pattern, grid.centre(c)) ? 1 : 0;
  }
  return grid;
}

int SoundGrid::at(const Vector2d& p) const {
  const Vector2d q = (p - corner) / spacing;
  return cell(std::clamp(static_cast<int>(std::floor(q.x())), 0, columns - 1),
              std::clamp(static_cast<int>(std::floor(q.y())), 0, rows - 1));
}

std::array<int, 4> SoundGrid::neighbours(int c) const {
  const int column = c % columns, row = c / columns;
  return {column + 1 < columns ? c + 1 : -1, row + 1 < rows ? c + columns : -1,
          column > 0 ? c - 1 : -1, row > 0 ? c - columns : -1};
}

bool SheetField::holds(const SoundGrid& grid, int cell, int side) const {
  const int other = grid.neighbours(cell)[side];
  if (other < 0) return false;
  const std::size_t first = side < 2 ? cell : other;
  return joined[first][side % 2] != 0;
}

/// What depends on the mesh in the pattern alone.
struct SheetSampler::Cover {
  ShellMesh mesh;
  CurvatureFit fit;
  std::vector<paper::PatternLocator::Place> at;  ///< centres of the cells; triangle -1: outside
  std::vector<std::array<char, 2>> joined;
  std::vector<BorderStretch> border;
  /// Of each cell the ones after and before it, itself where the sheet does not hold.
  using Beside = std::vector<std::array<int, 2>>;
  std::array<Beside, 2> beside;  ///< along the rows, along the columns
};

namespace {

constexpr double kOnTriangle = -1e-9;  // barycentric

/// The triangle at the centre of a cell, or the nearest one where the mesh cuts a corner of the
/// pattern; none where the mesh leaves that part of the pattern out.
paper::PatternLocator::Place place_in_mesh(const SoundGrid& grid, const ShellMesh& mesh,
                                           const paper::PatternLocator& locator, int cell,
                                           int guess) {
  constexpr double kBeside = 0.4;  // of a cell
  const paper::PatternLocator::Place at = locator.locate(grid.centre(cell), guess);
  Vector2d there(0, 0);
  for (int k = 0; k < 3; ++k) {
    there += at.weights[k] * mesh.pattern.row(mesh.triangles(at.triangle, k)).transpose();
  }
  if ((there - grid.centre(cell)).norm() > kBeside * grid.spacing) return {};
  return at;
}

/// Which cells have a triangle at their centre, and which hold together over it.
void join_cells(const SoundGrid& grid, const paper::PatternLocator& locator,
                const std::vector<paper::PatternLocator::Place>& at,
                std::vector<std::array<char, 2>>& joined) {
  joined.assign(at.size(), {0, 0});
  for (int c = 0; c < grid.count(); ++c) {
    if (at[c].triangle < 0) continue;
    const std::array<int, 4> beside = grid.neighbours(c);
    for (std::size_t side = 0; side < 2; ++side) {
      if (beside[side] < 0) continue;
      const int other = at[beside[side]].triangle;
      if (other < 0) continue;
      joined[c][side] = 1;
      if (other == at[c].triangle) continue;
      const auto end = locator.locate(grid.centre(beside[side]), grid.centre(c), at[c].triangle);
      joined[c][side] = end.weights.minCoeff() >= kOnTriangle ? 1 : 0;
    }
  }
}

/// The cell of the sheet whose centre is nearest to a place of the border, on the side of the
/// triangle there; -1 when none is within two cells.
int bounded_cell(const SoundGrid& grid, const std::vector<paper::PatternLocator::Place>& at,
                 const Vector2d& place, const Vector2d& inwards) {
  const int middle = grid.at(place + 0.25 * grid.spacing * inwards);
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      const int column = middle % grid.columns + du, row = middle / grid.columns + dv;
      if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) continue;
      const int c = grid.cell(column, row);
      if (at[c].triangle < 0) continue;
      const Vector2d way = grid.centre(c) - place;
      if (way.dot(inwards) < 0) continue;
      if (way.norm() >= least) continue;
      least = way.norm();
      best = c;
    }
  }
  return best;
}

std::vector<BorderStretch> border_of(const SoundGrid& grid, const ShellMesh& mesh,
                                     const std::vector<paper::PatternLocator::Place>& at) {
  std::vector<BorderStretch> border;
  const EdgeConnectivity connectivity(mesh.triangles);
  for (int h = 0; h < connectivity.half_edge_count(); ++h) {
    if (connectivity.twin(h) >= 0) continue;
    const Vector2d a = mesh.pattern.row(connectivity.origin(h));
    const Vector2d b = mesh.pattern.row(connectivity.tip(h));
    const double length = (b - a).norm();
    const Vector2d along = (b - a) / length, inwards(-along.y(), along.x());
    const int pieces = std::max(1, static_cast<int>(std::ceil(2 * length / grid.spacing)));
    for (int i = 0; i < pieces; ++i) {
      const Vector2d place = a + (i + 0.5) / pieces * (b - a);
      const int cell = bounded_cell(grid, at, place, inwards);
      if (cell >= 0) border.push_back({cell, length / pieces, place});
    }
  }
  return border;
}

bool same(const ShellMesh& a, const ShellMesh& b) {
  return a.pattern.rows() == b.pattern.rows() && a.pattern == b.pattern &&
         same_triangles(a.triangles, b.triangles);
}

/// Direction of the eigenvector whose eigenvalue is smaller in modulus: mean - radius for a
/// positive mean of both.
Vector2d least_bent(const Eigen::RowVector3d& S) {
  const double mean = (S[0] + S[2]) / 2;
  const double largest = std::atan2(2 * S[1], S[0] - S[2]) / 2;
  const double angle = mean >= 0 ? largest + std::numbers::pi / 2 : largest;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

SheetSampler::SheetSampler(SoundGrid grid, double radius) : grid_(std::move(grid)) {
  if (!(radius >= 0)) throw Error("is negative", "radius", "0 or more");
  const double cells = radius / grid_.spacing;
  passes_ = static_cast<int>(std::lround(3 * cells * cells));
}

const SheetSampler::Cover& SheetSampler::cover_of(const ShellMesh& mesh) {
  if (cover_ && same(cover_->mesh, mesh)) return *cover_;
  auto cover = std::make_shared<Cover>();
  cover->mesh = mesh;
  cover->fit = fit_curvature(mesh.pattern, mesh.triangles);
  const paper::PatternLocator locator(mesh);
  cover->at.resize(grid_.count());
  int last = -1;
  for (int c = 0; c < grid_.count(); ++c) {
    if (!grid_.inside[c]) continue;
    cover->at[c] = place_in_mesh(grid_, mesh, locator, c, last);
    last = cover->at[c].triangle;
  }
  join_cells(grid_, locator, cover->at, cover->joined);
  cover->border = border_of(grid_, mesh, cover->at);
  for (const std::size_t axis : {0, 1}) {
    const int step = axis == 0 ? 1 : grid_.columns;
    const auto holds = [&](int c) { return cover->joined[c][axis] != 0; };
    for (int c = 0; c < grid_.count(); ++c) {
      cover->beside[axis].push_back(
          {holds(c) ? c + step : c, c >= step && holds(c - step) ? c - step : c});
    }
  }
  cover_ = std::move(cover);
  return *cover_;
}

/// One pass is the mask (1 4 1)/6 along the rows, then along the columns; a neighbour that the
/// sheet does not hold together with counts as the cell itself.
void SheetSampler::smooth(const Cover& cover, Eigen::MatrixX3d& S) const {
  Eigen::VectorXd next(S.rows());
  for (Eigen::Index component = 0; component < 3; ++component) {
    for (int pass = 0; pass < passes_; ++pass) {
      for (const Cover::Beside& beside : cover.beside) {
        const double* s = S.col(component).data();
        for (std::size_t c = 0; c < beside.size(); ++c) {
          next[c] = (4 * s[c] + s[beside[c][0]] + s[beside[c][1]]) / 6;
        }
        S.col(component) = next;
      }
    }
  }
}

/// Cells whose own triangle was not kept or whose neighbours are others, and all to which smoothing
/// carries what is read there.
std::vector<char> SheetSampler::remeshed_cells(const Cover& before, const Cover& now) const {
  const std::vector<int> kept = kept_triangles({before.mesh, before.fit}, {now.mesh, now.fit});
  std::vector<char> changed(grid_.count(), 0), next(grid_.count());
  for (int c = 0; c < grid_.count(); ++c) {
    const int triangle = now.at[c].triangle, was = before.at[c].triangle;
    const bool same = triangle < 0 ? was < 0 : kept[triangle] >= 0 && kept[triangle] == was;
    const bool joins =
        before.beside[0][c] == now.beside[0][c] && before.beside[1][c] == now.beside[1][c];
    changed[c] = same && joins ? 0 : 1;
  }
  for (int pass = 0; pass < passes_; ++pass) {
    for (const Cover::Beside& beside : now.beside) {
      for (std::size_t c = 0; c < beside.size(); ++c) {
        next[c] = changed[c] | changed[beside[c][0]] | changed[beside[c][1]];
      }
      changed.swap(next);
    }
  }
  return changed;
}

SheetField SheetSampler::sample(const SheetSnapshot& frame) {
  require_valid(frame, "frame at " + std::to_string(frame.time) + " s");
  const std::shared_ptr<const Cover> before = cover_;
  const Cover& cover = cover_of(frame.mesh);
  const int n = grid_.count();
  SheetField field;
  field.time = frame.time;
  field.joined = cover.joined;
  field.border = cover.border;
  field.remeshed.assign(n, 0);
  if (before && before != cover_) field.remeshed = remeshed_cells(*before, cover);
  field.inside.assign(n, 0);
  field.place = field.velocity = field.normal = Eigen::MatrixX3d::Zero(n, 3);
  field.curvature = Eigen::VectorXd::Zero(n);
  field.ruling = Eigen::MatrixX2d::Zero(n, 2);
  const Eigen::MatrixX3d shape = shape_operators(cover.fit, frame.x);
  Eigen::MatrixX3d S = Eigen::MatrixX3d::Zero(n, 3);
  const bool moves = frame.v.rows() == frame.x.rows();
  for (int c = 0; c < n; ++c) {
    const paper::PatternLocator::Place& at = cover.at[c];
    if (at.triangle < 0) continue;
    field.inside[c] = 1;
    S.row(c) = shape.row(at.triangle);
    const Eigen::RowVector3i t = frame.mesh.triangles.row(at.triangle);
    const Eigen::Vector3d p = frame.x.row(t[0]), q = frame.x.row(t[1]), r = frame.x.row(t[2]);
    field.place.row(c) = at.weights[0] * p + at.weights[1] * q + at.weights[2] * r;
    field.normal.row(c) = (q - p).cross(r - p).normalized();
    for (int k = 0; moves && k < 3; ++k) {
      field.velocity.row(c) += at.weights[k] * frame.v.row(t[k]);
    }
  }
  smooth(cover, S);
  for (int c = 0; c < n; ++c) {
    if (!field.inside[c]) continue;
    field.curvature[c] = S(c, 0) + S(c, 2);
    field.ruling.row(c) = least_bent(S.row(c));
  }
  if (!moves && last_) {
    field.velocity = (field.place - last_->place) / (field.time - last_->time);
  }
  last_ = field;
  return field;
}

}  // namespace geoprior::sound
