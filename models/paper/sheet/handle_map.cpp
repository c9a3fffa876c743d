#include "models/paper/sheet/handle_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::paper {
namespace {

/// Part of a segment's length that is nearest to each of the points on it, so that a load along a
/// line does not depend on where a mesh has its vertices.
std::vector<double> tributary_lengths(const std::vector<double>& along, double length) {
  std::vector<std::size_t> order(along.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return along[a] < along[b]; });
  std::vector<double> lengths(along.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double here = along[order[k]];
    const double before = k == 0 ? 0 : (along[order[k - 1]] + here) / 2;
    const double after = k + 1 == order.size() ? length : (along[order[k + 1]] + here) / 2;
    lengths[order[k]] = after - before;
  }
  return lengths;
}

/// Area of each vertex: a third of its triangles'.
Eigen::VectorXd vertex_areas(const ShellMesh& mesh) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const Eigen::Vector3i v = mesh.triangles.row(t);
    const Eigen::RowVector2d a = mesh.pattern.row(v[0]);
    const Eigen::RowVector2d b = mesh.pattern.row(v[1]) - a;
    const Eigen::RowVector2d c = mesh.pattern.row(v[2]) - a;
    for (const int i : v) areas[i] += (b.x() * c.y() - b.y() * c.x()) / 6;
  }
  return areas;
}

/// Weights that spread a load evenly over the shape of a handle; they sum to 1.
std::vector<double> load_shares(const Handle& handle, const ShellMesh& mesh,
                                const std::vector<int>& vertices) {
  std::vector<double> weights(vertices.size(), 1);
  if (handle.segment) {
    const Eigen::Vector2d start = handle.segment->first;
    const Eigen::Vector2d direction = handle.segment->second - start;
    std::vector<double> along;
    for (const int v : vertices) {
      along.push_back((mesh.pattern.row(v).transpose() - start).dot(direction.normalized()));
    }
    weights = tributary_lengths(along, direction.norm());
  } else if (handle.disc_radius) {
    const Eigen::VectorXd areas = vertex_areas(mesh);
    for (std::size_t i = 0; i < vertices.size(); ++i) weights[i] = areas[vertices[i]];
  }
  double sum = 0;
  for (const double w : weights) sum += w;
  for (double& w : weights) w = sum > 0 ? w / sum : 1 / static_cast<double>(weights.size());
  return weights;
}

/// Angle of the sheet about a vertex (rad).
double angle_about(const ShellMesh& mesh, int vertex) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.triangles(t, k) != vertex) continue;
      const Eigen::Vector2d p = mesh.pattern.row(vertex);
      const Eigen::Vector2d b = mesh.pattern.row(mesh.triangles(t, (k + 1) % 3));
      const Eigen::Vector2d c = mesh.pattern.row(mesh.triangles(t, (k + 2) % 3));
      sum += signed_angle(b - p, c - p);
    }
  }
  return sum;
}

/// A finger holds one lip of a tear that begins under it: the nearer one, and as long as both are
/// one, that with more of the sheet about it. What has fallen off does not come back.
template <class Distance>
void keep_one_lip(const ShellMesh& mesh, std::vector<int>& vertices, const Distance& distance) {
  constexpr double kOne = 1e-6;  // m
  std::vector<int> kept;
  for (const int v : vertices) {
    const auto twin = std::find_if(kept.begin(), kept.end(), [&](int u) {
      return mesh.pattern.row(u) == mesh.pattern.row(v);
    });
    if (twin == kept.end()) {
      kept.push_back(v);
    } else {
      const double nearer = distance(v) - distance(*twin);
      const bool one = std::abs(nearer) <= kOne;
      if (one ? angle_about(mesh, v) > angle_about(mesh, *twin) : nearer < 0) *twin = v;
    }
  }
  vertices = std::move(kept);
}

}  // namespace

HandleMap::HandleMap(const Sheet& sheet, const ShellState& state, std::uint64_t seed) {
  const ShellMesh& mesh = state.mesh;
  for (int h = 0; h < std::ssize(sheet.handles); ++h) {
    const Handle& handle = sheet.handles[h];
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    const std::vector<Eigen::Vector2d> anchors = handle.anchors();
    for (const Eigen::Vector2d& anchor : anchors) centre += sheet.rest_place(anchor, seed);
    centre_.push_back(centre / static_cast<double>(std::max<std::size_t>(1, anchors.size())));
    std::vector<int> vertices;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      if (handle.covers(mesh.pattern.row(v).transpose())) vertices.push_back(v);
    }
    if (!handle.segment && !handle.disc_radius) {
      keep_one_lip(mesh, vertices, [&](int v) {
        const Eigen::Vector3d rest = sheet.rest_place(mesh.pattern.row(v).transpose(), seed);
        const Eigen::Vector3d target = handle.target(rest, centre_.back(), state.time);
        return handle.motion ? (state.x.row(v).transpose() - target).norm() : 0;
      });
    }
    if (vertices.empty()) {
      throw Error("no vertex of the mesh lies on it", "handle '" + handle.name + "'");
    }
    const std::vector<double> shares = load_shares(handle, mesh, vertices);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const int v = vertices[i];
      covered_.push_back(
          {v, h, sheet.rest_place(mesh.pattern.row(v).transpose(), seed), shares[i]});
    }
  }
  std::sort(covered_.begin(), covered_.end(), [](const Covered& a, const Covered& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.handle < b.handle;
  });
}

void HandleMap::targets(const Sheet& sheet, double time, std::vector<Target>& out) const {
  out.clear();
  for (const Covered& c : covered_) {
    const Handle& handle = sheet.handles[c.handle];
    if (handle.force || !handle.is_active(time)) continue;
    if (!out.empty() && out.back().vertex == c.vertex) continue;
    std::optional<double> stiffness;
    if (handle.stiffness) stiffness = c.share * *handle.stiffness;
    out.push_back({c.vertex, c.handle, handle.target(c.rest, centre_[c.handle], time), stiffness});
  }
}

void HandleMap::add_loads(const Sheet& sheet, double time, Eigen::MatrixX3d& forces) const {
  for (const Covered& c : covered_) {
    const Handle& handle = sheet.handles[c.handle];
    if (!handle.force || !handle.is_active(time)) continue;
    forces.row(c.vertex) += c.share * handle.force->transpose();
  }
}

}  // namespace geoprior::paper
