#include "testbed/runner/judgement/blended_frame.h"

namespace geoprior {
namespace {

template <class Matrix>
bool same_size(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols();
}

template <class Matrix>
void blend(const Matrix& input, double s, Matrix& output) {
  output = input + s * (output - input);
}

bool same_topology(const Part& a, const Part& b) {
  return a.kind == b.kind && a.points.rows() == b.points.rows() &&
         same_size(a.triangles, b.triangles) && a.triangles == b.triangles && a.lines == b.lines &&
         a.grid_size == b.grid_size && a.grid_origin == b.grid_origin &&
         a.grid_spacing == b.grid_spacing;
}

void blend_part(const Part& input, double s, Part& output) {
  if (!same_topology(input, output)) return;
  blend(input.points, s, output.points);
  for (NamedArray& array : output.arrays) {
    const NamedArray* other = input.find_array(array.name, array.on);
    const bool numbers = other != nullptr && array.names.empty() && other->names.empty();
    if (numbers && same_size(other->values, array.values)) blend(other->values, s, array.values);
  }
}

}  // namespace

Frame blended_frame(const Frame& input, Frame output, double s) {
  for (auto& [name, part] : output.parts) {
    if (const Part* other = input.find_part(name)) blend_part(*other, s, part);
  }
  for (auto& [name, table] : output.tables) {
    const FrameTable* other = input.find_table(name);
    const bool same =
        other != nullptr && other->columns == table.columns && same_size(other->rows, table.rows);
    if (same) blend(other->rows, s, table.rows);
  }
  return output;
}

}  // namespace geoprior
