#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/paper/scene/svg_pattern.h"
#include "models/paper/sheet/sheet.h"
#include "testbed/keyframes.h"

namespace geoprior::paper {

/// A point of the pattern (m).
struct PatternPointOptions {
  double u = 0, v = 0;
};
void describe(OptionVisitor& v, PatternPointOptions& options);

/// One of `holes` of a pattern.
struct HoleOptions {
  std::vector<PatternPointOptions> points;
};
void describe(OptionVisitor& v, HoleOptions& options);

/// One of `cuts` of a pattern.
struct CutOptions {
  std::vector<PatternPointOptions> points;
};
void describe(OptionVisitor& v, CutOptions& options);

enum class PatternKind { rectangle, disc, polygon, svg };

/// `pattern`: a tagged choice, `kind` selects which of the others are described.
struct PatternOptions {
  PatternKind kind = PatternKind::rectangle;
  double width = 0.21;    ///< rectangle: along u (m)
  double height = 0.297;  ///< along v (m)
  double radius = 0.1;    ///< disc (m)
  int corners = 96;
  std::vector<PatternPointOptions> points;  ///< polygon
  std::vector<HoleOptions> holes;           ///< of rectangle, disc and polygon
  std::vector<CutOptions> cuts;
  std::string file;  ///< svg
  SvgPatternOptions svg;
};
void describe(OptionVisitor& v, PatternOptions& options);

struct IntervalOptions {
  double from = 0, to = 0;
};
void describe(OptionVisitor& v, IntervalOptions& options);

struct DiscOptions {
  double u = 0, v = 0;
  double radius = 0.01;
};
void describe(OptionVisitor& v, DiscOptions& options);

/// One of `handles`.
struct HandleOptions {
  std::string name;
  std::vector<PatternPointOptions> points;
  std::vector<double> segment;  ///< u v of both ends; empty: none
  std::optional<DiscOptions> disc;
  std::vector<KeyOptions> keys;
  std::optional<double> stiffness;
  std::vector<double> force;  ///< x y z (N); empty: none
  std::vector<IntervalOptions> active;
};
void describe(OptionVisitor& v, HandleOptions& options);

struct RadiusKeyOptions {
  double t = 0;
  double radius = 0.1;
};
void describe(OptionVisitor& v, RadiusKeyOptions& options);

/// One of `obstacles`.
struct ObstacleOptions {
  Obstacle::Kind kind = Obstacle::Kind::plane;
  std::string name;
  std::array<double, 3> centre{0, 0, 0};
  std::array<double, 3> axis{0, 0, 1};
  double radius = 0.1;
  double tube_radius = 0.002;
  double half_length = 0;
  std::vector<KeyOptions> keys;
  std::vector<RadiusKeyOptions> radii;
};
void describe(OptionVisitor& v, ObstacleOptions& options);

/// `toughness`: absent, the paper does not tear.
struct ToughnessOptions {
  std::optional<double> energy;
  double noise = 0;
  double noise_length = 3e-3;
  int seed = 1;
  std::optional<double> grain_deg;
  double across = 1;
};
void describe(OptionVisitor& v, ToughnessOptions& options);

/// Largest coefficient of friction that is taken.
inline constexpr double kRoughest = 100;

void describe(OptionVisitor& v, PaperMaterial& options);
/// Of these, what a flat elastic sheet has: thickness, stiffness and mass.
void describe_plate(OptionVisitor& v, PaperMaterial& options);

}  // namespace geoprior::paper
