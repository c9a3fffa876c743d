// Things with names, for the tests of labels, legends and exports.
#pragma once

#include <string>
#include <vector>

#include "tests/testbed/fake_run.h"

namespace geoprior {

/// Boxes in a row along x, a metre wide and a half apart: each an organ of that name, the first and
/// every second of kind "gland", the others of kind "duct".
inline Part organ_boxes(const std::vector<std::string>& names) {
  Part part;
  part.points.resize(0, 3);
  part.triangles.resize(0, 3);
  for (int i = 0; i < std::ssize(names); ++i)
    part = join(part, make_box({1.5 * i, 0, 0}, {1.5 * i + 1, 1, 1}));
  Eigen::VectorXd organ(part.triangles.rows()), kind(part.triangles.rows());
  for (int t = 0; t < organ.size(); ++t) {
    organ[t] = t / 12;
    kind[t] = t / 12 % 2;
  }
  part.arrays = {{"structure", "1", NamedArray::On::cells, organ, names},
                 {"kind", "1", NamedArray::On::cells, kind, {"gland", "duct"}}};
  return part;
}

}  // namespace geoprior
