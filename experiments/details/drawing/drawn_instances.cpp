#include "experiments/details/drawing/drawn_instances.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "experiments/details/drawing/smooth_normals.h"

namespace geoprior::details {
namespace {

constexpr double kLeastWeight = 1e-3;

/// A closed mesh over the unit disc: rings of `sectors` vertices mapped by `point(s, angle)`, s = 1
/// the rim, and a flat bottom.
template <class Point>
TriMesh over_disc(int sectors, int rings, const Point& point) {
  TriMesh mesh;
  mesh.V.resize(sectors * rings + 2, 3);
  mesh.F.resize(2 * sectors * rings, 3);
  const int top = sectors * rings, bottom = top + 1;
  Eigen::Index t = 0;
  for (int j = 0; j < rings; ++j) {
    const double s = std::sin(0.5 * std::numbers::pi * (j + 1) / rings);
    for (int k = 0; k < sectors; ++k) {
      const int v = j * sectors + k, w = j * sectors + (k + 1) % sectors;
      mesh.V.row(v) = point(s, 2 * std::numbers::pi * k / sectors).transpose();
      if (j == 0) {
        mesh.F.row(t++) << top, v, w;
      } else {
        mesh.F.row(t++) << v - sectors, v, w;
        mesh.F.row(t++) << v - sectors, w, w - sectors;
      }
      if (j + 1 == rings) mesh.F.row(t++) << bottom, w, v;
    }
  }
  mesh.V.row(top) = point(0.0, 0.0).transpose();
  mesh.V.row(bottom).setZero();
  return mesh;
}

/// Flat below and high at its free end, as a scale of skin: an ellipse that is blunt at the root.
Eigen::Vector3d plate_point(double s, double angle) {
  const double x = s * std::cos(angle), y = 0.72 * s * std::sin(angle) * (1 - 0.25 * x);
  const double rise = 0.12 + 0.3 * (0.5 + 0.5 * x);
  return {x + 0.15 * std::max(x, 0.0), y, rise * std::sqrt(std::max(0.0, 1 - s * s))};
}

Eigen::Vector3d knob_point(double s, double angle) {
  return {s * std::cos(angle), s * std::sin(angle), std::sqrt(std::max(0.0, 1 - s * s))};
}

}  // namespace

void describe(OptionVisitor& v, InstanceOptions& o) {
  static constexpr std::array<std::string_view, 3> kShapes{"plate", "knob", "given"};
  describe_choice(v, "shape", o.shape, kShapes,
                  {"mesh of a detail: one of ours, or given by `file`"});
  v.value("sink", o.sink,
          {"depth of the mesh's plane z = 0 below the surface, in radii", "", -1, 1});
}

TriMesh instance_mesh(InstanceShape shape) {
  switch (shape) {
    case InstanceShape::plate:
      return over_disc(20, 5, plate_point);
    case InstanceShape::knob:
      return over_disc(16, 4, knob_point);
    case InstanceShape::given:
      break;
  }
  return {};
}

DrawnDetails draw_instances(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
                            std::span<const DrawnAnchor> anchors, const TriMesh& instance,
                            double radius, double sink) {
  std::vector<int> visible;
  for (int i = 0; i < std::ssize(anchors); ++i)
    if (anchors[i].weight >= kLeastWeight) visible.push_back(i);
  const std::vector<Eigen::Vector3d> up = normals_at(surface, x, anchors);
  const Eigen::MatrixX3d own_normals = vertex_normals(instance);
  const Eigen::Index vertices = instance.V.rows(), triangles = instance.F.rows();
  const Eigen::Index count = visible.size();
  DrawnDetails drawn;
  drawn.mesh.V.resize(count * vertices, 3);
  drawn.normals.resize(count * vertices, 3);
  drawn.mesh.F.resize(count * triangles, 3);
  drawn.detail.resize(count * vertices);
  parallel_blocks(visible.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int detail = visible[i];
      const DrawnAnchor& anchor = anchors[detail];
      const Eigen::Vector3d& n = up[detail];
      Eigen::Vector3d t = anchor.tangent - n * n.dot(anchor.tangent);
      t = t.norm() > 1e-9 * anchor.tangent.norm() ? t.normalized() : n.unitOrthogonal();
      Eigen::Matrix3d turn;
      turn << t, n.cross(t), n;
      const double size = anchor.weight * radius;
      const Eigen::Vector3d at = position_of(anchor.at, surface, x) - sink * size * n;
      const Eigen::Index v = static_cast<Eigen::Index>(i) * vertices;
      const Eigen::Index f = static_cast<Eigen::Index>(i) * triangles;
      drawn.mesh.V.middleRows(v, vertices) =
          (size * instance.V * turn.transpose()).rowwise() + at.transpose();
      drawn.normals.middleRows(v, vertices) = own_normals * turn.transpose();
      drawn.mesh.F.middleRows(f, triangles) = instance.F.array() + static_cast<int>(v);
      std::fill_n(drawn.detail.begin() + v, vertices, detail);
    }
  });
  return drawn;
}

}  // namespace geoprior::details
