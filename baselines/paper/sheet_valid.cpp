#include <cmath>
#include <limits>
#include <sstream>

#include "baselines/paper/sheet_checks.h"
#include "core/error.h"

namespace geoprior {
namespace sheet_checks {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string text(double x) {
  std::ostringstream out;
  out << x;
  return out.str();
}

}  // namespace

std::string inside(const std::string& where, const std::string& key) {
  return where.empty() ? key : where + "." + key;
}

void require_finite(double x, const std::string& where) {
  if (!std::isfinite(x)) throw Error("is not finite", where, "a finite number");
}

void require_range(double x, double low, double high, bool open, const std::string& where) {
  require_finite(x, where);
  if ((open ? x > low : x >= low) && x <= high) return;
  std::string allowed = (open ? "more than " : "at least ") + text(low);
  if (high < kInfinity) allowed += ", at most " + text(high);
  throw Error(text(x) + " is out of range", where, allowed);
}

void require_material(const PaperMaterial& material, const std::string& where) {
  const auto positive = [&](double x, const char* key) {
    require_range(x, 0, kInfinity, true, inside(where, key));
  };
  const auto not_negative = [&](double x, const char* key) {
    require_range(x, 0, kInfinity, false, inside(where, key));
  };
  positive(material.thickness, "thickness");
  positive(material.young_modulus, "young_modulus");
  require_range(material.poisson_ratio, 0, 0.499, false, inside(where, "poisson_ratio"));
  positive(material.area_density, "area_density");
  positive(material.yield_curvature, "yield_curvature");
  not_negative(material.weakening, "weakening");
  not_negative(material.friction, "friction");
  not_negative(material.damping, "damping");
}

void require_trajectory(const Trajectory& trajectory, const std::string& where) {
  if (trajectory.keys.empty()) throw Error("has no key", where, "at least one");
  for (std::size_t i = 0; i < trajectory.keys.size(); ++i) {
    const Keyframe& key = trajectory.keys[i];
    const std::string at = where + "." + std::to_string(i);
    require_finite(key.time, inside(at, "t"));
    for (int c = 0; c < 3; ++c) require_finite(key.shift[c], inside(at, "move"));
    for (int c = 0; c < 4; ++c) require_finite(key.turn.coeffs()[c], inside(at, "turn_deg"));
    if (std::abs(key.turn.norm() - 1) > 1e-6) {
      throw Error("is no rotation", inside(at, "turn_deg"), "a unit quaternion");
    }
    if (i > 0 && key.time <= trajectory.keys[i - 1].time) {
      throw Error(
          "time " + text(key.time) + " does not follow " + text(trajectory.keys[i - 1].time),
          inside(at, "t"), "strictly increasing times");
    }
  }
}

}  // namespace sheet_checks

void require_valid(const Sheet& sheet, const std::string& where) {
  using namespace sheet_checks;
  require_simple(sheet.pattern, inside(where, "pattern"));
  require_material(sheet.material, inside(where, "material"));
  for (int c = 0; c < 3; ++c) require_finite(sheet.gravity[c], inside(where, "gravity"));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) {
      require_finite(sheet.placement.matrix()(i, j), inside(where, "placement"));
    }
  }
  require_range(sheet.imperfection, 0, width(sheet.pattern), false, inside(where, "imperfection"));
  require_range(sheet.duration, 0, 1e6, true, inside(where, "duration"));
  require_range(sheet.frame_interval, 0, sheet.duration, true, inside(where, "frame_interval"));
  require_range(sheet.substeps, 1, 1e6, false, inside(where, "substeps"));
  require_handles(sheet, inside(where, "handles"));
  require_obstacles(sheet, inside(where, "obstacles"));
}

}  // namespace geoprior
