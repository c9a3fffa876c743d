#pragma once

#include <array>
#include <string>

#include "core/mesh.h"
#include "core/options.h"

namespace geoprior::details {

/// The smooth surface under the details: procedural, or of a file.
enum class DetailSurfaceKind { plane, sphere, torus, capsule, blob, file, sequence };

/// A tagged choice: `kind` selects which of the others are described.
struct DetailSurfaceOptions {
  DetailSurfaceKind kind = DetailSurfaceKind::plane;
  double width = 1, height = 1;  ///< of the plane, along x and y, centred at the origin (m)
  double radius = 0.5;           ///< of sphere, blob and capsule, of the torus' ring (m)
  double tube_radius = 0.2;
  double length = 1;
  double bumps = 0.2;
  double edge = 0.03;
  std::string file;
  double scale = 1;
  std::array<double, 3> turn_deg{0, 0, 0};
};
void describe(OptionVisitor& v, DetailSurfaceOptions& options);

/// Rectangle in the plane z = 0, facing +z: squares of about `edge`, cut along diagonals that
/// alternate.
TriMesh plane_surface(double width, double height, double edge);

/// Sphere about the origin: an icosahedron, halved until its edges are at most `edge`.
TriMesh sphere_surface(double radius, double edge);

/// Torus about the z axis.
TriMesh torus_surface(double radius, double tube_radius, double edge);

/// Two half spheres and the cylinder between them, along x.
TriMesh capsule_surface(double radius, double length, double edge);

/// A smooth body with bumps and hollows, longer along x: the sphere with its radius multiplied by
/// 1 + bumps (sum of three waves, at most 1).
TriMesh blob_surface(double radius, double bumps, double edge);

/// A procedural surface.
/// @throws Error  for a kind that is none, or more than ten million triangles
TriMesh make_surface(const DetailSurfaceOptions& options);

}  // namespace geoprior::details
