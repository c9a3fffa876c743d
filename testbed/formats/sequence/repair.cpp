#include "testbed/formats/sequence/repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/topology.h"

namespace geoprior {
namespace {

struct EdgeCounts {
  std::size_t border = 0, crowded = 0;
};

EdgeCounts count_edges(const EdgeConnectivity& edges) {
  EdgeCounts counts;
  for (int e = 0; e < edges.edge_count(); ++e) {
    const std::size_t triangles = edges.half_edges(e).size();
    if (triangles == 1) ++counts.border;
    if (triangles > 2) ++counts.crowded;
  }
  return counts;
}

void require_finite(const Eigen::MatrixX3d& rows, const char* what, const std::string& where) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (rows.row(i).allFinite()) continue;
    throw Error(std::string(what) + " of vertex " + std::to_string(i) + " is not finite", where);
  }
}

/// Drops triangles that name a vertex twice; returns how many.
Eigen::Index drop_degenerate(Eigen::MatrixX3i& F) {
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::RowVector3i f = F.row(t);
    if (f(0) != f(1) && f(1) != f(2) && f(2) != f(0)) F.row(kept++) = f;
  }
  const Eigen::Index dropped = F.rows() - kept;
  F.conservativeResize(kept, 3);
  return dropped;
}

Eigen::MatrixX3d rows_at(const Eigen::MatrixX3d& rows, const std::vector<int>& which) {
  if (rows.rows() == 0) return rows;
  Eigen::MatrixX3d out(which.size(), 3);
  for (std::size_t i = 0; i < which.size(); ++i) {
    out.row(i) = rows.row(which[i]);
  }
  return out;
}

/// The triangles across the edges of a triangle, and whether both run along the common edge in one
/// direction, so that one of the two must be turned over.
struct Neighbours {
  int count = 0;
  std::array<int, 3> triangle{};
  std::array<bool, 3> disagree{};
  void add(int t, bool odd) {
    triangle[count] = t;
    disagree[count++] = odd;
  }
};

/// A mesh on its way, with the numbers its vertices have in the file.
class Repair {
 public:
  Repair(SurfaceFrame& frame, const std::string& where, std::vector<std::string>& notes)
      : frame_(frame), where_(where), notes_(notes), edges_(frame.mesh.F) {}

  void weld() {
    const EdgeCounts before = count_edges(edges_);
    if (before.border == 0 || !border_has_doubles()) return;
    Weld welded = weld_by_position(frame_.mesh);
    if (welded.mesh.vertex_count() == frame_.mesh.vertex_count()) return;
    if (welded.mesh.triangle_count() == 0) return;  // all were points: not for us to judge
    EdgeConnectivity edges(welded.mesh.F);
    const EdgeCounts after = count_edges(edges);
    if (after.border >= before.border || after.crowded > before.crowded) return;
    frame_.velocity = rows_at(frame_.velocity, welded.split_of_welded);
    if (welded.mesh.triangle_count() < frame_.mesh.triangle_count())
      notes_.push_back("triangles with two corners in one place left out");
    frame_.mesh = std::move(welded.mesh);
    edges_ = std::move(edges);
    notes_.push_back("doubled vertices along seams were welded");
  }

  /// Two triangles an edge at most.
  void require_manifold() const {
    for (int e = 0; e < edges_.edge_count(); ++e) {
      const std::span<const int> here = edges_.half_edges(e);
      if (here.size() <= 2) continue;
      std::string triangles;
      for (const int h : here.first(std::min<std::size_t>(here.size(), 5)))
        triangles += (triangles.empty() ? "" : ", ") + std::to_string(h / 3);
      throw Error("is not manifold: edge " + std::to_string(edges_.edge(e)[0]) + "-" +
                      std::to_string(edges_.edge(e)[1]) + " belongs to " +
                      std::to_string(here.size()) + " triangles (" + triangles +
                      (here.size() > 5 ? ", …" : "") + ")",
                  where_, "two triangles an edge");
    }
  }

  void orient() {
    const std::vector<Neighbours> neighbours = adjacency();
    const std::size_t count = frame_.mesh.F.rows();
    std::vector<signed char> turned(count, -1);  // -1: not reached yet
    bool any = false;
    for (std::size_t seed = 0; seed < count; ++seed) {
      if (turned[seed] >= 0) continue;
      components_.push_back(reach(seed, neighbours, turned));
      const std::vector<int>& component = components_.back();
      const auto overturned =
          std::count_if(component.begin(), component.end(), [&](int t) { return turned[t] == 1; });
      if (overturned == 0) continue;
      any = true;
      const bool seed_is_odd = 2 * static_cast<std::size_t>(overturned) > component.size();
      for (const int t : component) {
        if ((turned[t] == 1) != seed_is_odd) turn_over(t);
      }
    }
    if (any) notes_.push_back("triangles that disagreed with their neighbours were turned over");
  }

  void turn_outside_out() {
    std::vector<double> areas;
    for (const std::vector<int>& component : components_) areas.push_back(area(component));
    const auto largest_at = std::max_element(areas.begin(), areas.end()) - areas.begin();
    const std::vector<int>& largest = components_[largest_at];
    const bool closed = is_closed(largest);
    const bool inward = closed ? volume(largest) < 0 : faces_down(largest);
    if (!inward) return;
    frame_.mesh.F.col(1).swap(frame_.mesh.F.col(2));
    notes_.push_back(closed ? "the mesh is inside out: its triangles were turned over"
                            : "the open surface faces down: its triangles were turned over");
  }

  void drop_lonely_vertices() {
    std::vector<int> number(frame_.mesh.vertex_count(), -1);
    for (Eigen::Index i = 0; i < frame_.mesh.F.size(); ++i) {
      number[frame_.mesh.F.data()[i]] = 0;
    }
    std::vector<int> kept;
    for (int v = 0; v < std::ssize(number); ++v) {
      if (number[v] < 0) continue;
      number[v] = static_cast<int>(kept.size());
      kept.push_back(v);
    }
    if (kept.size() == number.size()) return;
    frame_.mesh.V = rows_at(frame_.mesh.V, kept);
    frame_.velocity = rows_at(frame_.velocity, kept);
    frame_.mesh.F = frame_.mesh.F.unaryExpr([&](int v) { return number[v]; });
    notes_.push_back("vertices without triangles were dropped");
  }

 private:
  /// Whether two vertices of the border share a position: only they can close edges. Spares most
  /// open surfaces the weld of all vertices.
  [[nodiscard]] bool border_has_doubles() const {
    std::vector<std::array<double, 3>> positions;
    std::vector<char> seen(frame_.mesh.vertex_count(), 0);
    for (int e = 0; e < edges_.edge_count(); ++e) {
      if (edges_.half_edges(e).size() != 1) continue;
      for (const int v : edges_.edge(e)) {
        if (std::exchange(seen[v], 1) != 0) continue;
        const Eigen::RowVector3d x = frame_.mesh.V.row(v);
        positions.push_back({x.x(), x.y(), x.z()});
      }
    }
    std::sort(positions.begin(), positions.end());
    return std::adjacent_find(positions.begin(), positions.end()) != positions.end();
  }

  [[nodiscard]] std::vector<Neighbours> adjacency() const {
    std::vector<Neighbours> out(frame_.mesh.F.rows());
    for (int e = 0; e < edges_.edge_count(); ++e) {
      const std::span<const int> both = edges_.half_edges(e);
      if (both.size() != 2) continue;
      const bool disagree = edges_.ascends(both[0]) == edges_.ascends(both[1]);
      out[both[0] / 3].add(both[1] / 3, disagree);
      out[both[1] / 3].add(both[0] / 3, disagree);
    }
    return out;
  }

  std::vector<int> reach(std::size_t seed, const std::vector<Neighbours>& neighbours,
                         std::vector<signed char>& turned) const {
    std::vector<int> component{static_cast<int>(seed)};
    turned[seed] = 0;
    for (std::size_t next = 0; next < component.size(); ++next) {
      const std::size_t t = component[next];
      for (int k = 0; k < neighbours[t].count; ++k) {
        const int other = neighbours[t].triangle[k];
        const bool disagree = neighbours[t].disagree[k];
        const auto wanted = static_cast<signed char>((turned[t] == 1) != disagree ? 1 : 0);
        signed char& found = turned[other];
        if (found == -1) {
          found = wanted;
          component.push_back(other);
        } else if (found != wanted) {
          throw Error("cannot be oriented: triangles " + std::to_string(t) + " and " +
                          std::to_string(other) + " never agree (a one-sided surface)",
                      where_);
        }
      }
    }
    return component;
  }

  void turn_over(int t) { std::swap(frame_.mesh.F(t, 1), frame_.mesh.F(t, 2)); }

  [[nodiscard]] Eigen::Vector3d corner(int t, int k) const {
    return frame_.mesh.V.row(frame_.mesh.F(t, k)).transpose();
  }
  [[nodiscard]] Eigen::Vector3d area_vector(int t) const {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)) / 2;
  }
  [[nodiscard]] double area(const std::vector<int>& component) const {
    double sum = 0;
    for (const int t : component) sum += area_vector(t).norm();
    return sum;
  }
  [[nodiscard]] double volume(const std::vector<int>& component) const {
    const Eigen::Vector3d origin = corner(component.front(), 0);
    double sum = 0;
    for (const int t : component) sum += (corner(t, 0) - origin).dot(area_vector(t)) / 3;
    return sum;
  }
  [[nodiscard]] bool faces_down(const std::vector<int>& component) const {
    double sum = 0;
    for (const int t : component) sum += area_vector(t).z();
    return sum < 0;
  }
  [[nodiscard]] bool is_closed(const std::vector<int>& component) const {
    std::vector<char> inside(frame_.mesh.F.rows(), 0);
    for (const int t : component) inside[t] = 1;
    for (int e = 0; e < edges_.edge_count(); ++e) {
      const std::span<const int> here = edges_.half_edges(e);
      if (here.size() == 1 && inside[here[0] / 3] != 0) return false;
    }
    return true;
  }

  SurfaceFrame& frame_;
  const std::string& where_;
  std::vector<std::string>& notes_;
  EdgeConnectivity edges_;  ///< of the frame, before triangles are turned over
  std::vector<std::vector<int>> components_;
};

}  // namespace

void repair(SurfaceFrame& frame, const std::string& where, std::vector<std::string>& notes) {
  require_finite(frame.mesh.V, "position", where);
  require_finite(frame.velocity, "velocity", where);
  if (drop_degenerate(frame.mesh.F) > 0) {
    notes.push_back("triangles that name a vertex twice were dropped");
  }
  if (frame.mesh.F.rows() == 0) {
    throw Error("is an empty frame: no triangles", where,
                "one triangle or more; first and last take the frames that have a surface");
  }
  Repair work(frame, where, notes);
  work.weld();
  work.require_manifold();
  work.orient();
  work.turn_outside_out();
  work.drop_lonely_vertices();
}

}  // namespace geoprior
