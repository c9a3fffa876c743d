#pragma once

#include <Eigen/Core>
#include <array>
#include <initializer_list>
#include <optional>
#include <vector>

#include "models/embryo/body/plan.h"

/// Rows that a table of the urinary system is made of, and the functions that put them into a
/// plan. Places are ratios of the crown-rump length, sizes millimetres.
namespace geoprior::embryo::table {

enum StageRow {
  CS13,
  CS14,
  CS15,
  CS16,
  CS17,
  CS18,
  CS19,
  CS20,
  CS21,
  CS22,
  CS23,
  Week9,
  Week10,
  Week11,
  Week12,
  kStages
};

/// Structures, by name.
enum StructureRow {
  kAllantois,
  kAnorectalCanal,
  kAorta,
  kAorticBifurcation,
  kBladder,
  kBody,
  kCloaca,
  kCloacalMembrane,
  kHindgut,
  kInferiorMesentericOrigin,
  kL1,
  kL2,
  kL3,
  kL4,
  kL5,
  kLeftCommonIliacArtery,
  kLeftCrossedMetanephros,
  kLeftCrossedRenalArtery,
  kLeftCrossedRenalPelvis,
  kLeftCrossedUreter,
  kLeftMesonephros,
  kLeftMetanephricMesenchyme,
  kLeftMetanephros,
  kLeftNephricDuct,
  kLeftRenalArtery,
  kLeftRenalPelvis,
  kLeftSecondUretericBud,
  kLeftUpperPolePelvis,
  kLeftUpperPoleUreter,
  kLeftUreter,
  kLeftUretericBud,
  kMidline,
  kRenalIsthmus,
  kRightCommonIliacArtery,
  kRightMesonephros,
  kRightMetanephricMesenchyme,
  kRightMetanephros,
  kRightNephricDuct,
  kRightRenalArtery,
  kRightRenalPelvis,
  kRightUreter,
  kRightUretericBud,
  kS1,
  kT12,
  kUrachus,
  kUrinarySystem,
  kUrogenitalSinus,
  kUrorectalSeptum,
  kStructures
};

/// Processes, by name.
enum ProcessRow {
  kAllantoicGrowth,
  kBladderGrowth,
  kBladderShift,
  kBodyGrowth,
  kCloacalDescent,
  kCloacalDivision,
  kCloacalGrowth,
  kGutGrowth,
  kIsthmusFixation,
  kIsthmusGrowth,
  kLeftAscent,
  kLeftBudElongation,
  kLeftBudding,
  kLeftCollectingSystemGrowth,
  kLeftCrossedFixation,
  kLeftCrossedGrowth,
  kLeftCrossedInduction,
  kLeftCrossing,
  kLeftGradualRotation,
  kLeftIliacFixation,
  kLeftInduction,
  kLeftKidneyGrowth,
  kLeftMesenchymeCondensation,
  kLeftMesonephricTurnover,
  kLeftNephricDuctGrowth,
  kLeftNephricFixation,
  kLeftRenalArteryGrowth,
  kLeftSecondBudElongation,
  kLeftSecondBudFixation,
  kLeftSecondBudding,
  kLeftUpperPoleFixation,
  kLeftUpperPoleGrowth,
  kLeftUrinaryFixation,
  kLeftVascularFixation,
  kMesentericArrest,
  kRenalFusion,
  kRightAscent,
  kRightBudElongation,
  kRightBudding,
  kRightCollectingSystemGrowth,
  kRightGradualRotation,
  kRightIliacFixation,
  kRightInduction,
  kRightKidneyGrowth,
  kRightMesenchymeCondensation,
  kRightMesonephricTurnover,
  kRightNephricDuctGrowth,
  kRightNephricFixation,
  kRightRenalArteryGrowth,
  kRightUrinaryFixation,
  kRightVascularFixation,
  kSeptumDescent,
  kSeptumGrowth,
  kUrachalFixation,
  kUrachalGrowth,
  kVesselGrowth,
  kProcesses
};

/// x, y, z: a place, or a size along each.
using Triplet = std::array<double, 3>;

struct OvoidRow {
  int stage;
  Triplet place, radii;
};
struct RodRow {
  int stage;
  Triplet place;
  double length, radius;
};
struct LineRow {
  int stage;
  double length;
};
struct PlaneRow {
  int stage;
  Triplet place;
  double extent;
};
struct DuctRow {
  int stage;
  Triplet start, end;  ///< on their structures, or places
  std::vector<Triplet> via;
  double radius, end_radius;
  double branchings = 0;
};

struct OvoidForm {
  Triplet axis{0, 0, 1}, up{1, 0, 0};
  double egg = 0;
};
/// Structures that a duct begins and ends on, and that its places are relative to.
struct DuctForm {
  std::optional<int> start = {}, end = {}, frame = {};
};

void add_point(BodyPlan& plan, int structure, const Triplet& place);
void add_line(BodyPlan& plan, int structure, const Triplet& place,
              std::initializer_list<LineRow> rows);
void add_plane(BodyPlan& plan, int structure, const Triplet& normal,
               std::initializer_list<PlaneRow> rows);
void add_rod(BodyPlan& plan, int structure, std::initializer_list<RodRow> rows);
void add_ovoid(BodyPlan& plan, int structure, const OvoidForm& form,
               std::initializer_list<OvoidRow> rows);
void add_duct(BodyPlan& plan, int structure, const DuctForm& form,
              std::initializer_list<DuctRow> rows);
/// The key frames of the right structure from those of the left one, and as long a life.
void add_mirrored(BodyPlan& plan, int right, int left);

/// From one stage to another, both included.
void set_life(BodyPlan& plan, int structure, int from, int until);
/// The days between which processes go: middles of stages.
double middle(const BodyPlan& plan, int stage);

/// The parts of the table.
void add_body(BodyPlan& plan);
void add_kidneys(BodyPlan& plan);
void add_early_ducts(BodyPlan& plan);
void add_cloaca(BodyPlan& plan);
void add_processes(BodyPlan& plan);

}  // namespace geoprior::embryo::table
