#define CGAL_EIGEN3_ENABLED 1

#include "baselines/sketch/flatten/cgal_flatten.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Error_code.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "models/sketch/flatten/flat_triangles.h"
#include "models/sketch/pattern/piece_borders.h"
#include "models/sketch/surface/cut_surface.h"

namespace geoprior::sketch {
namespace {

namespace smp = CGAL::Surface_mesh_parameterization;
using CgalKernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

CgalMesh to_cgal(const TriMesh& mesh) {
  CgalMesh result;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v)
    result.add_vertex(CgalKernel::Point_3(mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2)));
  const auto vertex = [](int v) {
    return CgalMesh::Vertex_index(static_cast<CgalMesh::size_type>(v));
  };
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t)
    result.add_face(vertex(mesh.F(t, 0)), vertex(mesh.F(t, 1)), vertex(mesh.F(t, 2)));
  return result;
}

/// CGAL's own table of messages lacks one entry.
std::string cgal_message(smp::Error_code code) {
  switch (code) {
    case smp::ERROR_CANNOT_SOLVE_LINEAR_SYSTEM:
      return "the linear system cannot be solved";
    case smp::ERROR_NO_1_TO_1_MAPPING:
      return "the map is not one to one";
    case smp::ERROR_BORDER_TOO_SHORT:
      return "the border is too short";
    default:
      return "error " + std::to_string(static_cast<int>(code));
  }
}

/// Twice the area over the square of the longest edge, below which a triangle is a line: weights of
/// cotangents and tangents divide by it.
constexpr double kFlat = 1e-12;

/// A triangle without area at the border, whose corner `vertex` no other triangle has: it lies on
/// the line through `a` and `b`, at a + t (b - a).
struct FlatEar {
  int vertex = 0, a = 0, b = 0;
  double t = 0;
};

std::optional<FlatEar> flat_ear(const TriMesh& mesh, Eigen::Index t,
                                const std::vector<int>& triangles_of) {
  const Eigen::RowVector3i f = mesh.F.row(t);
  for (int k = 0; k < 3; ++k) {
    const FlatEar ear{f(k), f((k + 1) % 3), f((k + 2) % 3)};
    if (triangles_of[static_cast<std::size_t>(ear.vertex)] != 1) continue;
    const Eigen::RowVector3d along = mesh.V.row(ear.b) - mesh.V.row(ear.a);
    const Eigen::RowVector3d to = mesh.V.row(ear.vertex) - mesh.V.row(ear.a);
    const double longest =
        std::max({along.squaredNorm(), to.squaredNorm(), (to - along).squaredNorm()});
    if (to.cross(along).norm() > kFlat * longest || along.squaredNorm() == 0) continue;
    return FlatEar{ear.vertex, ear.a, ear.b, to.dot(along) / along.squaredNorm()};
  }
  return std::nullopt;
}

/// Takes flat ears off the mesh, one after the other: what is left is the same disc. Its vertices
/// keep their numbers.
std::vector<FlatEar> take_flat_ears_off(TriMesh& mesh) {
  std::vector<int> triangles_of(static_cast<std::size_t>(mesh.V.rows()), 0);
  for (const int v : mesh.F.reshaped()) ++triangles_of[static_cast<std::size_t>(v)];
  std::vector<FlatEar> ears;
  for (Eigen::Index t = 0; t < mesh.F.rows();) {
    const std::optional<FlatEar> ear = flat_ear(mesh, t, triangles_of);
    if (!ear) {
      ++t;
      continue;
    }
    ears.push_back(*ear);
    for (const int v : {ear->vertex, ear->a, ear->b}) --triangles_of[static_cast<std::size_t>(v)];
    mesh.F.row(t) = mesh.F.row(mesh.F.rows() - 1).eval();
    mesh.F.conservativeResize(mesh.F.rows() - 1, Eigen::NoChange);
    t = 0;
  }
  return ears;
}

template <class Parameterizer>
Eigen::MatrixX2d parameterise_whole(const TriMesh& disc, Parameterizer parameterizer,
                                    const std::string& who) {
  const std::vector<int> border = disc_border(disc, who);
  CgalMesh mesh = to_cgal(disc);
  const auto plane =
      mesh.add_property_map<CgalMesh::Vertex_index, CgalKernel::Point_2>("v:plane").first;
  // The half-edge outside the border, opposite to the one that runs along the piece.
  const auto index = [&](std::size_t i) {
    return CgalMesh::Vertex_index(static_cast<CgalMesh::size_type>(border[i]));
  };
  const auto outside = mesh.halfedge(index(1), index(0));
  const smp::Error_code code = smp::parameterize(mesh, parameterizer, outside, plane);
  if (code != smp::OK) throw Error(cgal_message(code), who, "another method");
  Eigen::MatrixX2d points(disc.vertex_count(), 2);
  for (int v = 0; v < disc.vertex_count(); ++v) {
    const auto& p = plane[CgalMesh::Vertex_index(static_cast<CgalMesh::size_type>(v))];
    points.row(v) << p.x(), p.y();
  }
  if (!points.allFinite()) throw Error("the map is not finite", who, "another method");
  return points;
}

template <class Parameterizer>
Eigen::MatrixX2d parameterise(const TriMesh& disc, Parameterizer parameterizer,
                              const std::string& who) {
  TriMesh rest = disc;
  const std::vector<FlatEar> ears = take_flat_ears_off(rest);
  if (ears.empty()) return parameterise_whole(disc, parameterizer, who);
  (void)disc_border(disc, who);
  const std::vector<CutPiece> parts = cut_surface(rest, {});
  if (parts.size() != 1) throw Error("all of its triangles are lines", who, "a piece with an area");
  const Eigen::MatrixX2d of_rest = parameterise_whole(parts[0].mesh, parameterizer, who);
  Eigen::MatrixX2d points(disc.vertex_count(), 2);
  for (int v = 0; v < of_rest.rows(); ++v) points.row(parts[0].surface_vertex[v]) = of_rest.row(v);
  for (auto ear = ears.rbegin(); ear != ears.rend(); ++ear) {
    points.row(ear->vertex) =
        points.row(ear->a) + ear->t * (points.row(ear->b) - points.row(ear->a));
  }
  return points;
}

}  // namespace

Eigen::MatrixX2d flatten_cgal_arap(const TriMesh& disc, const CgalArapOptions& options) {
  using Arap = smp::ARAP_parameterizer_3<CgalMesh>;
  return parameterise(disc,
                      Arap(Arap::Border_parameterizer(), Arap::Solver_traits(), options.lambda,
                           static_cast<unsigned>(options.iterations), options.tolerance),
                      "CGAL as-rigid-as-possible");
}

Eigen::MatrixX2d flatten_cgal_lscm(const TriMesh& disc) {
  const Eigen::MatrixX2d points =
      parameterise(disc, smp::LSCM_parameterizer_3<CgalMesh>(), "CGAL least squares conformal map");
  Eigen::VectorXcd z = to_complex(points);
  scale_to_area(flat_triangles(disc), disc.F, z);
  return to_points(z);
}

}  // namespace geoprior::sketch
