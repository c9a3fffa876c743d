#pragma once

#include "core/mesh.h"
#include "core/options.h"

namespace geoprior {

enum class CurvatureKind { cotangent, jet };

struct CurvatureOptions {
  CurvatureKind kind = CurvatureKind::cotangent;
  double cotangent_limit = 20;  ///< cotangents are clamped to ± this: slivers of contouring
  int smoothing = 2;            ///< passes of H <- (H + mean of the ring) / 2
};
void describe(OptionVisitor& v, CurvatureOptions& options);

/// Signed mean curvature H (1/m) at every vertex of a surface with outward normals: positive on
/// crests (1/R on a sphere of liquid), negative in troughs. Vertices on a border get 0.
/// Sources: Meyer et al. 2003 (cotangent); Cazals and Pouget 2005 (jet); thesis 3.3.1.
Eigen::VectorXd mean_curvature(const TriMesh& mesh, const CurvatureOptions& options);

}  // namespace geoprior
