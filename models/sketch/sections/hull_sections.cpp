#include "models/sketch/sections/hull_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace geoprior::sketch {
namespace {

bool has_all_views(const std::vector<OutlinedView>& views) {
  return views.size() == 3;  // one a kind, none of them a photo
}

SectionReport::Tubes report_of(const TubeSections& tubes, const std::vector<Rim>& rims) {
  SectionReport::Tubes report;
  report.axis = tubes.axis();
  report.count = tubes.tubes();
  for (const Rim& rim : rims) {
    const bool is_new =
        std::find(report.rims.begin(), report.rims.end(), rim.id) == report.rims.end();
    if (rim.axis == tubes.axis() && is_new) report.rims.push_back(rim.id);
  }
  for (const QuadrantExponents& exponents : tubes.exponents()) {
    for (const double n : exponents) {
      report.least_exponent = std::min(report.least_exponent, n);
      report.most_exponent = std::max(report.most_exponent, n);
    }
  }
  return report;
}

std::string rounded(double x) {
  const std::string text = std::to_string(std::round(10 * x) / 10);
  return text.substr(0, text.find('.') + 2);
}

}  // namespace

std::string SectionReport::text() const {
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  if (from_top) return "sections of the hull: the top view's outline at every height";
  std::string text = "sections of the hull: ";
  for (const Tubes& tube : tubes) {
    text += "round across " + std::string(kAxes[tube.axis]) + " (" + std::to_string(tube.count) +
            (tube.count == 1 ? " tube, exponent " : " tubes, exponent ") +
            rounded(tube.least_exponent);
    if (tube.most_exponent > kBoxExponent) {
      text += " up to a box, as seen from its end";
    } else if (tube.most_exponent > tube.least_exponent + 0.05) {
      text += " to " + rounded(tube.most_exponent);
    }
    text += "; ends: ";
    for (std::size_t i = 0; i < tube.rims.size(); ++i)
      text += (i == 0 ? "'" : ", '") + tube.rims[i] + "'";
    text += "), ";
  }
  text += tubes.empty() ? "boxes, as far as the views see" : "else boxes";
  if (!not_from_top.empty()) text += "; not from the top view: " + not_from_top;
  return text;
}

SectionBounds::SectionBounds(const Drawing& aligned, const std::vector<OutlinedView>& views,
                             HullSections sections) {
  if (sections == HullSections::box) return;
  const std::vector<Rim> rims = rims_of(aligned, views);
  report_.openings = static_cast<int>(rims.size());
  if (sections == HullSections::top || has_all_views(views)) {
    top_.emplace(views, rims);
    if (sections == HullSections::automatic) report_.not_from_top = top_->contradiction();
    report_.from_top = report_.not_from_top.empty();
    if (report_.from_top) return;
    top_.reset();
  }
  for (int axis = 0; axis < 3; ++axis) {
    const bool ends =
        std::any_of(rims.begin(), rims.end(), [&](const Rim& rim) { return rim.axis == axis; });
    if (!ends) continue;
    tubes_.emplace_back(views, rims, axis);
    report_.tubes.push_back(report_of(tubes_.back(), rims));
  }
}

double SectionBounds::value(const Eigen::Vector3d& x) const {
  double value = -std::numeric_limits<double>::infinity();
  if (top_) value = top_->distance(top_->at(x.y()), {x.x(), -x.z()});
  for (const TubeSections& tubes : tubes_) {
    const double of = tubes.value(x);
    if (of > value && !is_known_elsewhere(tubes, x)) value = of;
  }
  return value;
}

bool SectionBounds::is_known_elsewhere(const TubeSections& tubes, const Eigen::Vector3d& x) const {
  return tubes_.size() > 1 && tubes.is_guessed(x) &&
         std::any_of(tubes_.begin(), tubes_.end(), [&](const TubeSections& other) {
           return &other != &tubes && std::isfinite(other.value(x)) && !other.is_guessed(x);
         });
}

Eigen::Vector3d SectionBounds::moved_on(const Eigen::Vector3d& x, double step) const {
  if (top_) return top_->moved_on(x);
  const TubeSections* outermost = nullptr;
  double here = -std::numeric_limits<double>::infinity();
  for (const TubeSections& tubes : tubes_) {
    const double value = tubes.value(x);
    if (value <= here || is_known_elsewhere(tubes, x)) continue;
    here = value;
    outermost = &tubes;
  }
  if (outermost == nullptr || std::abs(here) < 1e-7 * step) return x;
  const Eigen::Vector3d gradient = outermost->gradient(x, 1e-4 * step);
  if (gradient.squaredNorm() < 1e-12) return x;
  Eigen::Vector3d move = -here / gradient.squaredNorm() * gradient;
  if (move.norm() > step) move *= step / move.norm();
  return x + move;
}

void SectionBounds::bound(GridFunction& f) const {
  if (top_) bound_by_top(f);
  for (const TubeSections& tubes : tubes_) bound_by_tubes(tubes, f);
}

void SectionBounds::bound_by_top(GridFunction& f) const {
  for (int j = 0; j < f.size[1]; ++j) {
    const TopSections::AtHeight here = top_->at(f.origin.y() + j * f.spacing);
    for (int k = 0; k < f.size[2]; ++k) {
      for (int i = 0; i < f.size[0]; ++i) {
        const Eigen::Vector2d q(f.origin.x() + i * f.spacing, -(f.origin.z() + k * f.spacing));
        double& value = f.values[f.index(i, j, k)];
        value = std::max(value, top_->distance(here, q));
      }
    }
  }
}

void SectionBounds::bound_by_tubes(const TubeSections& tubes, GridFunction& f) const {
  const int along = tubes.axis(), p = tubes.first_across(), q = tubes.second_across();
  std::array<int, 3> at{};
  for (at[along] = 0; at[along] < f.size[along]; ++at[along]) {
    const TubeSection section = tubes.at(f.origin[along] + at[along] * f.spacing);
    for (at[q] = 0; at[q] < f.size[q]; ++at[q]) {
      for (at[p] = 0; at[p] < f.size[p]; ++at[p]) {
        double& value = f.values[f.index(at[0], at[1], at[2])];
        const Eigen::Vector3d x = f.origin + f.spacing * Eigen::Vector3d(at[0], at[1], at[2]);
        const double of = section.value(x[p], x[q]);
        if (of > value && !is_known_elsewhere(tubes, x)) value = of;
      }
    }
  }
}

}  // namespace geoprior::sketch
