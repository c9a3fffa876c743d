#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "experiments/sketch/drawing/silhouette_loops.h"
#include "models/sketch/drawing/stroke.h"

namespace geoprior::sketch {

/// How far strokes that were drawn by hand are put right.
struct HandDrawnOptions {
  double snap = 0.05;   ///< gaps and double lines, over the diagonal of the view
  bool fairing = true;  ///< whether tremor is taken off
  double noise = 0.02;  ///< largest tremor, over the diagonal
};

/// What a program draws meets to this share of the view's diagonal; wider gaps are warned of.
inline constexpr double kExactSnap = 0.005;

/// Puts the strokes of one view right, and says what it moved by how much. What was drawn exactly
/// is left as it is.
class HandDrawnView {
 public:
  /// @param where     "boot.svg: view:side", for warnings and errors
  /// @param diagonal  of the box of the view's strokes (m)
  HandDrawnView(std::string where, double diagonal, const HandDrawnOptions& options,
                std::vector<std::string>& warnings)
      : where_(std::move(where)), diagonal_(diagonal), options_(options), warnings_(warnings) {}

  /// Closed silhouettes: joined as they are, else over wider gaps, else without double lines.
  /// @throws Error  a tremor beyond `noise`
  [[nodiscard]] SilhouetteLoops silhouettes(const std::vector<Stroke>& strokes);
  /// A trembling stroke of another kind; when silhouettes tremble, fewer turns tell that it does.
  /// @throws Error  as `silhouettes`
  void fair(Stroke& stroke) const;
  /// A border beside the silhouette is laid onto it, its ends to corners that are near.
  void lay_on_silhouette(Stroke& border, const Stroke& silhouette) const;

  /// "2.3 mm (1.2 % of the view's diagonal)".
  [[nodiscard]] std::string share_text(double metres) const;

 private:
  struct Attempt {
    SilhouetteLoops loops;
    std::vector<std::string> notes;
    bool good = false;  ///< one simple loop
    bool trembles = false;
  };
  [[nodiscard]] Attempt attempt(const std::vector<Stroke>& strokes, double snap) const;
  /// Whether it trembled.
  bool fair(Stroke& stroke, int changes, std::vector<std::string>& notes) const;

  std::string where_;
  double diagonal_;
  const HandDrawnOptions& options_;
  std::vector<std::string>& warnings_;
  bool trembles_ = false;  ///< one of the silhouettes
};

}  // namespace geoprior::sketch
