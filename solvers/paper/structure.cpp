#include "solvers/paper/structure.h"

namespace geoprior {

std::vector<int> PaperStructure::pieces_at(int singular_point) const {
  std::vector<int> touching;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].singular_point == singular_point) touching.push_back(static_cast<int>(i));
  }
  return touching;
}

}  // namespace geoprior
