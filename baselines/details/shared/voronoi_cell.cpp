#include "baselines/details/shared/voronoi_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/planar.h"

namespace geoprior::details {
namespace {

/// Angle between the first and the last edge of the triangle of `h` at its origin.
double angle_at(const IntrinsicTriangulation& mesh, int h) {
  const double a = mesh.length(h), b = mesh.length(IntrinsicTriangulation::previous(h));
  const double c = mesh.length(IntrinsicTriangulation::next(h));
  return std::acos(std::clamp((a * a + b * b - c * c) / (2 * a * b), -1.0, 1.0));
}

double height_of(const IntrinsicTriangulation& mesh, int t) {
  const double longest =
      std::max({mesh.length(3 * t), mesh.length(3 * t + 1), mesh.length(3 * t + 2)});
  return 2 * mesh.area(t) / longest;
}

}  // namespace

void CellChart::lay_out(const DetailMesh& d, int site) {
  site_ = site;
  ring_.clear();
  least_height_ = std::numeric_limits<double>::infinity();
  angle_.clear();
  double turn = 0;
  const int start = d.mesh.outgoing(site);
  for (int h = start;;) {
    const double here = angle_at(d.mesh, h);
    angle_.push_back(here);
    turn += here;
    ring_.push_back({h, d.mesh.tip(h), {d.mesh.length(h), 0}});
    least_height_ = std::min(least_height_, height_of(d.mesh, h / 3));
    h = d.mesh.twin(IntrinsicTriangulation::previous(h));
    if (h == start || h < 0) break;
  }
  double sum = 0;
  const double scale = 2 * std::numbers::pi / turn;
  for (std::size_t k = 0; k < ring_.size(); ++k) {
    const double length = ring_[k].at.x();
    ring_[k].at = length * Eigen::Vector2d(std::cos(scale * sum), std::sin(scale * sum));
    sum += angle_[k];
  }
}

/// Keeps what lies on the side normal . x <= offset.
void CellChart::cut(const Eigen::Vector2d& normal, double offset, int across) {
  kept_.clear();
  for (std::size_t k = 0; k < corner_.size(); ++k) {
    const Corner &a = corner_[k], &b = corner_[(k + 1) % corner_.size()];
    const double out_a = normal.dot(a.at) - offset, out_b = normal.dot(b.at) - offset;
    if (out_a <= 0) kept_.push_back(a);
    if ((out_a <= 0) == (out_b <= 0)) continue;
    const Eigen::Vector2d crossing = a.at + (b.at - a.at) * (out_a / (out_a - out_b));
    // Leaving the kept side, the boundary goes on along the cut.
    kept_.push_back({crossing, out_a <= 0 ? across : a.across});
  }
  corner_.swap(kept_);
}

/// Along the border from neighbour k to the next one. At the ends of a run of ghosts the border
/// begins to be nearer to another detail: cut there by the bisector to it when it is a neighbour;
/// when a third one lies between (the ghost has three details around), across the border.
void CellChart::cut_by_border(const DetailMesh& d, std::size_t k, bool run_before, bool run_after) {
  const std::size_t n = ring_.size();
  const Eigen::Vector2d& p = ring_[k].at;
  const auto cut_away = [&](const Eigen::Vector2d& normal) {
    if (normal.dot(p) > 0) cut(normal, normal.dot(p), -1);
  };
  const Eigen::Vector2d to_next = ring_[(k + 1) % n].at - p;
  if (run_after) cut_away({to_next.y(), -to_next.x()});
  if (run_before && run_after) return;
  d.mesh.neighbours(ring_[k].neighbour, around_);
  if (std::count_if(around_.begin(), around_.end(), [&](int j) { return d.is_detail(j); }) < 3)
    return;
  if (run_after)
    cut_away(-to_next);
  else
    cut_away(run_before ? Eigen::Vector2d(p - ring_[(k + n - 1) % n].at) : p);
}

void CellChart::cut_by_neighbours(const DetailMesh& d) {
  const std::size_t n = ring_.size();
  const auto on_border = [&](std::size_t k) {
    const int site = ring_[k % n].neighbour;
    return !d.is_detail(site) && d.mesh.border_vertex(site);
  };
  for (std::size_t k = 0; k < n; ++k) {
    if (d.is_detail(ring_[k].neighbour))
      cut(ring_[k].at, ring_[k].at.squaredNorm() / 2, ring_[k].neighbour);
    else if (on_border(k))
      cut_by_border(d, k, on_border(k + n - 1), on_border(k + 1));
  }
}

VoronoiCell CellChart::cell(const DetailMesh& d, const std::vector<double>& spacing) {
  const double most = 2 * kBareRadius * spacing[site_];
  corner_ = {{{-most, -most}, -1}, {{most, -most}, -1}, {{most, most}, -1}, {{-most, most}, -1}};
  cut_by_neighbours(d);
  return integrate(spacing);
}

/// Density between corners is linear, that of a corner the mean over the details it is equally near
/// to; a fan of triangles around the detail.
VoronoiCell CellChart::integrate(const std::vector<double>& spacing) const {
  const auto density = [&](int site) { return 1 / (spacing[site] * spacing[site]); };
  const auto weight = [&](std::size_t k) {
    double sum = density(site_);
    int known = 1;
    for (const int j :
         {corner_[k].across, corner_[(k + corner_.size() - 1) % corner_.size()].across})
      if (j >= 0) {
        sum += density(j);
        ++known;
      }
    return sum * sum / (known * known);
  };
  VoronoiCell cell;
  double mass = 0;
  const double here = density(site_) * density(site_);
  for (std::size_t k = 0; k < corner_.size(); ++k) {
    const std::size_t next = (k + 1) % corner_.size();
    const Eigen::Vector2d &p = corner_[k].at, &q = corner_[next].at;
    const double area = cross(p, q) / 2, at_p = weight(k), at_q = weight(next);
    const double all = here + at_p + at_q;
    cell.area += area;
    mass += area * all / 3;
    cell.centroid += area / 12 * ((at_p + all) * p + (at_q + all) * q);
    cell.reach = std::max(cell.reach, p.norm());
  }
  cell.centroid = mass > 0 ? Eigen::Vector2d(cell.centroid / mass) : Eigen::Vector2d::Zero();
  return cell;
}

std::optional<MeshPoint> CellChart::point_at(const Eigen::Vector2d& place) const {
  for (std::size_t k = 0; k < ring_.size(); ++k) {
    const Eigen::Vector2d &p = ring_[k].at, &q = ring_[(k + 1) % ring_.size()].at;
    const double whole = cross(p, q), along_p = cross(place, q), along_q = cross(p, place);
    if (!(whole > 0) || along_p < 0 || along_q < 0 || along_p + along_q > whole) continue;
    const int h = ring_[k].half_edge;
    MeshPoint found{h / 3, Eigen::Vector3d::Zero()};
    found.barycentric[h % 3] = 1 - (along_p + along_q) / whole;
    found.barycentric[(h + 1) % 3] = along_p / whole;
    found.barycentric[(h + 2) % 3] = along_q / whole;
    return found;
  }
  return {};
}

}  // namespace geoprior::details
