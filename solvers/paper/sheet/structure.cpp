#include "solvers/paper/sheet/structure.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace geoprior::paper {

std::vector<int> PaperStructure::pieces_at(int singular_point) const {
  std::vector<int> touching;
  for (int i = 0; i < std::ssize(pieces); ++i) {
    if (pieces[i].singular_point == singular_point) touching.push_back(i);
  }
  return touching;
}

int PaperStructure::piece_at(const Eigen::Vector2d& p) const {
  for (int i = 0; i < std::ssize(pieces); ++i) {
    if (contains(pieces[i].region, p)) return i;
  }
  return -1;
}

std::vector<int> PaperStructure::rulings_at(int singular_point) const {
  std::vector<std::pair<double, int>> by_angle;
  for (int i = 0; i < std::ssize(rulings); ++i) {
    const Ruling& r = rulings[i];
    if (r.singular_a != singular_point && r.singular_b != singular_point) continue;
    const Eigen::Vector2d d =
        r.singular_a == singular_point ? Eigen::Vector2d(r.b - r.a) : Eigen::Vector2d(r.a - r.b);
    by_angle.emplace_back(std::atan2(d.y(), d.x()), i);
  }
  std::sort(by_angle.begin(), by_angle.end());
  std::vector<int> result;
  for (const auto& [angle, i] : by_angle) result.push_back(i);
  return result;
}

}  // namespace geoprior::paper
