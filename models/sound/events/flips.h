#pragma once

#include <array>
#include <vector>

#include "core/options.h"
#include "core/state_bytes.h"
#include "models/sound/resonators/grid.h"

namespace geoprior::sound {

/// When a change of the curvature's sign is sudden enough to be heard.
struct FlipOptions {
  double threshold = 5;
  double sudden = 0.04;
  double refractory = 0.02;
  double together = 0.02;
  double least_area = 5e-5;
  bool remeshing = false;
};
void describe(OptionVisitor& v, FlipOptions& options);

/// A cell whose curvature has changed its sign.
struct CellFlip {
  int cell = 0;
  double time = 0;      ///< at which it passed zero (s)
  double duration = 0;  ///< from one threshold to the other (s)
  double before = 0;    ///< largest |k| before it left its threshold, of late (1/m)
  double after = 0;     ///< curvature when it had its new sign (1/m)
};

/// Flips that neighbouring cells made together: one event.
struct FlipCluster {
  std::vector<CellFlip> flips;  ///< in order of time, then cell
  [[nodiscard]] double time() const { return flips.front().time; }
  [[nodiscard]] double area(const SoundGrid& grid) const {
    return static_cast<double>(flips.size()) * grid.cell_area();
  }
};

/// Finds sudden changes of the sign of curvature (thesis 3.2.3), cell by cell.
///
/// A cell has a sign while |k| >= k_min, k linear in time between two frames. It flips when it
/// reaches k_min on the other side no later than `sudden` after it left k_min on the old one: both
/// times are interpolated, so that what is found depends on the frame interval no more than k does.
/// Cells that hold together and flip within `together` of the first of them are one event.
///
/// A flip begins and ends on one mesh. Where a cell's curvature is read from other triangles than
/// in the frame before (`SheetField::remeshed`), its change is the remeshing's, or nobody knows
/// whose: the cell begins anew, with the sign that it has on the new mesh, or none. What snaps in
/// that frame elsewhere is heard; what snaps in a cell just as its mesh changes is not. A mesh that
/// changes everywhere in every frame is silent: how much of a sheet is not listened to is what
/// `remeshed_share` says, and counts of events mean nothing without it.
class FlipDetector {
 public:
  FlipDetector(const SoundGrid& grid, const FlipOptions& options);
  /// Takes the next frame. @return the events that no later flip can join, in order of time
  std::vector<FlipCluster> push(const SheetField& field);
  /// What is left when the animation ends.
  std::vector<FlipCluster> finish();

  void save(StateWriter& out) const;
  void load(StateReader& in);

 private:
  struct Cell {
    double curvature = 0;   ///< in the last frame
    double peak = 0;        ///< of the sign it has, forgotten within `sudden`
    double left = -1e9;     ///< when it was last beyond k_min (s)
    double flipped = -1e9;  ///< last (s)
    int sign = 0;           ///< that it had there; 0: never
  };
  [[nodiscard]] std::vector<CellFlip> flips_of(const SheetField& field);
  void begin_anew(Cell& cell, const SheetField& field, double curvature) const;
  std::vector<FlipCluster> take(double until);

  const SoundGrid& grid_;
  FlipOptions options_;
  std::vector<Cell> cells_;
  double time_ = 0;  ///< of the last frame (s)
  bool started_ = false;
  std::vector<CellFlip> pending_;          ///< of events that others may join
  std::vector<std::array<char, 4>> held_;  ///< whether cells with flips hold to their neighbours
};

}  // namespace geoprior::sound
