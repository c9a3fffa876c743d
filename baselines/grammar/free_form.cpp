#include "baselines/grammar/free_form.h"

#include <string>

#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::grammar {
namespace {

constexpr std::size_t kFreeFormBlock = 512;

void map_rows(const SpatialMap& map, std::span<const char> moved, const std::vector<int>& element,
              Eigen::MatrixX3d& rows) {
  parallel_blocks(rows.rows(), kFreeFormBlock, [&](std::size_t begin, std::size_t end) {
    for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
      if (moves(moved, element[i])) rows.row(i) = map.at(rows.row(i).transpose()).transpose();
    }
  });
}

}  // namespace

std::vector<char> elements_below(const Hierarchy& hierarchy, int element) {
  std::vector<char> below(hierarchy.size(), 0);
  below[element] = 1;
  for (int e = element + 1; e < hierarchy.size(); ++e) below[e] = below[hierarchy.parent(e)];
  return below;
}

bool moves(std::span<const char> moved, int element) {
  if (moved.empty()) return true;
  if (element >= std::ssize(moved))
    throw Error("has " + std::to_string(moved.size()) + " numbers, one an element",
                "elements that a baseline moves", std::to_string(element + 1) + " or more");
  return moved[element] != 0;
}

Geometry free_form(const Geometry& before, const SpatialMap& map, std::span<const char> moved) {
  Geometry after = before;
  map_rows(map, moved, before.key_element, after.keys);
  map_rows(map, moved, before.vertex_element, after.surface.V);
  return after;
}

}  // namespace geoprior::grammar
