#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "models/paper/shell/stepper.h"
#include "models/paper/tear/options.h"
#include "models/paper/tear/tears.h"
#include "models/paper/tear/tip_pull.h"

namespace geoprior::paper {

/// A place where the sheet may tear, and the tear whose tip it is.
struct TearCandidate {
  Eigen::Vector2d place;
  std::optional<int> tear;
  bool on_flaw = false;  ///< it tears by the tension there, from a flaw: nothing concentrates it
  /// The hole, at which a tear has ended, on whose border it lies where the tension along that is
  /// greatest (`greatest_hoop_tension`); `place` is then known when the sheet has been looked at.
  std::optional<int> hole = {};
};

/// Tips of tears, corners of the border at which the sheet lies on the larger side, and places
/// where it is held: those of the thesis' candidates that need no structure. Of a hole that a tear
/// has run into and none has left, not its corners, which are its polygon's, but the place where
/// its border is stretched most.
std::vector<TearCandidate> plain_candidates(const Sheet& sheet, const Tears& tears);

/// Whether a point lies on the border of a hole that a tear has run into.
bool is_on_entered_hole(const Sheet& sheet, const Tears& tears, const Eigen::Vector2d& p);

/// Tears that grow while the energy they release exceeds what the paper opposes (Griffith; thesis
/// 3.2.2): E_r of `TipPull::released` against E_f = K T, of the sheet at rest: a pull that goes,
/// or does not settle, when the sheet relaxes tears nothing. After each step of a tear the sheet is
/// meshed anew and relaxes. While a sheet swings, its pulls come and go: after one, two, three time
/// steps in a row in vain, as many are not looked at, for 15 ms at most.
class TearGrowth {
 public:
  TearGrowth(const Sheet& sheet, const TearOptions& options);

  /// Since the start.
  struct Totals {
    double energy = 0;    ///< that tearing took: the integral of E_f over the torn section (J)
    double released = 0;  ///< by which the sheet's elastic energy fell in the steps of tears (J)
    int tested = 0;       ///< candidates looked at
    int steps = 0;
    int given_up = 0;  ///< tears that end where there is no mesh, or less than `least_part`, ahead
  };
  /// The last pull under which a tear grew.
  struct LastPull {
    double force = 0, angle = 0;  ///< N, rad
  };

  /// What follows the tears: the mesh, and what it is made from.
  struct Follower {
    std::function<void(ShellState&)> remesh;  ///< takes a state to a mesh open along tears().torn()
    std::function<void()> take_back = [] {};  ///< the last `remesh`, the tears being what they were
  };
  using Candidates = std::function<std::vector<TearCandidate>()>;
  /// Grows tears as far as the pulls go, the strongest first; the stepper has the state's mesh
  /// before and after.
  /// @return  steps taken
  int grow(const Candidates& candidates, const Follower& follower, ShellStepper& stepper,
           ShellState& state);

  [[nodiscard]] const Tears& tears() const { return tears_; }
  [[nodiscard]] const LipDetailOptions& detail() const { return options_.detail; }
  [[nodiscard]] std::uint64_t seed() const { return sheet_.toughness.seed; }  ///< of the texture
  [[nodiscard]] const Totals& totals() const { return totals_; }
  [[nodiscard]] const LastPull& last_pull() const { return last_pull_; }

  void save(StateWriter& out) const;
  void load(StateReader& in);

 private:
  struct Growing {
    TearCandidate candidate;
    TipPull pull;
    Eigen::Vector2d direction;
    double excess = 0;  ///< E_r / E_f
  };
  [[nodiscard]] double nearest_tip(const TearCandidate& candidate) const;
  [[nodiscard]] double clear_reach(const TearCandidate& candidate, double time) const;
  [[nodiscard]] std::optional<TipPull> pull_of(TearCandidate& candidate,
                                               const ShellStepper& stepper, const ShellState& state,
                                               const MeshNeighbours& neighbours) const;
  [[nodiscard]] bool is_given_up(const TearCandidate& candidate) const;
  [[nodiscard]] std::optional<TipPull> pull_on(const TearCandidate& candidate, int vertex,
                                               const ShellStepper& stepper, const ShellState& state,
                                               const MeshNeighbours& neighbours) const;
  [[nodiscard]] std::optional<Growing> look_at(TearCandidate candidate, const ShellStepper& stepper,
                                               const ShellState& state,
                                               const MeshNeighbours& neighbours) const;
  [[nodiscard]] std::optional<Growing> at_rest(Growing growing, ShellStepper& stepper,
                                               ShellState state,
                                               const MeshNeighbours& neighbours) const;
  [[nodiscard]] Eigen::Vector2d course(const Growing& growing) const;
  [[nodiscard]] Eigen::Vector2d direction_of(const TipPull& pull, const Eigen::Vector2d& p) const;
  void take_step(const Growing& growing, const Follower& follower, ShellStepper& stepper,
                 ShellState& state);
  double go(int tear, const Eigen::Vector2d& to, const Follower& follower, ShellStepper& stepper,
            ShellState& state);

  const Sheet& sheet_;
  TearOptions options_;
  Tears tears_;
  std::optional<MeshNeighbours> neighbours_;  ///< of the last mesh looked at
  std::vector<Eigen::Vector2d> given_up_;     ///< places where no tear can start or go on
  Totals totals_;
  LastPull last_pull_;
  int in_vain_ = 0;    ///< time steps in a row whose pulls were gone once the sheet was at rest
  int wait_ = 0;       ///< time steps until candidates are looked at again
  double looked_ = 0;  ///< when they were last (s)
};

}  // namespace geoprior::paper
