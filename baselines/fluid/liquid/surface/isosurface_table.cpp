#include "baselines/fluid/liquid/surface/isosurface_table.h"

#include <cassert>

namespace geoprior::fluid {
namespace {

int edge_number(int corner, int axis) { return 8 * axis + corner; }
CubeEdge edge_of(int number) {
  return {static_cast<std::int8_t>(number % 8), static_cast<std::int8_t>(number / 8)};
}

/// The edge between two corners that differ in one bit.
int edge_between(int a, int b) {
  const int bit = a ^ b;
  return edge_number(a & b, bit == 1 ? 0 : bit == 2 ? 1 : 2);
}

/// Corners of a face in counter-clockwise order seen from outside of the cube.
std::array<int, 4> face_corners(int axis, bool upper) {
  const int u = 1 << ((axis + 1) % 3), v = 1 << ((axis + 2) % 3), base = upper ? 1 << axis : 0;
  if (upper) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

/// The crossed edge that follows each crossed edge in its loop, -1 elsewhere. Walking round a face,
/// the edge where an inside run begins is followed by the one where it ends.
std::array<int, 24> successors(int inside) {
  std::array<int, 24> next;
  next.fill(-1);
  const auto is_inside = [&](int corner) { return ((inside >> corner) & 1) != 0; };
  for (int f = 0; f < 6; ++f) {
    const std::array<int, 4> corners = face_corners(f / 2, f % 2 == 1);
    const auto at = [&](int i) { return corners[i % 4]; };
    for (int i = 0; i < 4; ++i) {
      if (is_inside(at(i)) || !is_inside(at(i + 1))) continue;
      int last = i + 1;
      while (is_inside(at(last + 1))) ++last;
      next[edge_between(at(i), at(i + 1))] = edge_between(at(last), at(last + 1));
    }
  }
  return next;
}

bool share_face(int e, int f) {
  const CubeEdge a = edge_of(e), b = edge_of(f);
  for (int axis = 0; axis < 3; ++axis)
    if (axis != a.axis && axis != b.axis && ((a.corner ^ b.corner) & (1 << axis)) == 0) return true;
  return false;
}

/// Triangulates loop[first … last] closed by the side from last to first.
/// @return false when every way needs a diagonal in a face
bool triangulate(const std::vector<int>& loop, std::size_t first, std::size_t last,
                 std::vector<CubeEdge>& out) {
  if (last < first + 2) return true;
  const std::size_t before = out.size();
  for (std::size_t k = first + 1; k < last; ++k) {
    if (k > first + 1 && share_face(loop[first], loop[k])) continue;
    if (k + 1 < last && share_face(loop[k], loop[last])) continue;
    for (const std::size_t corner : {first, k, last}) out.push_back(edge_of(loop[corner]));
    if (triangulate(loop, first, k, out) && triangulate(loop, k, last, out)) return true;
    out.resize(before);
  }
  return false;
}

CubeTable make_table() {
  CubeTable table;
  for (int inside = 0; inside < 256; ++inside) {
    std::array<int, 24> next = successors(inside);
    for (int start = 0; start < std::ssize(next); ++start) {
      if (next[start] < 0) continue;
      std::vector<int> loop;
      for (auto e = start; next[e] >= 0;) {
        loop.push_back(e);
        const int following = next[e];
        next[e] = -1;
        e = following;
      }
      [[maybe_unused]] const bool done = triangulate(loop, 0, loop.size() - 1, table.edges[inside]);
      assert(done);
    }
  }
  return table;
}

}  // namespace

const CubeTable& cube_table() {
  static const CubeTable table = make_table();
  return table;
}

}  // namespace geoprior::fluid
