#define CGAL_EIGEN3_ENABLED 1

#include "baselines/grammar/rigid_as_possible.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_deformation.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "baselines/grammar/free_form.h"
#include "core/disjoint_sets.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"

namespace geoprior::grammar {
namespace {

using ArapKernel = CGAL::Simple_cartesian<double>;
using ArapMesh = CGAL::Surface_mesh<ArapKernel::Point_3>;
using ArapVertex = ArapMesh::Vertex_index;
using ArapDeformation =
    CGAL::Surface_mesh_deformation<ArapMesh, CGAL::Default, CGAL::Default, CGAL::ORIGINAL_ARAP>;

constexpr int kLeastControls = 4;
/// Least over largest variance of points that an affine map is fitted to.
constexpr double kFlatVariance = 1e-6;

/// What belongs to one element: rows of the geometry.
struct ElementBody {
  std::vector<int> vertices, triangles, keys;
};

/// A connected piece of an element's welded surface, and which welded vertices it has.
struct SurfacePiece {
  TriMesh mesh;
  std::vector<int> welded;
};

std::vector<ElementBody> bodies_of(const Geometry& geometry, std::span<const char> moved) {
  std::vector<ElementBody> bodies;
  const auto collect = [&](const std::vector<int>& element, std::vector<int> ElementBody::*rows) {
    for (int i = 0; i < std::ssize(element); ++i) {
      if (!moves(moved, element[i])) continue;
      if (element[i] >= std::ssize(bodies)) bodies.resize(element[i] + 1);
      (bodies[element[i]].*rows).push_back(i);
    }
  };
  collect(geometry.vertex_element, &ElementBody::vertices);
  collect(geometry.triangle_element, &ElementBody::triangles);
  collect(geometry.key_element, &ElementBody::keys);
  std::erase_if(bodies, [](const ElementBody& b) { return b.vertices.empty() && b.keys.empty(); });
  return bodies;
}

TriMesh surface_of_body(const Geometry& geometry, const ElementBody& body) {
  TriMesh mesh{geometry.surface.V(body.vertices, Eigen::all),
               geometry.surface.F(body.triangles, Eigen::all)};
  // The rows ascend, and a triangle's corners are of its own element.
  for (int f = 0; f < mesh.triangle_count(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto at = std::lower_bound(body.vertices.begin(), body.vertices.end(), mesh.F(f, k));
      mesh.F(f, k) = static_cast<int>(at - body.vertices.begin());
    }
  return mesh;
}

std::vector<SurfacePiece> pieces_of(const TriMesh& welded) {
  const int n = welded.vertex_count();
  DisjointSets sets(n);
  for (int f = 0; f < welded.triangle_count(); ++f) {
    sets.join(welded.F(f, 0), welded.F(f, 1));
    sets.join(welded.F(f, 0), welded.F(f, 2));
  }
  std::vector<SurfacePiece> pieces;
  std::vector<int> piece_of_set(n, -1), local(n);
  for (int v = 0; v < n; ++v) {
    int& piece = piece_of_set[sets.find(v)];
    if (piece < 0) {
      piece = static_cast<int>(pieces.size());
      pieces.emplace_back();
    }
    local[v] = static_cast<int>(pieces[piece].welded.size());
    pieces[piece].welded.push_back(v);
  }
  std::vector<std::vector<int>> triangles(pieces.size());
  for (int f = 0; f < welded.triangle_count(); ++f)
    triangles[piece_of_set[sets.find(welded.F(f, 0))]].push_back(f);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    pieces[p].mesh.V = welded.V(pieces[p].welded, Eigen::all);
    pieces[p].mesh.F = welded.F(triangles[p], Eigen::all);
    for (int& corner : pieces[p].mesh.F.reshaped()) corner = local[corner];
  }
  return pieces;
}

/// Points in the order of their coordinates, to find equal ones.
class EqualPoints {
 public:
  explicit EqualPoints(const Eigen::MatrixX3d& V) : V_(V), order_(V.rows()) {
    for (int v = 0; v < std::ssize(order_); ++v) order_[v] = v;
    std::sort(order_.begin(), order_.end(), [&](int a, int b) {
      const Eigen::RowVector3d x = V_.row(a), y = V_.row(b);
      return is_before(x, y) || (!is_before(y, x) && a < b);
    });
  }
  /// The first row that equals a point, or -1.
  [[nodiscard]] int find(const Eigen::RowVector3d& x) const {
    const auto at = std::lower_bound(order_.begin(), order_.end(), x, [&](int v, const auto& to) {
      return is_before(V_.row(v), to);
    });
    return at != order_.end() && V_.row(*at) == x ? *at : -1;
  }

 private:
  static bool is_before(const Eigen::RowVector3d& x, const Eigen::RowVector3d& y) {
    return std::lexicographical_compare(x.data(), x.data() + 3, y.data(), y.data() + 3);
  }
  const Eigen::MatrixX3d& V_;
  std::vector<int> order_;
};

/// The vertices of a piece that are nearest to key points, each once, in ascending order.
std::vector<int> controls_of(const TriMesh& piece, const Eigen::MatrixX3d& keys, double share) {
  const int n = piece.vertex_count();
  const int asked = std::max(kLeastControls, static_cast<int>(std::ceil(share * n)));
  const Eigen::MatrixX3d& from = keys.rows() > 0 ? keys : piece.V;
  const int available = static_cast<int>(from.rows());
  const int count = std::min(asked, available);
  const EqualPoints equal(piece.V);
  std::vector<int> controls;
  for (int i = 0; i < count; ++i) {
    const Eigen::RowVector3d key = from.row(static_cast<int>(std::int64_t{i} * available / count));
    int nearest = equal.find(key);
    if (nearest < 0) (piece.V.rowwise() - key).rowwise().squaredNorm().minCoeff(&nearest);
    controls.push_back(nearest);
  }
  std::sort(controls.begin(), controls.end());
  controls.erase(std::unique(controls.begin(), controls.end()), controls.end());
  return controls;
}

Eigen::MatrixX3d mapped_points(const Eigen::MatrixX3d& V, const SpatialMap& map) {
  Eigen::MatrixX3d to(V.rows(), 3);
  for (int v = 0; v < V.rows(); ++v) to.row(v) = map.at(V.row(v).transpose()).transpose();
  return to;
}

Eigen::MatrixX3d transformed_points(const Eigen::Affine3d& motion, const Eigen::MatrixX3d& V) {
  return (V * motion.linear().transpose()).rowwise() + motion.translation().transpose();
}

/// The rigid motion nearest to x_i -> y_i (Kabsch 1976). Where the points leave a rotation open,
/// the one that turns least.
Eigen::Affine3d best_rigid(const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& y) {
  const Eigen::RowVector3d mx = x.colwise().mean(), my = y.colwise().mean();
  Eigen::Matrix3d cross = (y.rowwise() - my).transpose() * (x.rowwise() - mx);
  cross += 1e-12 * cross.norm() * Eigen::Matrix3d::Identity();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) *= -1;
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  if (cross.norm() > 0) motion.linear() = U * svd.matrixV().transpose();
  motion.translation() = my.transpose() - motion.linear() * mx.transpose();
  return motion;
}

/// The affine map nearest to x_i -> y_i; rigid where the points are in a plane.
Eigen::Affine3d best_affine(const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& y) {
  const Eigen::RowVector3d mx = x.colwise().mean(), my = y.colwise().mean();
  const Eigen::MatrixX3d dx = x.rowwise() - mx;
  const Eigen::Matrix3d variance = dx.transpose() * dx;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(variance, Eigen::EigenvaluesOnly);
  if (!(axes.eigenvalues()[0] > kFlatVariance * axes.eigenvalues()[2])) return best_rigid(x, y);
  Eigen::Affine3d motion;
  motion.linear() = (y.rowwise() - my).transpose() * dx * variance.inverse();
  motion.translation() = my.transpose() - motion.linear() * mx.transpose();
  return motion;
}

/// Nothing where the piece is not manifold.
std::optional<ArapMesh> manifold_mesh(const TriMesh& piece) {
  ArapMesh mesh;
  for (int v = 0; v < piece.vertex_count(); ++v)
    mesh.add_vertex({piece.V(v, 0), piece.V(v, 1), piece.V(v, 2)});
  const auto vertex = [](int v) { return ArapVertex(static_cast<ArapMesh::size_type>(v)); };
  for (int f = 0; f < piece.triangle_count(); ++f) {
    const auto face =
        mesh.add_face(vertex(piece.F(f, 0)), vertex(piece.F(f, 1)), vertex(piece.F(f, 2)));
    if (face == ArapMesh::null_face()) return std::nullopt;
  }
  if (mesh.number_of_faces() == 0) return std::nullopt;
  return mesh;
}

/// Nothing where the piece is not manifold, or its equations cannot be solved.
std::optional<Eigen::MatrixX3d> deformed_piece(const TriMesh& start,
                                               const std::vector<int>& controls,
                                               const Eigen::MatrixX3d& targets, int iterations) {
  std::optional<ArapMesh> mesh = manifold_mesh(start);
  if (!mesh) return std::nullopt;
  ArapDeformation deformation(*mesh);
  for (const ArapVertex v : mesh->vertices()) deformation.insert_roi_vertex(v);
  const auto vertex = [](int v) { return ArapVertex(static_cast<ArapMesh::size_type>(v)); };
  for (const int c : controls) deformation.insert_control_vertex(vertex(c));
  if (!deformation.preprocess()) return std::nullopt;
  for (int i = 0; i < std::ssize(controls); ++i)
    deformation.set_target_position(vertex(controls[i]),
                                    {targets(i, 0), targets(i, 1), targets(i, 2)});
  deformation.deform(static_cast<unsigned>(iterations), 0);
  Eigen::MatrixX3d V(start.vertex_count(), 3);
  for (const ArapVertex v : mesh->vertices()) {
    const auto& p = mesh->point(v);
    V.row(static_cast<int>(v.idx())) << p.x(), p.y(), p.z();
  }
  if (!V.allFinite()) return std::nullopt;
  return V;
}

Eigen::MatrixX3d moved_piece(const TriMesh& piece, const Eigen::MatrixX3d& keys,
                             const SpatialMap& map, const RigidAsPossibleOptions& options) {
  const std::vector<int> controls = controls_of(piece, keys, options.controls);
  const Eigen::MatrixX3d held = piece.V(controls, Eigen::all);
  const Eigen::MatrixX3d targets = mapped_points(held, map);
  if (targets == held) return piece.V;
  if (std::ssize(controls) == piece.vertex_count()) return targets;
  const Eigen::Affine3d rigid = best_rigid(piece.V, mapped_points(piece.V, map));
  // The energy does not see a rigid motion of the rest shape, but the steps begin there.
  const TriMesh start{transformed_points(rigid, piece.V), piece.F};
  auto deformed = deformed_piece(start, controls, targets, options.iterations);
  return deformed ? std::move(*deformed) : start.V;
}

void move_body(const Geometry& before, const ElementBody& body, const SpatialMap& map,
               const RigidAsPossibleOptions& options, Geometry& after) {
  const Eigen::MatrixX3d keys = before.keys(body.keys, Eigen::all);
  if (body.vertices.empty()) {
    after.keys(body.keys, Eigen::all) = mapped_points(keys, map);
    return;
  }
  const TriMesh split = surface_of_body(before, body);
  const Weld weld = weld_by_position(split);
  Eigen::MatrixX3d welded = weld.mesh.V;
  for (const SurfacePiece& piece : pieces_of(weld.mesh))
    welded(piece.welded, Eigen::all) = moved_piece(piece.mesh, keys, map, options);
  if (welded == weld.mesh.V) return;
  const Eigen::MatrixX3d V = welded(weld.welded_of_split, Eigen::all);
  after.surface.V(body.vertices, Eigen::all) = V;
  const Eigen::Affine3d fit = best_affine(split.V, V);
  const EqualPoints equal(split.V);
  for (int k = 0; k < keys.rows(); ++k) {
    const int vertex = equal.find(keys.row(k));
    if (vertex >= 0) {
      after.keys.row(body.keys[k]) = V.row(vertex);
    } else {
      after.keys.row(body.keys[k]) = (fit * keys.row(k).transpose()).transpose();
    }
  }
}

}  // namespace

void describe(OptionVisitor& v, RigidAsPossibleOptions& options) {
  v.value("iterations", options.iterations,
          {.doc = "local and global steps of each piece", .min = 1, .max = 1000});
  v.value("controls", options.controls,
          {.doc = "share of a piece's vertices that are held where the map takes them, where the "
                  "element has so many key points",
           .min = 0,
           .max = 1});
}

Geometry rigid_as_possible(const Geometry& before, const SpatialMap& map,
                           const RigidAsPossibleOptions& options, std::span<const char> moved) {
  Geometry after = before;
  const std::vector<ElementBody> bodies = bodies_of(before, moved);
  parallel_blocks(bodies.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) move_body(before, bodies[b], map, options, after);
  });
  return after;
}

}  // namespace geoprior::grammar
