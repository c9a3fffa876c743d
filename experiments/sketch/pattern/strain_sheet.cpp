#include "experiments/sketch/pattern/strain_sheet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/angles.h"
#include "experiments/sketch/pattern/sheet_text.h"

namespace geoprior::sketch {
namespace {

constexpr int kStrainLevels = 12;     ///< of colour, to either side of none
constexpr double kStrainMargin = 15;  ///< around everything (mm)
constexpr double kStrainText = 4;     ///< height (mm)
constexpr double kStrainFooter = 38;  ///< title and colour bar (mm)
constexpr double kBarBox = 8;         ///< width of a level in the bar (mm)
constexpr double kWorstRadius = 3;    ///< of the mark of the worst place (mm)
constexpr double kLeastSheet = 240;   ///< width, for title and bar (mm)

int level_of(double strain) {
  const double share = std::clamp(strain / kColouredStrain, -1.0, 1.0);
  return static_cast<int>(std::lround(kStrainLevels * share));
}

double strain_of_level(int level) { return kColouredStrain * level / kStrainLevels; }

std::u32string strain_text(const std::string& utf8, std::size_t most = 200) {
  return label_text(utf8, most);
}

class StrainDrawing {
 public:
  StrainDrawing(const Pattern& pattern, const Eigen::MatrixX3d& surface,
                const std::vector<PieceVerdict>& verdicts)
      : pattern_(pattern), surface_(surface), verdicts_(verdicts) {
    for (const PatternPiece& piece : pattern.pieces) {
      for (Eigen::Index i = 0; i < piece.points.rows(); ++i)
        box_.extend(Eigen::Vector2d(1000 * piece.points.row(i).transpose()));
    }
    shift_ = Eigen::Vector2d(kStrainMargin, kStrainMargin + kStrainFooter) - box_.min();
    sheet_.size =
        box_.sizes() + Eigen::Vector2d(2 * kStrainMargin, 2 * kStrainMargin + kStrainFooter);
    sheet_.size.x() = std::max(sheet_.size.x(), kLeastSheet);
  }

  StrainSheet draw() {
    for (std::size_t k = 0; k < pattern_.pieces.size(); ++k) {
      colour(pattern_.pieces[k]);
      outline(pattern_.pieces[k]);
      write(static_cast<int>(k));
    }
    draw_bar();
    for (auto& [level, patch] : patches_) {
      patch.colour = strain_colour(strain_of_level(level));
      sheet_.patches.push_back(std::move(patch));
    }
    return std::move(sheet_);
  }

 private:
  [[nodiscard]] Eigen::Vector2d on_sheet(const Eigen::Vector2d& p) const {
    return 1000 * p + shift_;
  }

  void colour(const PatternPiece& piece) {
    const Eigen::VectorXd strain = signed_strain(piece, surface_);
    for (Eigen::Index t = 0; t < strain.size(); ++t) {
      std::array<Eigen::Vector2d, 3> corners;
      for (int k = 0; k < 3; ++k)
        corners[k] = on_sheet(piece.points.row(piece.triangles(t, k)).transpose());
      patches_[level_of(strain(t))].triangles.push_back(corners);
    }
  }

  void outline(const PatternPiece& piece) {
    for (const std::vector<int>& border : piece.borders) {
      SheetLine line{SheetLayer::sew, true, {}, 0};
      for (const int v : border) line.points.push_back(on_sheet(piece.points.row(v).transpose()));
      sheet_.outlines.push_back(std::move(line));
    }
  }

  /// Worst place, suggested cut, and below the piece its name and verdict.
  void write(int piece) {
    const PieceVerdict& verdict = verdicts_[piece];
    if (verdict.worst > kTakenStrain) mark(on_sheet(verdict.worst_flat));
    for (const std::vector<Eigen::Vector2d>& cut : verdict.seam.lines) {
      SheetLine line{SheetLayer::fold, false, {}, 0};
      for (const Eigen::Vector2d& p : cut) line.points.push_back(on_sheet(p));
      sheet_.added.push_back(std::move(line));
    }
    Eigen::AlignedBox2d box;
    const PatternPiece& flat = pattern_.pieces[piece];
    for (Eigen::Index i = 0; i < flat.points.rows(); ++i)
      box.extend(on_sheet(flat.points.row(i).transpose()));
    const std::string name =
        "'" + flat.name + "'" + (verdict.refused.empty() ? "" : " REFUSED: " + verdict.refused);
    const Eigen::Vector2d below(box.center().x(), box.min().y());
    write_below(below, 1, box.sizes().x(), strain_text(name));
    write_below(below, 2.4, box.sizes().x(), strain_text(short_verdict(verdict)));
    if (verdict.seam.lines.empty()) return;
    write_below(below, 3.8, box.sizes().x(),
                verdict.seam.is_dart ? U"add a dart along the dashed line"
                                     : U"add a seam along the dashed line");
  }

  void write_below(const Eigen::Vector2d& below, double lines, double room,
                   const std::u32string& text) {
    const double fits = (room + kStrainMargin) / helvetica_width(text);
    const double height = std::clamp(fits, 0.5 * kStrainText, kStrainText);
    sheet_.texts.push_back({below - Eigen::Vector2d(0, lines * kStrainText), height, text});
  }

  void mark(const Eigen::Vector2d& at) {
    constexpr int kSides = 16;
    SheetLine circle{SheetLayer::text, true, {}, 0};
    for (int i = 0; i < kSides; ++i) {
      const double angle = kFullTurn * i / kSides;
      circle.points.emplace_back(at +
                                 kWorstRadius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    sheet_.worst.push_back(std::move(circle));
    for (const Eigen::Vector2d& d : {Eigen::Vector2d(1, 1), Eigen::Vector2d(1, -1)}) {
      const Eigen::Vector2d half = 0.7 * kWorstRadius * d;
      sheet_.worst.push_back({SheetLayer::text, false, {at - half, at + half}});
    }
  }

  void draw_bar() {
    const Eigen::Vector2d corner(kStrainMargin, kStrainMargin);
    for (int level = -kStrainLevels; level <= kStrainLevels; ++level) {
      const Eigen::Vector2d low = corner + Eigen::Vector2d(kBarBox * (level + kStrainLevels), 0);
      const Eigen::Vector2d high = low + Eigen::Vector2d(kBarBox, 6);
      const Eigen::Vector2d right(high.x(), low.y()), left(low.x(), high.y());
      patches_[level].triangles.push_back({low, right, high});
      patches_[level].triangles.push_back({low, high, left});
      if (level % (kStrainLevels / 2) != 0) continue;
      const auto per_cent = std::lround(100 * strain_of_level(level));
      sheet_.texts.push_back(
          {low + Eigen::Vector2d(kBarBox / 2, -4), 3.5,
           strain_text((per_cent > 0 ? "+" : "") + std::to_string(per_cent) + " %")});
    }
    const Eigen::Vector2d size((2 * kStrainLevels + 1) * kBarBox, 6);
    sheet_.outlines.push_back({SheetLayer::sew,
                               true,
                               {corner, corner + Eigen::Vector2d(size.x(), 0), corner + size,
                                corner + Eigen::Vector2d(0, size.y())}});
    sheet_.texts.push_back({corner + Eigen::Vector2d(0, 11), 3.5,
                            U"blue: the surface is shorter than the pattern; green: lengths are "
                            U"kept; red: longer. Circles: worst place. Dashed: suggested cuts.",
                            TextAnchor::left});
    sheet_.texts.push_back({corner + Eigen::Vector2d(0, 18), 5,
                            U"Strain of the pieces, not to cut by", TextAnchor::left});
  }

  const Pattern& pattern_;
  const Eigen::MatrixX3d& surface_;
  const std::vector<PieceVerdict>& verdicts_;
  Eigen::AlignedBox2d box_;
  Eigen::Vector2d shift_{0, 0};
  std::map<int, StrainPatch> patches_;
  StrainSheet sheet_;
};

}  // namespace

Eigen::Vector3d strain_colour(double strain) {
  const Eigen::Vector3d kept(0.35, 0.75, 0.35), longer(0.85, 0.10, 0.10), shorter(0.10, 0.20, 0.85);
  const double share = std::clamp(std::abs(strain) / kColouredStrain, 0.0, 1.0);
  return (1 - share) * kept + share * (strain > 0 ? longer : shorter);
}

StrainSheet strain_sheet(const Pattern& pattern, const Eigen::MatrixX3d& surface,
                         const std::vector<PieceVerdict>& verdicts) {
  return StrainDrawing(pattern, surface, verdicts).draw();
}

}  // namespace geoprior::sketch
