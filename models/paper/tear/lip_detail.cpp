#include "models/paper/tear/lip_detail.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/angles.h"
#include "core/random.h"
#include "models/paper/contact/segments.h"
#include "models/paper/sheet/value_noise.h"
#include "models/paper/tear/lip_places.h"

namespace geoprior::paper {
namespace {

using Eigen::RowVector3d;
using Eigen::Vector2d;

constexpr int kOctaves = 4;
/// Rows of the lattice: of the octaves of the line and of the band's width, and of the fibres.
constexpr int kLineRow = 0, kBandRow = 8, kFibreRow = 16, kRowsOfALip = 4;
/// Shortest fibre over the longest, and narrowest band over the widest.
constexpr double kShortest = 0.3, kNarrowest = 0.4;
/// Shear out of the plane from which on the band is as wide as it gets.
constexpr double kFullShear = 0.25;

/// From 0 at 0 to 1 at 1, with level ends.
double smooth_step(double t) {
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// Fractal value noise of one variable, in [-1, 1].
double fractal_noise(double t, int row, std::uint64_t seed) {
  double sum = 0, most = 0, amplitude = 1;
  for (int octave = 0; octave < kOctaves; ++octave) {
    sum += amplitude * (2 * value_noise({t, row + octave}, seed) - 1);
    most += amplitude;
    amplitude /= 2;
    t *= 2;
  }
  return sum / most;
}

/// What has torn of a tear, by arc length.
class TornWay {
 public:
  explicit TornWay(const Tear& tear) : tear_(tear), from_(tear.torn_from()) {
    const int count = static_cast<int>(tear.path.size()) - from_;
    length_.assign(count, 0);
    for (int i = 1; i < count; ++i)
      length_[i] = length_[i - 1] + (tear.path[from_ + i] - tear.path[from_ + i - 1]).norm();
  }
  [[nodiscard]] double length() const { return length_.back(); }
  [[nodiscard]] Vector2d place(double s) const {
    const auto [step, t] = at(s);
    return (1 - t) * tear_.path[step - 1] + t * tear_.path[step];
  }
  /// Direction over a length `about` to both sides.
  [[nodiscard]] Vector2d direction(double s, double about) const {
    const Vector2d way = place(std::min(s + about, length())) - place(std::max(s - about, 0.0));
    if (way.norm() > 1e-6 * about) return way.normalized();
    const int step = at(s).first;
    return (tear_.path[step] - tear_.path[step - 1]).normalized();
  }
  /// From that of the step before to that of the step: later ones change nothing.
  [[nodiscard]] double shear(double s) const {
    const auto [step, t] = at(s);
    return (1 - t) * tear_.shear[std::max(step - 1, from_ + 1)] + t * tear_.shear[step];
  }

 private:
  /// The place that a step leads to, and how much of the step is done.
  [[nodiscard]] std::pair<int, double> at(double s) const {
    const auto next = std::lower_bound(length_.begin() + 1, length_.end() - 1, s);
    const auto i = static_cast<int>(next - length_.begin());
    const double step = length_[i] - length_[i - 1];
    const double t = step > 0 ? std::clamp((s - length_[i - 1]) / step, 0.0, 1.0) : 0;
    return {from_ + i, t};
  }

  const Tear& tear_;
  int from_;
  std::vector<double> length_;  // m, up to each place
};

/// Of a length from its ends, both in m: 1 but within `over` of them.
double fade_at_ends(double s, double length, double over) {
  return smooth_step(s / over) * smooth_step((length - s) / over);
}

TornPoint torn_point(const TornWay& way, double s, const LipDetailOptions& o, std::uint64_t seed) {
  TornPoint p;
  p.length = s;
  p.place = way.place(s);
  p.left = perpendicular(way.direction(s, LipDetailOptions::kSpacing));
  p.displacement = o.noise * fade_at_ends(s, way.length(), LipDetailOptions::kWave) *
                   fractal_noise(s / LipDetailOptions::kWave, kLineRow, seed);
  const double shear = way.shear(s);
  const double ragged =
      kNarrowest +
      (1 - kNarrowest) * (1 + fractal_noise(s / LipDetailOptions::kWave, kBandRow, seed)) / 2;
  if (o.bevel > 0)
    p.bevel = o.bevel * ragged * smooth_step(std::abs(shear) / kFullShear) *
              fade_at_ends(s, way.length(), o.bevel);
  p.bevel_lip = shear > 0 ? 0 : 1;
  return p;
}

/// Points of a part, with what they have in the pattern.
class LipPoints {
 public:
  int add(const RowVector3d& x, const Vector2d& pattern, int tear, int lip) {
    x_.push_back(x);
    values_.push_back(
        {pattern.x(), pattern.y(), static_cast<double>(tear), static_cast<double>(lip)});
    return static_cast<int>(x_.size()) - 1;
  }
  void put_into(Part& part) const {
    const Eigen::Index rows = x_.size();
    part.points.resize(rows, 3);
    Eigen::MatrixXd pattern(rows, 2), tear(rows, 1), lip(rows, 1);
    for (Eigen::Index i = 0; i < rows; ++i) {
      part.points.row(i) = x_[i];
      pattern.row(i) << values_[i][0], values_[i][1];
      tear(i, 0) = values_[i][2];
      lip(i, 0) = values_[i][3];
    }
    using On = NamedArray::On;
    part.arrays.push_back({"pattern", "m", On::points, pattern});
    part.arrays.push_back({"tear", "1", On::points, tear});
    part.arrays.push_back({"lip", "1", On::points, lip});
  }

 private:
  std::vector<RowVector3d> x_;
  std::vector<std::array<double, 4>> values_;  // pattern, tear, lip
};

/// Triangles along the lips.
class LipStrips {
 public:
  explicit LipStrips(const LipPlaces& places) : places_(places) {}

  void add(const std::vector<TornPoint>& line, int tear, int lip) {
    std::vector<Across> across;
    across.reserve(line.size());
    for (const TornPoint& p : line) across.push_back(across_at(p, tear, lip));
    for (std::size_t i = 1; i < across.size(); ++i) {
      const Across &a = across[i - 1], &b = across[i];
      const bool band = a.inner != a.base || b.inner != b.base;
      // Counter-clockwise in the pattern, as the sheet is.
      const bool left = lip == 0;
      const Across &first = left ? a : b, &second = left ? b : a;
      quad(first.edge, second.edge, second.base, first.base, band);
      quad(first.base, second.base, second.inner, first.inner, true);
    }
  }

  [[nodiscard]] Part part() const {
    Part part;
    points_.put_into(part);
    const Eigen::Index rows = triangles_.size();
    part.triangles.resize(rows, 3);
    Eigen::MatrixXd bevel(rows, 1);
    for (Eigen::Index f = 0; f < rows; ++f) {
      part.triangles.row(f) = triangles_[f];
      bevel(f, 0) = bevel_[f] ? 1 : 0;
    }
    part.arrays.push_back({"bevel", "1", NamedArray::On::cells, bevel});
    return part;
  }

 private:
  /// From the torn line over the lip to the end of the band: points, the same where two are one.
  struct Across {
    int edge = 0, base = 0, inner = 0;
  };

  Across across_at(const TornPoint& p, int tear, int lip) {
    const PatternLocator::Place at = places_.on_lip(p.place, p.left, lip);
    const Vector2d in = inwards(p.left, lip);
    Across across;
    across.base = points_.add(places_.in_plane_of(at.triangle, p.place), p.place, tear, lip);
    across.edge = across.inner = across.base;
    if (p.gain(lip) > 0) {
      const Vector2d edge = p.place - p.gain(lip) * in;
      across.edge = points_.add(places_.in_plane_of(at.triangle, edge), edge, tear, lip);
    }
    if (p.bevel_lip != lip) return across;
    constexpr int kTries = 4;  // the sheet may end within the band
    double depth = p.bevel;
    for (int i = 0; i < kTries && depth > 0; ++i, depth /= 2) {
      const auto inner = places_.behind_lip(p.place, p.left, lip, depth);
      if (!inner) continue;
      across.inner = points_.add(*inner, p.place + depth * in, tear, lip);
      break;
    }
    return across;
  }

  /// Two triangles, or what is left of them where corners are the same.
  void quad(int a, int b, int c, int d, bool bevel) {
    if (b != c) {
      triangles_.emplace_back(a, b, c);
      bevel_.push_back(bevel);
    }
    if (a != d) {
      triangles_.emplace_back(a, c, d);
      bevel_.push_back(bevel);
    }
  }

  const LipPlaces& places_;
  LipPoints points_;
  std::vector<Eigen::RowVector3i> triangles_;
  std::vector<bool> bevel_;
};

Part fibres_part(const std::vector<std::vector<Fibre>>& of_tears, const LipPlaces& places) {
  Part part;
  part.kind = Part::Kind::lines;
  LipPoints points;
  for (int t = 0; t < std::ssize(of_tears); ++t) {
    for (const Fibre& fibre : of_tears[t]) {
      const int triangle = places.on_lip(fibre.at.place, fibre.at.left, fibre.lip).triangle;
      std::vector<int>& line = part.lines.emplace_back();
      for (const Vector2d& p : {fibre.root, fibre.end})
        line.push_back(points.add(places.in_plane_of(triangle, p), p, t, fibre.lip));
    }
  }
  points.put_into(part);
  return part;
}

}  // namespace

std::vector<TornPoint> torn_line(const Tear& tear, const LipDetailOptions& options,
                                 std::uint64_t seed) {
  const TornWay way(tear);
  std::vector<TornPoint> line;
  if (!(way.length() > 0)) return line;
  const auto whole = static_cast<int>(std::ceil(way.length() / LipDetailOptions::kSpacing));
  for (int i = 0; i <= whole; ++i) {
    const double s = std::min(i * LipDetailOptions::kSpacing, way.length());
    TornPoint next = torn_point(way, s, options, seed);
    if (!line.empty() && line.back().displacement * next.displacement < 0) {
      const double before = std::abs(line.back().displacement);
      const double t = before / (before + std::abs(next.displacement));
      line.push_back(torn_point(way, (1 - t) * line.back().length + t * s, options, seed));
      line.back().displacement = 0;
    }
    line.push_back(next);
  }
  return line;
}

std::vector<Fibre> lip_fibres(const Tear& tear, const LipDetailOptions& options,
                              std::uint64_t seed) {
  const TornWay way(tear);
  std::vector<Fibre> fibres;
  if (!(way.length() > 0) || options.fibre_length == 0) return fibres;
  for (const int lip : {0, 1}) {
    const int row = kFibreRow + kRowsOfALip * lip;
    for (int k = 0;; ++k) {
      const double s = (k + lattice_value(k, row, seed)) * LipDetailOptions::kFibreSpacing;
      // Nearer to the tip the lips are not far enough apart for it.
      if (s > way.length() - options.fibre_length) break;
      Fibre& fibre = fibres.emplace_back();
      fibre.at = torn_point(way, s, options, seed);
      fibre.lip = lip;
      const Vector2d out = -inwards(fibre.at.left, lip);
      const double lean =
          LipDetailOptions::kFibreSpreadDeg * kDegree * (2 * lattice_value(k, row + 1, seed) - 1);
      const double length =
          options.fibre_length * (kShortest + (1 - kShortest) * lattice_value(k, row + 2, seed));
      fibre.root = fibre.at.place + fibre.at.gain(lip) * out;
      fibre.end = fibre.root + length * (Eigen::Rotation2Dd(lean) * out);
    }
  }
  return fibres;
}

std::uint64_t lip_seed(std::uint64_t texture, int tear) {
  RandomStream stream(texture, "lips of tear " + std::to_string(tear));
  const std::uint64_t high = stream.next();
  return high << 32 | stream.next();
}

void add_lip_detail(const Tears& tears, const LipDetailOptions& options, std::uint64_t texture,
                    const ShellState& state, Frame& frame) {
  const LipPlaces places(state, width(tears.torn()));
  LipStrips strips(places);
  std::vector<std::vector<Fibre>> fibres;
  for (int t = 0; t < static_cast<int>(tears.all().size()); ++t) {
    const Tear& tear = tears.all()[t];
    const std::uint64_t seed = lip_seed(texture, t);
    const std::vector<TornPoint> line = torn_line(tear, options, seed);
    for (const int lip : {0, 1}) strips.add(line, t, lip);
    fibres.push_back(lip_fibres(tear, options, seed));
  }
  frame.parts["lip_detail"] = strips.part();
  frame.parts["fibres"] = fibres_part(fibres, places);
}

void describe(OptionVisitor& v, LipDetailOptions& o) {
  v.value("on", o.on, {.doc = "adds the parts lip_detail and fibres to every frame"});
  v.value("noise", o.noise,
          {.doc = "farthest that the torn line leaves the way of the tip; 0: straight lips",
           .unit = "m",
           .min = 0,
           .max = 0.1});
  v.value(
      "fibre_length", o.fibre_length,
      {.doc = "length of the longest fibres of a lip; 0: none", .unit = "m", .min = 0, .max = 0.1});
  v.value("bevel", o.bevel,
          {.doc = "greatest width of the band along a lip; 0: none",
           .unit = "m",
           .min = 0,
           .max = 0.1});
}

}  // namespace geoprior::paper
