#include "metrics/spacing/detail_continuity.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

/// Rows in order of identity.
using Roll = std::vector<std::pair<std::int64_t, int>>;

Roll roll_of(const DetailsOfFrame& details) {
  if (details.birth.size() != details.weight.size()) {
    throw Error(std::to_string(details.birth.size()) + " identities and " +
                    std::to_string(details.weight.size()) + " weights",
                "details of a frame", "equal numbers");
  }
  Roll roll;
  for (int i = 0; i < std::ssize(details.birth); ++i) {
    roll.emplace_back(details.birth[i], i);
  }
  std::sort(roll.begin(), roll.end());
  for (std::size_t i = 1; i < roll.size(); ++i) {
    if (roll[i].first == roll[i - 1].first) {
      throw Error("identity " + std::to_string(roll[i].first) + " is there twice",
                  "details of a frame");
    }
  }
  return roll;
}

/// Calls `visit(row before, row now)` for every identity, in order; -1 where it is not.
template <class Visit>
void match(const DetailsOfFrame& before, const DetailsOfFrame& now, const Visit& visit) {
  const Roll a = roll_of(before), b = roll_of(now);
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (j == b.size() || (i < a.size() && a[i].first < b[j].first)) {
      visit(a[i++].second, -1);
    } else if (i == a.size() || b[j].first < a[i].first) {
      visit(-1, b[j++].second);
    } else {
      visit(a[i++].second, b[j++].second);
    }
  }
}

double weight_of(const DetailsOfFrame& details, int row) {
  return row < 0 ? 0 : details.weight[row];
}

/// A point of the surface with its normal.
struct Foot {
  Eigen::Vector3d x, n;
};

Foot foot_of(const TriMesh& surface, const Eigen::MatrixX3d& normals,
             const AnchoredDetails& details, int row) {
  const int f = details.face[row];
  if (f < 0 || f >= surface.F.rows()) {
    throw Error("no triangle " + std::to_string(f), "detail " + std::to_string(row),
                "0 to " + std::to_string(surface.F.rows()) + " excluded");
  }
  Foot foot{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (int c = 0; c < 3; ++c) {
    const double share = details.barycentric(row, c);
    foot.x += share * surface.V.row(surface.F(f, c)).transpose();
    foot.n += share * normals.row(surface.F(f, c)).transpose();
  }
  foot.n.normalize();
  return foot;
}

void require_anchors(const AnchoredDetails& details) {
  if (details.face.size() != details.state.birth.size() ||
      static_cast<std::size_t>(details.barycentric.rows()) != details.face.size()) {
    throw Error(std::to_string(details.state.birth.size()) + " identities, " +
                    std::to_string(details.face.size()) + " faces, " +
                    std::to_string(details.barycentric.rows()) + " barycentric coordinates",
                "anchored details", "equal numbers");
  }
}

}  // namespace

DetailChanges detail_changes(const DetailsOfFrame& before, const DetailsOfFrame& now) {
  DetailChanges changes;
  match(before, now, [&](int was, int is) {
    changes.inserted += was < 0 ? 1 : 0;
    changes.removed += is < 0 ? 1 : 0;
    const double step = std::abs(weight_of(now, is) - weight_of(before, was));
    changes.largest_step = std::max(changes.largest_step, step);
  });
  return changes;
}

DetailEvents detail_events(std::span<const DetailChanges> changes) {
  DetailEvents events;
  for (const DetailChanges& c : changes) {
    events.inserted += c.inserted;
    events.removed += c.removed;
    events.largest_step = std::max(events.largest_step, c.largest_step);
  }
  events.churn = events.inserted + events.removed - std::abs(events.inserted - events.removed);
  return events;
}

int details_that_begin(const DetailTargets& before, const DetailTargets& now) {
  const std::set<std::int64_t> there(before.birth.begin(), before.birth.end());
  std::set<std::int64_t> fading;
  for (std::size_t i = 0; i < before.birth.size(); ++i)
    if (before.target[i] == 0) fading.insert(before.birth[i]);
  int begin = 0;
  for (std::size_t i = 0; i < now.birth.size(); ++i) {
    const bool is_new = !there.contains(now.birth[i]);
    const bool fades = now.target[i] == 0 && !fading.contains(now.birth[i]);
    if (is_new || fades) ++begin;
  }
  return begin;
}

int turns(std::span<const double> values, double least) {
  if (!(least > 0)) throw Error("least change of " + std::to_string(least), "turns", "positive");
  if (values.empty()) return 0;
  int count = 0, direction = 0;
  // Until there is a direction, both extremes so far; then `low` or `high` alone matters.
  double low = values[0], high = values[0];
  for (const double value : values) {
    low = std::min(low, value);
    high = std::max(high, value);
    if (direction <= 0 && value >= low + least) {
      count += direction < 0 ? 1 : 0;
      direction = 1;
      high = value;
    } else if (direction >= 0 && value <= high - least) {
      count += direction > 0 ? 1 : 0;
      direction = -1;
      low = value;
    }
  }
  return count;
}

double largest_pop(const TriMesh& surface, const AnchoredDetails& before,
                   const AnchoredDetails& now, double height, DetailExtent extent) {
  if (!(height > 0)) throw Error("height " + std::to_string(height), "largest pop", "positive");
  require_anchors(before);
  require_anchors(now);
  const Eigen::MatrixX3d normals = vertex_normals(surface);
  double largest = 0;
  match(before.state, now.state, [&](int was, int is) {
    const double w0 = weight_of(before.state, was), w1 = weight_of(now.state, is);
    double pop = std::abs(w1 - w0) * height;
    if (was >= 0 && is >= 0) {
      const Foot a = foot_of(surface, normals, before, was), b = foot_of(surface, normals, now, is);
      const Eigen::Vector3d slide = std::max(w0, w1) * (b.x - a.x);
      if (extent == DetailExtent::tip) {
        pop = (slide + height * (w1 * b.n - w0 * a.n)).norm();
      } else {
        pop += slide.norm() + height * std::min(w0, w1) * (b.n - a.n).norm();
      }
    }
    largest = std::max(largest, pop);
  });
  return largest;
}

}  // namespace geoprior
