#include "experiments/details/scene/surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/procedural.h"
#include "core/geometry/subdivision.h"
#include "core/limits.h"

namespace geoprior::details {
namespace {

constexpr double kMostTriangles = 1e7;
constexpr double kSmallest = 1e-6;
constexpr double kLargest = 1e6;

void require_triangles(double triangles) {
  require_count(triangles, "triangles", kMostTriangles, "scene.surface.edge");
}

void require_area(double area, double edge) {
  // Two triangles of a square of one edge.
  require_triangles(2 * area / (edge * edge));
}

/// Steps of about an edge: a double, as long as nobody has looked how many.
double steps(double length, double edge, double least) {
  return std::max(least, std::round(length / edge));
}

/// Squares along two directions.
std::array<int, 2> grid_of(double along, double across) {
  require_triangles(2 * along * across);
  return {static_cast<int>(along), static_cast<int>(across)};
}

/// Squares (i, j) of a grid, cut along diagonals that alternate. `vertex(i, j)` numbers the
/// corners.
template <class Vertex>
Eigen::MatrixX3i grid_triangles(int nx, int ny, const Vertex& vertex) {
  Eigen::MatrixX3i F(2 * nx * ny, 3);
  Eigen::Index row = 0;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                d = vertex(i, j + 1);
      if ((i + j) % 2 == 0) {
        F.row(row++) << a, b, c;
        F.row(row++) << a, c, d;
      } else {
        F.row(row++) << a, b, d;
        F.row(row++) << b, c, d;
      }
    }
  }
  return F;
}

/// Regular icosahedron with its vertices on the unit sphere.
TriMesh icosahedron() {
  const double a = 1 / std::sqrt(1 + std::numbers::phi * std::numbers::phi);
  const double b = std::numbers::phi * a;
  TriMesh mesh;
  mesh.V.resize(12, 3);
  mesh.V << -a, b, 0, a, b, 0, -a, -b, 0, a, -b, 0, 0, -a, b, 0, a, b, 0, -a, -b, 0, a, -b, b, 0,
      -a, b, 0, a, -b, 0, -a, -b, 0, a;
  mesh.F.resize(20, 3);
  mesh.F << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6,
      7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9,
      8, 1;
  return mesh;
}

}  // namespace

void describe(OptionVisitor& v, DetailSurfaceOptions& options) {
  using Kind = DetailSurfaceKind;
  static constexpr std::array<std::string_view, 7> kKinds{"plane", "sphere", "torus",   "capsule",
                                                          "blob",  "file",   "sequence"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "plane: width, height; sphere: radius; torus: radius, tube_radius; "
                          "capsule: radius, length; blob: radius, bumps; file: file, scale, "
                          "turn_deg; sequence: the first frame of motion.sequence"});
  const auto length = [&](std::string_view key, double& x, std::string_view doc) {
    v.value(key, x, {.doc = doc, .unit = "m", .min = kSmallest, .max = kLargest});
  };
  if (options.kind == Kind::plane) {
    length("width", options.width, "width of the plane, along x");
    length("height", options.height, "height of the plane, along y");
  }
  const bool round = options.kind == Kind::sphere || options.kind == Kind::torus ||
                     options.kind == Kind::capsule || options.kind == Kind::blob;
  if (round) length("radius", options.radius, "radius of the body, or of the ring of a torus");
  if (options.kind == Kind::torus)
    length("tube_radius", options.tube_radius, "radius of the tube of a torus");
  if (options.kind == Kind::capsule)
    length("length", options.length, "length of the straight part of a capsule");
  if (options.kind == Kind::blob) {
    v.value("bumps", options.bumps,
            {.doc = "height of the bumps of a blob, over its radius", .min = 0, .max = 0.5});
  }
  if (options.kind == Kind::file) {
    v.value("file", options.file,
            {.doc = "mesh of the surface: .obj, .ply, .off, .stl, .vtp, .pvtp",
             .required = true,
             .named = Named::file});
    v.value("scale", options.scale, {.doc = "metres for one unit of the file", .min = 1e-9});
    v.value("turn_deg", options.turn_deg,
            {.doc = "turn of the file's mesh: axis times angle", .unit = "deg"});
  } else if (options.kind != Kind::sequence) {
    length("edge", options.edge, "length of the edges of the surface's triangles, about");
  }
}

TriMesh plane_surface(double width, double height, double edge) {
  const auto [columns, rows] = grid_of(steps(width, edge, 1), steps(height, edge, 1));
  const int nx = columns, ny = rows;  // a lambda cannot capture a binding
  TriMesh mesh;
  mesh.V.resize((nx + 1) * (ny + 1), 3);
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      mesh.V.row(j * (nx + 1) + i) << width * (static_cast<double>(i) / nx - 0.5),
          height * (static_cast<double>(j) / ny - 0.5), 0;
    }
  }
  mesh.F = grid_triangles(nx, ny, [&](int i, int j) { return j * (nx + 1) + i; });
  return mesh;
}

TriMesh sphere_surface(double radius, double edge) {
  require_area(4 * std::numbers::pi * radius * radius, edge);
  TriMesh mesh = icosahedron();
  // An edge of the icosahedron subtends atan(2).
  for (double e = radius * std::atan(2.0); e > edge; e /= 2) {
    const Subdivision step = loop_subdivision(mesh.F, mesh.vertex_count());
    mesh.V = (step.stencil * mesh.V).rowwise().normalized();
    mesh.F = step.F;
  }
  mesh.V *= radius;
  return mesh;
}

TriMesh torus_surface(double radius, double tube_radius, double edge) {
  if (!(tube_radius < radius)) {
    throw Error("is not smaller than the ring's", "scene.surface.tube_radius",
                "less than scene.surface.radius");
  }
  // Even numbers, so that diagonals alternate across the seams too.
  const auto [around, along] = grid_of(2 * steps(kFullTurn * radius / 2, edge, 4),
                                       2 * steps(kFullTurn * tube_radius / 2, edge, 3));
  const int nu = around, nv = along;
  TriMesh mesh;
  mesh.V.resize(nu * nv, 3);
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      const double u = kFullTurn * i / nu, w = kFullTurn * j / nv;
      const double r = radius + tube_radius * std::cos(w);
      mesh.V.row(j * nu + i) << r * std::cos(u), r * std::sin(u), tube_radius * std::sin(w);
    }
  }
  mesh.F = grid_triangles(nu, nv, [&](int i, int j) { return j % nv * nu + i % nu; });
  return mesh;
}

TriMesh capsule_surface(double radius, double length, double edge) {
  require_area(2 * std::numbers::pi * radius * (length + 2 * radius), edge);
  const auto [segments, rings] =
      grid_of(steps(2 * std::numbers::pi * radius, edge, 6), steps(length / 2, edge, 1));
  CylinderOptions cylinder;
  cylinder.radius = cylinder.cap_height = radius;
  cylinder.half_length = length / 2;
  cylinder.segments = segments;
  cylinder.rings_per_half = rings;
  return two_bone_cylinder(cylinder).mesh;
}

TriMesh blob_surface(double radius, double bumps, double edge) {
  TriMesh mesh = sphere_surface(1, edge / radius);
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const Eigen::RowVector3d n = mesh.V.row(v);
    const double waves = std::sin(3.1 * n.x() + 0.7) * std::cos(2.3 * n.y()) +
                         std::sin(3.7 * n.y() + 1.9) * std::cos(2.9 * n.z()) +
                         std::sin(3.3 * n.z() - 0.4) * std::cos(2.1 * n.x());
    mesh.V.row(v) =
        radius * (1 + bumps * waves / 3) * Eigen::RowVector3d(1.5 * n.x(), n.y(), n.z());
  }
  return mesh;
}

TriMesh make_surface(const DetailSurfaceOptions& options) {
  switch (options.kind) {
    case DetailSurfaceKind::plane:
      return plane_surface(options.width, options.height, options.edge);
    case DetailSurfaceKind::sphere:
      return sphere_surface(options.radius, options.edge);
    case DetailSurfaceKind::torus:
      return torus_surface(options.radius, options.tube_radius, options.edge);
    case DetailSurfaceKind::capsule:
      return capsule_surface(options.radius, options.length, options.edge);
    case DetailSurfaceKind::blob:
      return blob_surface(options.radius, options.bumps, options.edge);
    default:
      throw Error("is no procedural surface", "scene.surface.kind",
                  "plane, sphere, torus, capsule, blob");
  }
}

}  // namespace geoprior::details
