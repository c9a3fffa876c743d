#include "models/sketch/sections/top_sections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/error.h"

namespace geoprior::sketch {
namespace {

int number_of(const std::vector<OutlinedView>& views, ViewKind kind) {
  const auto view = std::find_if(views.begin(), views.end(),
                                 [&](const OutlinedView& v) { return v.kind == kind; });
  if (view != views.end()) return static_cast<int>(view - views.begin());
  throw Error(std::string("has no view ") + view_name(kind), "hull.sections = \"top\"",
              "front, side and top");
}

ViewSlices heights_of(const std::vector<OutlinedView>& views, ViewKind kind,
                      const std::vector<Rim>& rims) {
  const int number = number_of(views, kind);
  return {views[number], 1, rims, number};
}

constexpr int kHeights = 200;
/// Sections are larger than the widths by this share, and cut by the views: these keep a strip of
/// their own along their silhouettes, which lies on them exactly.
constexpr double kTopSlack = 0.002;

}  // namespace

TopSections::TopSections(const std::vector<OutlinedView>& views, const std::vector<Rim>& rims)
    : top_(views[number_of(views, ViewKind::top)].outline),
      front_(heights_of(views, ViewKind::front, rims)),
      side_(heights_of(views, ViewKind::side, rims)) {}

TopSections::AtHeight TopSections::at(double y) const {
  const Slice x = front_.extent_at(y), z = side_.extent_at(y);
  const Eigen::Vector2d size = (1 + kTopSlack) * Eigen::Vector2d(x.width(), z.width());
  return {Eigen::Vector2d(x.middle(), -z.middle()) - 0.5 * size,
          (top_.highest() - top_.lowest()).cwiseQuotient(size)};
}

double TopSections::distance(const AtHeight& at, const Eigen::Vector2d& q) const {
  return top_.nearest(top_.lowest() + (q - at.low).cwiseProduct(at.scale)).distance /
         at.scale.maxCoeff();
}

Eigen::Vector3d TopSections::moved_on(const Eigen::Vector3d& x) const {
  const AtHeight here = at(x.y());
  const Eigen::Vector2d q(x.x(), -x.z());
  const Eigen::Vector2d nearest =
      top_.nearest(top_.lowest() + (q - here.low).cwiseProduct(here.scale)).point;
  const Eigen::Vector2d to = here.low + (nearest - top_.lowest()).cwiseQuotient(here.scale);
  return {to.x(), x.y(), -to.y()};
}

std::string TopSections::contradiction() const {
  constexpr double kFewHeights = 0.02, kManyHeights = 0.1, kFarOff = 0.15;
  const double low = front_.first(), step = (front_.last() - low) / kHeights;
  const Eigen::Vector2d size = top_.highest() - top_.lowest();
  const Eigen::Vector2d middle = 0.5 * (top_.lowest() + top_.highest());
  int apart = 0, off = 0;
  for (int i = 0; i < kHeights; ++i) {
    const double y = low + (i + 0.5) * step;
    if (front_.at(y).size() > 1 || side_.at(y).size() > 1) ++apart;
    const Slice x = front_.extent_at(y), z = side_.extent_at(y);
    const Eigen::Vector2d from(x.middle() - middle.x(), -z.middle() - middle.y());
    if (from.cwiseAbs().cwiseQuotient(size).maxCoeff() > kFarOff) ++off;
  }
  if (apart > kFewHeights * kHeights) return "sections have several parts";
  if (off > kManyHeights * kHeights) return "sections lie beside the middle of the top view";
  if (!fills_top_view()) return "they would not fill its silhouette";
  return "";
}

bool TopSections::fills_top_view() const {
  constexpr int kPlaces = 256;
  constexpr double kLeastShare = 0.99;
  std::vector<AtHeight> heights;
  const double low = front_.first(), step = (front_.last() - low) / kHeights;
  for (int i = 0; i <= kHeights; ++i) heights.push_back(at(low + i * step));
  int filled = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const Eigen::Vector2d on = top_.at(top_.length() * (i + 0.5) / kPlaces);
    const bool is_filled = std::any_of(heights.begin(), heights.end(),
                                       [&](const AtHeight& at) { return distance(at, on) <= 0; });
    if (is_filled) ++filled;
  }
  return filled >= kLeastShare * kPlaces;
}

}  // namespace geoprior::sketch
