#define CGAL_EIGEN3_ENABLED 1

#include "baselines/sketch/flatten/cgal_flatten.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Error_code.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "models/sketch/flatten/flat_triangles.h"
#include "models/sketch/pattern/piece_borders.h"

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

template <class Parameterizer>
Eigen::MatrixX2d parameterise(const TriMesh& disc, Parameterizer parameterizer,
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
