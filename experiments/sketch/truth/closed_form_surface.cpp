#include "experiments/sketch/truth/closed_form_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::sketch {
namespace {

/// First vertex of a ring of 6 k vertices about a pole, which is ring 0.
int first_of_ring(int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); }

TriMesh sphere_cap(const ClosedFormOptions& o) {
  TriMesh mesh;
  mesh.V.resize(first_of_ring(o.rings + 1), 3);
  for (int ring = 0; ring <= o.rings; ++ring) {
    const int count = std::max(1, 6 * ring);
    const double polar = o.angle_deg * kDegree * ring / o.rings;
    for (int i = 0; i < count; ++i) {
      const double turn = kFullTurn * i / count;
      mesh.V.row(first_of_ring(ring) + i) =
          o.radius * Eigen::RowVector3d(std::sin(polar) * std::cos(turn), std::cos(polar),
                                        -std::sin(polar) * std::sin(turn));
    }
  }
  // Each of the six sides of ring k has k vertices, facing k + 1 of the next one.
  mesh.F.resize(6 * o.rings * o.rings, 3);
  Eigen::Index t = 0;
  for (int ring = 0; ring < o.rings; ++ring) {
    const auto inner = [&](int i) {
      return first_of_ring(ring) + (ring == 0 ? 0 : i % (6 * ring));
    };
    const auto outer = [&](int i) { return first_of_ring(ring + 1) + i % (6 * ring + 6); };
    for (int side = 0; side < 6; ++side) {
      for (int i = 0; i <= ring; ++i) {
        const int a = side * ring + i, b = side * (ring + 1) + i;
        mesh.F.row(t++) << inner(a), outer(b), outer(b + 1);
        if (i < ring) mesh.F.row(t++) << inner(a), outer(b + 1), inner(a + 1);
      }
    }
  }
  return mesh;
}

TriMesh cone_sector(const ClosedFormOptions& o) {
  // A ring of the flat sector of angle s becomes a circle about the axis: s rho = wrap r.
  const double sine = o.angle_deg / o.wrap_deg;
  if (!(sine < 1)) {
    throw Error(std::to_string(o.angle_deg) + " degrees are to be rolled up over " +
                    std::to_string(o.wrap_deg),
                "known surface: angle_deg", "less than wrap_deg");
  }
  const double cosine = std::sqrt(1 - sine * sine);
  const double depth = o.radius * (1 - o.inner_share) / o.rings;
  const double middle = o.radius * (1 + o.inner_share) / 2 * o.angle_deg * kDegree;
  const int columns = std::max(2, static_cast<int>(std::lround(middle / depth)));
  TriMesh mesh;
  mesh.V.resize((o.rings + 1) * (columns + 1), 3);
  mesh.F.resize(2 * o.rings * columns, 3);
  Eigen::Index t = 0;
  for (int i = 0; i <= o.rings; ++i) {
    const double rho = o.radius * o.inner_share + depth * i;
    for (int j = 0; j <= columns; ++j) {
      const double turn = o.wrap_deg * kDegree * j / columns;
      mesh.V.row(i * (columns + 1) + j) << rho * sine * std::cos(turn), -rho * cosine,
          -rho * sine * std::sin(turn);
      if (i == o.rings || j == columns) continue;
      const int a = i * (columns + 1) + j, b = a + columns + 1;
      mesh.F.row(t++) << a, b, b + 1;
      mesh.F.row(t++) << a, b + 1, a + 1;
    }
  }
  return mesh;
}

}  // namespace

void describe(OptionVisitor& v, ClosedFormOptions& o) {
  static constexpr std::array<std::string_view, 2> kShapes{"sphere-cap", "cone-sector"};
  describe_choice(v, "shape", o.shape, kShapes, {.doc = "the shape of the surface"});
  v.value("radius", o.radius,
          {.doc = "radius of the sphere; slant distance of the cone's far end from its apex",
           .unit = "m",
           .min = 1e-6,
           .max = 1e6});
  v.value(
      "angle_deg", o.angle_deg,
      {.doc = "angle from the cap's pole to its rim; angle of the cone's sector when it is flat",
       .unit = "deg",
       .min = 1,
       .max = 170});
  v.value("inner_share", o.inner_share,
          {.doc = "distance of the cone's near end from its apex over that of the far one",
           .min = 0.01,
           .max = 0.99});
  v.value("wrap_deg", o.wrap_deg,
          {.doc = "angle that the cone's sector takes about the axis",
           .unit = "deg",
           .min = 1,
           .max = 359});
  v.value("rings", o.rings, {.doc = "rings of triangles", .min = 2, .max = 2000});
}

TriMesh closed_form_surface(const ClosedFormOptions& options) {
  return options.shape == ClosedFormShape::sphere_cap ? sphere_cap(options) : cone_sector(options);
}

}  // namespace geoprior::sketch
