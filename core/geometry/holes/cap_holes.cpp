#include "core/geometry/holes/cap_holes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "core/disjoint_sets.h"

namespace geoprior {
namespace {

constexpr double kSheet = 1e-3;  // volume over area^1.5

DisjointSets components(const TriMesh& mesh) {
  DisjointSets sets(mesh.vertex_count());
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    sets.join(mesh.F(f, 0), mesh.F(f, 1));
    sets.join(mesh.F(f, 0), mesh.F(f, 2));
  }
  return sets;
}

/// What the triangles of a component enclose, about its lowest vertex.
struct Enclosed {
  double volume = 0;
  double area = 0;
  bool stays_open = false;  ///< whatever it encloses

  [[nodiscard]] bool is_sheet() const {
    return !(std::abs(volume) > kSheet * area * std::sqrt(area));
  }
};

/// Sums over the components of a mesh, by their lowest vertices.
class Components {
 public:
  explicit Components(const TriMesh& mesh)
      : V_(mesh.V), sets_(components(mesh)), enclosed_(mesh.vertex_count()) {
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
      add({mesh.F(f, 0), mesh.F(f, 1), mesh.F(f, 2)});
  }

  Enclosed& of(int vertex) { return enclosed_[sets_.find(vertex)]; }

  void add(const CapTriangle& t) {
    const int lowest = sets_.find(t[0]);
    const Eigen::Vector3d a = V_.row(t[0]) - V_.row(lowest), b = V_.row(t[1]) - V_.row(lowest),
                          c = V_.row(t[2]) - V_.row(lowest);
    enclosed_[lowest].volume += a.dot(b.cross(c)) / 6;
    enclosed_[lowest].area += (b - a).cross(c - a).norm() / 2;
  }

  /// Whether a component is closed and no sheet.
  [[nodiscard]] bool have_inside() const {
    for (const Enclosed& e : enclosed_)
      if (e.area > 0 && !e.stays_open && !e.is_sheet()) return true;
    return false;
  }

 private:
  const Eigen::MatrixX3d& V_;
  DisjointSets sets_;
  std::vector<Enclosed> enclosed_;
};

}  // namespace

HoleCaps cap_holes(const TriMesh& mesh) {
  const EdgeConnectivity edges(mesh.F);
  const BoundaryLoops border = boundary_loops(mesh.F);
  Components parts(mesh);
  std::set<Edge> chords;
  const auto is_edge = [&](int u, int v) {
    return edges.find(u, v).has_value() || chords.contains(undirected(u, v));
  };
  HoleCaps caps;
  caps.stray_edges = border.stray_edges;
  std::vector<std::vector<CapTriangle>> cap_of;
  for (const std::vector<int>& loop : border.loops) {
    cap_of.push_back(cap_of_loop(mesh.V, loop, is_edge));
    if (cap_of.back().empty()) parts.of(loop[0]).stays_open = true;
    for (const CapTriangle& t : cap_of.back()) {
      parts.add(t);
      for (const auto& [a, b] : {Edge{t[0], t[1]}, Edge{t[1], t[2]}, Edge{t[2], t[0]}})
        chords.insert(undirected(a, b));
    }
  }
  for (std::size_t i = 0; i < cap_of.size(); ++i) {
    const std::vector<int>& loop = border.loops[i];
    Enclosed& part = parts.of(loop[0]);
    if (cap_of[i].empty()) {
      caps.open.push_back({loop, false});
    } else if (part.is_sheet()) {
      caps.open.push_back({loop, true});
    } else {
      caps.capped.push_back(loop);
      caps.triangles.insert(caps.triangles.end(), cap_of[i].begin(), cap_of[i].end());
    }
  }
  caps.has_inside = parts.have_inside();
  return caps;
}

}  // namespace geoprior
