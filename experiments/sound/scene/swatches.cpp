#include "experiments/sound/scene/swatches.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior::sound {
namespace {

using Eigen::Vector2d;

enum class Support { free, clamped, bent };

struct Swatch {
  double ruling = 0, width = 0;  // m
  Support support = Support::free;
  double curvature = 0;   // before its snap (1/m)
  Vector2d corner{0, 0};  // of the pattern, lowest u and v (m)
  double snaps = 0;       // when its curvature is zero (s)
};

std::vector<Swatch> swatches_of(const SwatchOptions& options) {
  for (const auto& [list, name] :
       {std::pair{&options.rulings, "rulings"}, std::pair{&options.widths, "widths"}}) {
    const std::string where = "scene.swatches." + std::string(name);
    if (list->empty()) throw Error("is empty", where, "lengths in metres");
    for (const double x : *list) {
      if (!(x >= 1e-3 && x <= 1)) throw Error("is " + std::to_string(x), where, "0.001 to 1 m");
    }
  }
  std::vector<Swatch> all;
  for (const Support support : {Support::free, Support::clamped, Support::bent}) {
    for (const double ruling : options.rulings) {
      for (const double width : options.widths) {
        Swatch& one = all.emplace_back(Swatch{ruling, width, support});
        one.curvature = support == Support::bent ? std::min(options.bent, 2 / width) : options.flat;
        one.snaps = static_cast<double>(all.size()) * options.interval;
      }
    }
  }
  return all;
}

/// Lays them in rows, a centimetre apart. @return the size of the table
Vector2d lay_out(std::vector<Swatch>& swatches) {
  constexpr double kGap = 0.01;  // m
  double area = 0, longest = 0;
  for (const Swatch& one : swatches) {
    area += (one.width + kGap) * (one.ruling + kGap);
    longest = std::max(longest, one.width);
  }
  const double row = std::max(longest, std::sqrt(1.2 * area));
  std::vector<Swatch*> tall_first;
  for (Swatch& one : swatches) tall_first.push_back(&one);
  std::stable_sort(tall_first.begin(), tall_first.end(),
                   [](const Swatch* a, const Swatch* b) { return a->ruling > b->ruling; });
  Vector2d at(0, 0), size(0, 0);
  double height = 0;
  for (Swatch* one : tall_first) {
    if (at.x() > 0 && at.x() + one->width > row) {
      at = {0, at.y() + height + kGap};
      height = 0;
    }
    one->corner = at;
    at.x() += one->width + kGap;
    height = std::max(height, one->ruling);
    size = size.cwiseMax(one->corner + Vector2d(one->width, one->ruling));
  }
  for (Swatch& one : swatches) one.corner -= size / 2;
  return size;
}

class Swatches final : public SheetAnimation {
 public:
  Swatches(std::vector<Swatch> swatches, const SwatchOptions& options)
      : swatches_(std::move(swatches)), snap_(options.snap) {
    times_.push_back(0);
    for (const Swatch& one : swatches_) {
      times_.push_back(one.snaps - snap_ / 2);
      times_.push_back(one.snaps + snap_ / 2);
    }
    times_.push_back(swatches_.back().snaps + options.interval);
    for (const Swatch& one : swatches_) append(one);
  }

  [[nodiscard]] int frame_count() const override { return static_cast<int>(times_.size()); }
  [[nodiscard]] double time(int frame) const override { return times_.at(frame); }
  [[nodiscard]] std::string name() const override { return "scene.swatches"; }

  [[nodiscard]] SheetSnapshot snapshot(int frame) const override {
    SheetSnapshot out;
    out.time = time(frame);
    out.mesh = mesh_;
    out.x.resize(mesh_.vertex_count(), 3);
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      const Swatch& one = swatches_[owner_[v]];
      const double turned = std::clamp((out.time - one.snaps) / snap_ + 0.5, 0.0, 1.0);
      const double k = one.curvature * (1 - 2 * turned);
      // Bent about the edge that is clamped, else about the middle.
      const double from = one.support == Support::clamped ? 0 : one.width / 2;
      const double s = mesh_.pattern(v, 0) - one.corner.x() - from;
      const bool straight = std::abs(k) < 1e-9;
      out.x.row(v) << one.corner.x() + from + (straight ? s : std::sin(k * s) / k),
          mesh_.pattern(v, 1), (straight ? 0 : (1 - std::cos(k * s)) / k);
    }
    return out;
  }

 private:
  /// A structured grid of squares of 4 mm and less, four at least across.
  void append(const Swatch& one) {
    constexpr double kEdge = 4e-3;  // m
    const int nu = std::max(4, static_cast<int>(std::ceil(one.width / kEdge)));
    const int nv = std::max(4, static_cast<int>(std::ceil(one.ruling / kEdge)));
    const auto first = static_cast<int>(mesh_.pattern.rows());
    mesh_.pattern.conservativeResize(first + (nu + 1) * (nv + 1), 2);
    for (int b = 0; b <= nv; ++b) {
      for (int a = 0; a <= nu; ++a) {
        mesh_.pattern.row(first + b * (nu + 1) + a) =
            one.corner.transpose() + Eigen::RowVector2d(one.width * a / nu, one.ruling * b / nv);
        owner_.push_back(static_cast<int>(&one - swatches_.data()));
      }
    }
    Eigen::Index t = mesh_.triangles.rows();
    mesh_.triangles.conservativeResize(t + 2 * nu * nv, 3);
    for (int b = 0; b < nv; ++b) {
      for (int a = 0; a < nu; ++a) {
        const int p = first + b * (nu + 1) + a, q = p + 1, u = p + nu + 1, r = u + 1;
        mesh_.triangles.row(t++) << p, q, ((a + b) % 2 == 0 ? r : u);
        mesh_.triangles.row(t++) << ((a + b) % 2 == 0 ? p : q), r, u;
      }
    }
  }

  std::vector<Swatch> swatches_;
  double snap_;
  std::vector<double> times_;
  ShellMesh mesh_;
  std::vector<int> owner_;  ///< swatch of each vertex
};

/// A hand that holds the edge from which a clamped swatch is bent.
Handle clamp_of(const Swatch& one) {
  Handle hand;
  hand.name = "clamp";
  hand.segment = {one.corner, Vector2d(one.corner.x(), one.corner.y() + one.ruling)};
  hand.motion = Trajectory{{Keyframe{}}};
  return hand;
}

}  // namespace

void describe(OptionVisitor& v, SwatchOptions& o) {
  v.value("rulings", o.rulings, {.doc = "lengths of swatches along their rulings", .unit = "m"});
  v.value("widths", o.widths,
          {.doc = "lengths across the rulings of swatches, each with each length along them",
           .unit = "m"});
  v.value(
      "flat", o.flat,
      {.doc = "curvature before and after a snap, of flat swatches", .unit = "1/m", .min = 1e-3});
  v.value("bent", o.bent,
          {.doc = "curvature of bent swatches before and after a snap, or two over the width where "
                  "that is less",
           .unit = "1/m",
           .min = 1e-3});
  v.value("snap", o.snap,
          {.doc = "time that a swatch takes to snap", .unit = "s", .min = 1e-6, .max = 1});
  v.value("interval", o.interval,
          {.doc = "time from a snap to the next", .unit = "s", .min = 1e-3, .max = 10});
}

std::shared_ptr<const SheetAnimation> make_swatches(const SwatchOptions& options, Sheet& sheet) {
  if (!(options.snap < options.interval)) {
    throw Error("is no shorter than the interval", "scene.swatches.snap",
                "less than " + std::to_string(options.interval) + " s");
  }
  std::vector<Swatch> swatches = swatches_of(options);
  const Vector2d size = lay_out(swatches);
  sheet.pattern = paper::rectangle_pattern(size.x(), size.y());
  sheet.handles.clear();
  for (const Swatch& one : swatches) {
    if (one.support == Support::clamped) sheet.handles.push_back(clamp_of(one));
  }
  return std::make_shared<Swatches>(std::move(swatches), options);
}

}  // namespace geoprior::sound
