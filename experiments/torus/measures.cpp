#include "experiments/torus/measures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/mesh.h"
#include "metrics/contact/self_contact.h"
#include "metrics/forms/normal_bands.h"
#include "metrics/forms/window_forms.h"
#include "metrics/volume/closedness.h"
#include "models/torus/directions.h"
#include "models/torus/frames.h"
#include "models/torus/revolution.h"
#include "models/torus/sampling.h"

namespace geoprior::torus {
namespace {

/// Of a table of corners. @throws Error  without a row of x, y and step
double step_of(const Frame& frame, const std::string& windows) {
  const Eigen::MatrixXd& rows = frame.require_table(windows).rows;
  if (rows.rows() > 0 && rows.cols() == 3) return rows(0, 2);
  throw Error("has " + std::to_string(rows.rows()) + " rows of " + std::to_string(rows.cols()),
              "table " + windows, "a row of x, y and step for each window");
}

std::vector<FundamentalForm> fine_forms(const Frame& frame, const std::string& part) {
  const double step = step_of(frame, "windows");
  const Eigen::MatrixX3d& points = frame.require_part(part).points;
  const Eigen::Index wanted =
      kWindowSide * kWindowSide * frame.require_table("windows").rows.rows();
  if (points.rows() != wanted) {
    throw Error("has " + std::to_string(points.rows()) + " points", "part " + part,
                std::to_string(wanted) + ", as the table windows has rows");
  }
  return window_forms(points, kWindowSide, step, DifferenceOrder::fourth);
}

constexpr FundamentalForm kSquare{1, 0, 1};

/// share Id + (1 - share) base.
FundamentalForm aim(const FundamentalForm& base, double share) {
  return {share + (1 - share) * base.E, (1 - share) * base.F, share + (1 - share) * base.G};
}

/// base + part of `missing` in a direction: rho pi^2 / |pi|^2.
FundamentalForm with_part(const FundamentalForm& base, const FundamentalForm& missing,
                          int direction) {
  const WaveDirection& d = kDirections[direction];
  const double weight = coefficient(direction, missing.E, missing.F, missing.G) / d.square();
  const Eigen::Vector2d& pi = d.covector;
  return {base.E + weight * pi.x() * pi.x(), base.F + weight * pi.x() * pi.y(),
          base.G + weight * pi.y() * pi.y()};
}

double mean_default(const std::vector<FundamentalForm>& forms) {
  double sum = 0;
  for (const FundamentalForm& form : forms) sum += (kSquare - form).norm();
  return sum / static_cast<double>(forms.size());
}

/// Corrugations so far, as the frame's table has them; 0 without one.
int corrugation_count(const TorusScene& scene, const Frame& frame) {
  const FrameTable* table = frame.find_table("corrugations");
  if (table == nullptr) return 0;
  const Eigen::Index rows = table->rows.rows(), all = std::ssize(scene.input.corrugations);
  if (rows >= 1 && rows <= all) return static_cast<int>(rows);
  throw Error("has " + std::to_string(rows) + " rows", "table corrugations",
              "one for each corrugation so far, 1 to " + std::to_string(all));
}

/// The last corrugation of a frame, null when there is none.
const Corrugation* last_corrugation(const TorusScene& scene, const Frame& frame) {
  const int count = corrugation_count(scene, frame);
  if (count == 0 || scene.input.sampling.zooms) return nullptr;
  return &scene.input.corrugations[count - 1];
}

/// Largest distance of two points of a row, over a length of each inner point of windows.
double largest_way(const Eigen::MatrixX3d& before, const Eigen::MatrixX3d& after) {
  return (after - before).rowwise().norm().maxCoeff();
}

/// Rows of the inner points of windows, in the order of `window_forms`.
template <class Body>
void for_inner_rows(Eigen::Index rows, Body body) {
  constexpr int kReach = 2;
  for (Eigen::Index first = 0; first < rows; first += kWindowSide * kWindowSide)
    for (int j = kReach; j < kWindowSide - kReach; ++j)
      for (int i = kReach; i < kWindowSide - kReach; ++i) body(first + j * kWindowSide + i);
}

/// r of the loops that a corrugation of coefficient rho has on a metric: r^2 = |f_W|^2 + rho /
/// |V|^2.
double loop_radius(const WaveDirection& d, const FundamentalForm& f, double rho) {
  const auto form = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.x() * f.E + (a.x() * b.y() + a.y() * b.x()) * f.F + a.y() * b.y() * f.G;
  };
  const double uv = form(d.across, d.along);
  const double ww = form(d.across, d.across) - uv * uv / form(d.along, d.along);
  return std::sqrt(std::max(0., ww + rho / d.square()));
}

Value intersections_of(const TorusScene& scene, const Frame& frame, const std::string& name) {
  const Part* part = frame.find_part(name);
  if (part == nullptr) return std::nullopt;
  const Eigen::MatrixXd& at = part->require_array("parameters", NamedArray::On::points, 2).values;
  if (at.rows() < 2) return std::nullopt;
  const double step = at(1, 0) - at(0, 0);
  const double finest = finest_periods(scene.input, corrugation_count(scene, frame));
  if (!(kLeastSamples * step * finest <= 1)) return std::nullopt;
  return intersecting_pairs(part->points, part->triangles);
}

Value spread_of(const Frame& frame, const std::string& name) {
  const Part* part = frame.find_part(name);
  if (part == nullptr) return std::nullopt;
  const Eigen::MatrixX3d normals = triangle_normals({part->points, part->triangles});
  const Eigen::RowVector3d mean = normals.colwise().mean();
  constexpr double kCancelled = 1e-3;
  if (!(mean.norm() > kCancelled)) return std::nullopt;
  double sum = 0;
  for (Eigen::Index t = 0; t < normals.rows(); ++t) {
    const double angle = std::atan2(mean.cross(normals.row(t)).norm(), mean.dot(normals.row(t)));
    sum += angle * angle;
  }
  return std::sqrt(sum / static_cast<double>(normals.rows())) * 180 / std::numbers::pi;
}

}  // namespace

std::optional<DefaultMeasures> default_measures(const TorusScene& scene, const Frame& frame) {
  if (frame.find_part("windows") == nullptr) return std::nullopt;
  const auto forms = fine_forms(frame, "windows");
  DefaultMeasures out;
  out.mean = mean_default(forms);
  const std::size_t inside = forms.size() / frame.require_table("windows").rows.rows();
  double squares = 0;
  for (std::size_t first = 0; first < forms.size(); first += inside) {
    double sum = 0;
    for (std::size_t i = first; i < first + inside; ++i) {
      const double one = (kSquare - forms[i]).norm();
      out.largest = std::max(out.largest, one);
      sum += one;
    }
    const double off = sum / static_cast<double>(inside) - out.mean;
    squares += off * off;
  }
  const double windows = static_cast<double>(forms.size() / inside);
  out.deviation = std::sqrt(squares) / windows;
  const Corrugation* last = last_corrugation(scene, frame);
  // At the beginning nothing is wanted yet; later a frame has to say what it has come to.
  if (last == nullptr && frame.parameter > 0) return out;
  double wanted = 0, miss = 0;
  if (last != nullptr) {
    const int count = corrugation_count(scene, frame);
    std::size_t at = 0;
    for (const FundamentalForm& base : fine_forms(frame, "windows_base")) {
      const FundamentalForm missing = aim(base, last->share) - base;
      FundamentalForm ideal = base;
      for (int i = stage_base(scene.input, count - 1); i < count; ++i)
        ideal = with_part(ideal, missing, scene.input.corrugations[i].direction);
      wanted += (kSquare - ideal).norm();
      miss += (ideal - forms[at++]).norm();
    }
  }
  out.wanted = wanted / static_cast<double>(forms.size());
  out.miss = miss / static_cast<double>(forms.size());
  return out;
}

std::optional<CoarseMeasures> coarse_measures(const TorusScene& /*scene*/, const Frame& frame) {
  CoarseMeasures out;
  for (std::size_t k = 0; k < kCoarseSamples.size(); ++k) {
    const std::string name = "windows_" + std::to_string(kCoarseSamples[k]);
    const Part* part = frame.find_part(name);
    if (part == nullptr) return std::nullopt;
    out.mean[k] = mean_default(
        window_forms(part->points, kCoarseSide, step_of(frame, name), DifferenceOrder::second));
  }
  return out;
}

std::optional<CorrugationMeasures> corrugation_measures(const TorusScene& scene,
                                                        const Frame& frame) {
  const Corrugation* last = last_corrugation(scene, frame);
  if (last == nullptr) return std::nullopt;
  const WaveDirection& d = kDirections[last->direction];
  const auto before = fine_forms(frame, "windows_before"), base = fine_forms(frame, "windows_base");
  const auto after = fine_forms(frame, "windows");
  const Eigen::MatrixX3d& from = frame.require_part("windows_before").points;
  const Eigen::MatrixX3d& to = frame.require_part("windows").points;
  CorrugationMeasures out;
  out.way = largest_way(from, to);
  out.least_rho = std::numeric_limits<double>::infinity();
  std::size_t i = 0;
  for_inner_rows(to.rows(), [&](Eigen::Index row) {
    const FundamentalForm& f = before[i];
    const FundamentalForm missing = aim(base[i], last->share) - f;
    const double rho = coefficient(last->direction, missing.E, missing.F, missing.G);
    const double error = (with_part(f, missing, last->direction) - after[i]).norm();
    out.error += error;
    out.largest_error = std::max(out.largest_error, error);
    out.least_rho = std::min(out.least_rho, rho);
    const double bound = loop_radius(d, f, rho) / last->number;
    out.way_ratio = std::max(out.way_ratio, (to.row(row) - from.row(row)).norm() / bound);
    ++i;
  });
  out.error /= static_cast<double>(after.size());
  return out;
}

Value miss_ratio(const TorusScene& scene, const FrameSequence& frames) {
  const int count = static_cast<int>(scene.input.corrugations.size());
  if (scene.input.sampling.zooms || count == 0) return std::nullopt;
  if (frames.size() != scene.input.corrugations.size() + 1) return std::nullopt;
  double errors = 0;
  for (int i = stage_base(scene.input, count - 1); i < count; ++i)
    if (const auto measured = corrugation_measures(scene, *frames.frame(i + 1)))
      errors += measured->error;
  const auto measured = default_measures(scene, *frames.frame(count));
  if (!measured || !measured->miss || !(errors > 0)) return std::nullopt;
  return *measured->miss / errors;
}

LengthMeasures length_measures(const TorusScene& /*scene*/, const Frame& frame) {
  const auto ratio = [&](const char* name, double wanted) -> Value {
    const Part* part = frame.find_part(name);
    if (part == nullptr) return std::nullopt;
    return closed_curve_length(part->points) / wanted;
  };
  return {ratio("horizontal", 1), ratio("vertical", 1), ratio("diagonal", std::sqrt(5.))};
}

NormalMeasures normal_measures(const TorusScene& scene, const Frame& frame) {
  const Corrugation* last = last_corrugation(scene, frame);
  const Part* curve = frame.find_part("horizontal");
  if (last == nullptr || curve == nullptr) return {};
  // Along x a corrugation of any direction has its number of periods.
  std::vector<double> numbers;
  for (const Corrugation& c : scene.input.corrugations) {
    numbers.push_back(c.number);
    if (&c == last) break;
  }
  if (!std::is_sorted(numbers.begin(), numbers.end(), std::less_equal<>())) return {};
  std::vector<double> edges{std::sqrt(numbers.front())};
  for (std::size_t i = 0; i + 1 < numbers.size(); ++i)
    edges.push_back(std::sqrt(numbers[i] * numbers[i + 1]));
  edges.push_back(numbers.back() * std::max(2., numbers.back() / edges.back()));
  const Eigen::VectorXd power =
      band_power(curve_normals(curve->points, frame.require_part("horizontal_above").points,
                               frame.require_part("horizontal_below").points),
                 edges);
  NormalMeasures out{power(power.size() - 1), std::nullopt};
  if (numbers.size() >= 3 && power.minCoeff() > 0)
    out.slope = log_slope(numbers, {power.data(), numbers.size()});
  return out;
}

Intersections intersections(const TorusScene& scene, const Frame& frame) {
  return {intersections_of(scene, frame, "surface"), intersections_of(scene, frame, "detail")};
}

NormalSpread normal_spread(const TorusScene& /*scene*/, const Frame& frame) {
  return {spread_of(frame, "surface"), spread_of(frame, "detail")};
}

std::optional<PrintMeasures> print_measures(const TorusScene& /*scene*/, const Frame& frame) {
  const Part* body = frame.find_part("print");
  if (body == nullptr) return std::nullopt;
  const TriMesh mesh{body->points, body->triangles};
  return PrintMeasures{static_cast<double>(closedness(mesh).defects()),
                       static_cast<double>(intersecting_pairs(mesh.V, mesh.F)),
                       signed_volume(mesh.V, mesh.F)};
}

Value relief(const TorusScene& scene, const Frame& frame) {
  if (scene.input.sampling.zooms) return std::nullopt;
  const Part& surface = frame.require_part("surface");
  const Eigen::MatrixXd& at = surface.require_array("parameters", NamedArray::On::points, 2).values;
  double sum = 0;
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    const Eigen::Vector2d x = at.row(i);
    sum +=
        (surface.points.row(i).transpose() - revolution_point(scene.input.radii, x)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(at.rows()));
}

}  // namespace geoprior::torus
