#pragma once

#include <vector>

#include "core/mesh.h"
#include "core/options.h"
#include "solvers/fluid/features/surface_graph.h"

namespace geoprior::fluid {

enum class CurvatureKind { cotangent, jet };

struct CurvatureOptions {
  CurvatureKind kind = CurvatureKind::cotangent;
  int smoothing = 2;  ///< passes of H <- (H + mean of the ring) / 2, by area
};
void describe(OptionVisitor& v, CurvatureOptions& options);

/// Signed mean curvature H (1/m) at every vertex of a surface with outward normals: positive on
/// crests (1/R on a sphere of liquid), negative in troughs. Vertices on a border get 0.
///
/// Cotangent: H = n . sum_j (cot a_ij + cot b_ij)(x_i - x_j) / (4 A_i), with the mixed area A and
/// the normal n weighted by area. Jet: a quadric through two rings. Smoothing
/// averages the integrals of H, so that the tiny areas of contoured meshes, where the error of H is
/// largest, weigh least; it narrows peaks of a few edges' width.
/// Sources: Meyer et al. 2003 (cotangent); Cazals and Pouget 2005 (jet); thesis 3.3.1.
Eigen::VectorXd mean_curvature(const TriMesh& mesh, const CurvatureOptions& options);

/// Curvature with what it is made of.
struct SurfaceShape {
  std::vector<double> curvature;        ///< H (1/m)
  std::vector<double> area;             ///< mixed, m^2
  std::vector<Eigen::Vector3d> normal;  ///< unit; zero where there is none
};
SurfaceShape surface_shape(const SurfaceGraph& graph, const CurvatureOptions& options);

/// Mean curvature of the quadric through the rings of a vertex, at least 6 points (jet fitting).
/// 0 where the points determine none.
std::vector<double> jet_curvature(const SurfaceGraph& graph,
                                  const std::vector<Eigen::Vector3d>& normals);

}  // namespace geoprior::fluid
