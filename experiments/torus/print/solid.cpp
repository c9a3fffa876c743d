#include "experiments/torus/print/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <sstream>

#include "core/error.h"
#include "core/geometry/area_vector.h"
#include "core/geometry/topology.h"
#include "models/torus/revolution.h"

namespace geoprior::torus {
namespace {

constexpr double kMillimetres = 1000;

/// Little-endian whatever the machine is.
template <class Bits>
void append(std::string& bytes, Bits bits) {
  for (std::size_t i = 0; i < sizeof bits; ++i)
    bytes.push_back(static_cast<char>(bits >> (8 * i) & 0xff));
}

void append(std::string& bytes, const Eigen::RowVector3d& point) {
  for (int k = 0; k < 3; ++k)
    append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(point(k))));
}

}  // namespace

TriMesh body_between(const TriMesh& surface, const Eigen::MatrixX3d& inside) {
  const auto border = boundary_edges(surface.F);
  const int n = surface.vertex_count();
  const Eigen::Index faces = surface.F.rows();
  TriMesh body;
  body.V.resize(2 * n, 3);
  body.V << surface.V, inside;
  body.F.resize(2 * faces + 2 * static_cast<Eigen::Index>(border.size()), 3);
  body.F.topRows(faces) = surface.F;
  for (Eigen::Index t = 0; t < faces; ++t)
    body.F.row(faces + t) << surface.F(t, 0) + n, surface.F(t, 2) + n, surface.F(t, 1) + n;
  Eigen::Index row = 2 * faces;
  for (const auto& [a, b] : border) {  // in the direction of their triangle
    body.F.row(row++) << b, a, a + n;
    body.F.row(row++) << b, a + n, b + n;
  }
  return body;
}

Eigen::MatrixX3d round_cavity(const TriMesh& surface, const Eigen::MatrixXd& at, double ring,
                              double thickness) {
  double tube = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < surface.V.rows(); ++i)
    tube = std::min(tube, std::hypot(surface.V.row(i).head<2>().norm() - ring, surface.V(i, 2)));
  if (!(thickness < tube)) {
    std::ostringstream text;
    text << "is " << thickness / tube << " times the radius of the round tube that fits inside";
    throw Error(text.str(), "scene.print.thickness", "less; 0: solid");
  }
  const double scale = 2 * std::numbers::pi;
  const Radii radii{scale * (tube - thickness), scale * ring};
  Eigen::MatrixX3d inside(at.rows(), 3);
  for (Eigen::Index i = 0; i < at.rows(); ++i) inside.row(i) = revolution_point(radii, at.row(i));
  return inside;
}

Eigen::MatrixX3d flat_plate(const TriMesh& surface, double thickness) {
  const int side = static_cast<int>(std::lround(std::sqrt(surface.vertex_count())));
  const Eigen::Vector3d up = doubled_area_vector(surface.V, surface.F).normalized();
  const double bottom = (surface.V * up).minCoeff() - thickness;
  const auto corner = [&](int i, int j) -> Eigen::Vector3d {
    const Eigen::Vector3d point = surface.V.row(j * side + i);
    return point + (bottom - point.dot(up)) * up;
  };
  const int last = side - 1;
  const Eigen::Vector3d a = corner(0, 0), b = corner(last, 0), c = corner(0, last),
                        d = corner(last, last);
  Eigen::MatrixX3d inside(surface.V.rows(), 3);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double u = static_cast<double>(i) / last, v = static_cast<double>(j) / last;
      inside.row(j * side + i) = (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d);
    }
  return inside;
}

TriMesh scaled(TriMesh mesh, double factor) {
  const Eigen::RowVector3d low = mesh.V.colwise().minCoeff();
  mesh.V = (mesh.V.rowwise() - low) * factor;
  return mesh;
}

double extent(const TriMesh& mesh) {
  return (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).maxCoeff();
}

std::string stl_bytes(const TriMesh& mesh) {
  if (mesh.F.rows() > std::numeric_limits<std::uint32_t>::max())
    throw Error("too many triangles for an STL file", "scene.print");
  std::string bytes(80, ' ');
  bytes.reserve(84 + 50 * static_cast<std::size_t>(mesh.F.rows()));
  append(bytes, static_cast<std::uint32_t>(mesh.F.rows()));
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                             c = mesh.V.row(mesh.F(t, 2));
    append(bytes, Eigen::RowVector3d((b - a).cross(c - a).normalized()));
    for (const Eigen::RowVector3d& corner : {a, b, c})
      append(bytes, Eigen::RowVector3d(kMillimetres * corner));
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace geoprior::torus
