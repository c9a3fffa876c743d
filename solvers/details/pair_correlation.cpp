#include "solvers/details/pair_correlation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geoprior::details {
namespace {}  // namespace

PairCorrelation::PairCorrelation(double mean_edge, const PairCorrelationOptions& options)
    : reach_(options.radius * mean_edge),
      sigma_(options.bandwidth * mean_edge),
      radius_of_bin_(options.bins) {
  for (Eigen::Index i = 0; i < options.bins; ++i)
    radius_of_bin_[i] = reach_ * (static_cast<double>(i) + 0.5) / options.bins;
}

void PairCorrelation::add(double distance, Eigen::VectorXd& into) const {
  if (into.size() == 0) into = Eigen::VectorXd::Zero(bins());
  const double scale = 1 / (std::sqrt(2 * std::numbers::pi) * sigma_);
  const double width = reach_ / bins();
  const int first = std::max(0, static_cast<int>((distance - 4 * sigma_) / width));
  const int last = std::min(bins() - 1, static_cast<int>((distance + 4 * sigma_) / width));
  for (int i = first; i <= last; ++i) {
    const double x = (radius_of_bin_[i] - distance) / sigma_;
    into[i] += scale * std::exp(-0.5 * x * x) / (2 * std::numbers::pi * radius_of_bin_[i]);
  }
}

Eigen::VectorXd PairCorrelation::of(const DetailMesh& details, int stride) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(bins());
  const double area = total_area(details);
  int count = 0, centres = 0;
  for (int i = 0; i < details.site_slots(); ++i) {
    if (!counts(details, i)) continue;
    if (count++ % stride != 0) continue;
    ++centres;
    for (const ChartPoint& p : chart_.around(details.mesh, i, reach_ + 4 * sigma_))
      if (p.vertex != i && counts(details, p.vertex)) add(p.at.norm(), sum);
  }
  return centres > 0 ? Eigen::VectorXd(sum * (area / (static_cast<double>(centres) * count))) : sum;
}

bool PairCorrelation::counts(const DetailMesh& details, int site) {
  return details.is_detail(site) && details.site[site].target_weight > 0;
}

void PairCorrelation::distances(const DetailMesh& details, int t,
                                const Eigen::Vector3d& barycentric, std::vector<double>& into) {
  into.clear();
  const auto corner = details.mesh.corners(t);
  const double longest = std::max(
      {details.mesh.length(3 * t), details.mesh.length(3 * t + 1), details.mesh.length(3 * t + 2)});
  const auto& chart = chart_.around(details.mesh, corner[0], reach_ + 4 * sigma_ + longest);
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  for (const ChartPoint& p : chart) {
    for (std::size_t k = 1; k < 3; ++k)
      if (p.vertex == corner[k]) at += barycentric[k] * p.at;
  }
  for (const ChartPoint& p : chart) {
    const double distance = (p.at - at).norm();
    if (distance < reach_ + 4 * sigma_ && counts(details, p.vertex)) into.push_back(distance);
  }
}

void describe(OptionVisitor& v, PairCorrelationOptions& options) {
  v.value("radius", options.radius,
          {.doc = "largest distance of the pair correlation, in mean edges of M_d",
           .min = 0.5,
           .max = 10});
  v.value("bins", options.bins,
          {.doc = "intervals of distance of the pair correlation", .min = 2, .max = 512});
  v.value("bandwidth", options.bandwidth,
          {.doc = "sigma of the Gaussian kernel, in mean edges of M_d", .min = 0.01, .max = 1});
}

}  // namespace geoprior::details
