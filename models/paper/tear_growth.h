#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "models/paper/lip_detail.h"
#include "models/paper/sheet.h"
#include "models/paper/shell_state.h"
#include "models/paper/stepper.h"
#include "models/paper/tears.h"
#include "models/paper/tip_pull.h"

namespace geoprior::paper {

/// midpoint: the direction in the middle of the step, extrapolated from those at its start and at
/// the start of the step before (Adams and Bashforth).
enum class TearIntegrator { euler, midpoint };
/// everywhere: every vertex of the mesh is a candidate, those of the thesis and tips too, and what
/// parts it is the largest tension over all directions of the triangles about it, on a flaw: the
/// general way, where nothing is known of the sheet (separation strength, Pfaff et al. 2014).
enum class TearSearch { candidates, everywhere };
/// bisector: away from both pulls; steepest: where most is released of what is opposed, which is
/// the bisector unless the paper has a grain; askew: 45 degrees from the bisector towards one pull
/// (a null).
enum class TearDirection { steepest, bisector, askew };

/// How tears grow (thesis 3.2.2; what it leaves open is ours, see docs/methods/paper.md).
struct TearOptions {
  PullOptions pull;
  TearSearch search = TearSearch::candidates;
  double flaw = 4e-3;   ///< length of the sheet's flaws, from which smooth places tear (m)
  double step = 2e-3;   ///< length by which a tear grows (m)
  int most_steps = 10;  ///< of all tears after one time step
  TearIntegrator integrator = TearIntegrator::midpoint;
  TearDirection direction = TearDirection::steepest;
  double most_turn_deg = 30;  ///< that a tear turns in a step
  double relax_time = 1e-3;   ///< of the implicit steps from rest that a sheet relaxes in (s)
  int rest_steps = 20;        ///< most of them, for a pull to come to rest in before a tear grows
  double rest_turn_deg = 1;   ///< of a pull at rest, from one such step to the next
  double rest_change = 0.02;  ///< of what it releases, likewise, relative
  int relax_steps = 2;        ///< of them, after it has grown
  int most_relax_steps = 20;  ///< of them, while the sheet has more energy than before it grew
  double path_tolerance =
      1e-4;                  ///< farthest that a tear's path lies from the edges of its lips (m)
  double margin = 1e-3;      ///< a tear that comes so near to a border ends there (m)
  double least_part = 1e-6;  ///< smallest area that a tear may cut off (m^2)
  LipDetailOptions detail;   ///< what is drawn along the lips
};
void describe(OptionVisitor& v, TearOptions& options);

/// A place where the sheet may tear, and the tear whose tip it is.
struct TearCandidate {
  Eigen::Vector2d place;
  std::optional<int> tear;
  bool smooth = false;  ///< nothing concentrates the stress there: it tears from a flaw
};

/// Tips of tears, corners of the border at which the sheet lies on the larger side, and places
/// where it is held: those of the thesis' candidates that need no structure.
std::vector<TearCandidate> plain_candidates(const Sheet& sheet, const Tears& tears);

/// Tears that grow while the energy they release exceeds what the paper opposes (Griffith; thesis
/// 3.2.2): E_r of `TipPull::released` against E_f = K T, of the sheet at rest: a pull that goes,
/// or does not settle, when the sheet relaxes tears nothing. After each step of a tear the sheet is
/// meshed anew and relaxes.
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
  [[nodiscard]] std::optional<TipPull> pull_on(const TearCandidate& candidate, int vertex,
                                               const ShellStepper& stepper, const ShellState& state,
                                               const MeshNeighbours& neighbours) const;
  [[nodiscard]] std::optional<Growing> look_at(const TearCandidate& candidate,
                                               const ShellStepper& stepper, const ShellState& state,
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
};

}  // namespace geoprior::paper
