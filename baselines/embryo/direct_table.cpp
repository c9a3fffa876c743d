#include "baselines/embryo/direct_table.h"

#include <array>
#include <initializer_list>
#include <string>
#include <utility>

#include "baselines/embryo/table/rows.h"

namespace geoprior::embryo {
namespace table {
namespace {

struct StageDays {
  const char* name;
  int order;
  double start, end;
};

constexpr std::array<StageDays, kStages> kStageDays{{
    {"CS13", 13, 28, 31},
    {"CS14", 14, 31, 35},
    {"CS15", 15, 35, 37},
    {"CS16", 16, 37, 42},
    {"CS17", 17, 42, 44},
    {"CS18", 18, 44, 48},
    {"CS19", 19, 48, 51},
    {"CS20", 20, 51, 53},
    {"CS21", 21, 53, 54},
    {"CS22", 22, 54, 56},
    {"CS23", 23, 56, 60},
    {"Week9", 24, 60, 63},
    {"Week10", 25, 63, 70},
    {"Week11", 26, 70, 77},
    {"Week12", 27, 77, 84},
}};

constexpr std::array<const char*, kStructures> kNames{
    "Allantois",
    "AnorectalCanal",
    "Aorta",
    "AorticBifurcation",
    "Bladder",
    "Body",
    "Cloaca",
    "CloacalMembrane",
    "Hindgut",
    "InferiorMesentericOrigin",
    "L1",
    "L2",
    "L3",
    "L4",
    "L5",
    "LeftCommonIliacArtery",
    "LeftCrossedMetanephros",
    "LeftCrossedRenalArtery",
    "LeftCrossedRenalPelvis",
    "LeftCrossedUreter",
    "LeftMesonephros",
    "LeftMetanephricMesenchyme",
    "LeftMetanephros",
    "LeftNephricDuct",
    "LeftRenalArtery",
    "LeftRenalPelvis",
    "LeftSecondUretericBud",
    "LeftUpperPolePelvis",
    "LeftUpperPoleUreter",
    "LeftUreter",
    "LeftUretericBud",
    "Midline",
    "RenalIsthmus",
    "RightCommonIliacArtery",
    "RightMesonephros",
    "RightMetanephricMesenchyme",
    "RightMetanephros",
    "RightNephricDuct",
    "RightRenalArtery",
    "RightRenalPelvis",
    "RightUreter",
    "RightUretericBud",
    "S1",
    "T12",
    "Urachus",
    "UrinarySystem",
    "UrogenitalSinus",
    "UrorectalSeptum",
};

void never(BodyPlan& plan, std::initializer_list<int> structures) {
  for (const int one : structures) plan.structures[one].exists.assign(kStages, false);
}

void switch_processes(BodyPlan& plan, bool on, std::initializer_list<int> processes) {
  for (const int one : processes) plan.processes[one].active = on;
}

// disease: renal-agenesis-left
void apply_renal_agenesis_left(BodyPlan& plan) {
  never(plan,
        {kLeftUretericBud, kLeftMetanephros, kLeftRenalPelvis, kLeftUreter, kLeftRenalArtery});
  switch_processes(plan, false,
                   {kLeftBudding, kLeftBudElongation, kLeftInduction, kLeftKidneyGrowth,
                    kLeftCollectingSystemGrowth, kLeftAscent, kLeftGradualRotation,
                    kLeftUrinaryFixation, kLeftVascularFixation, kLeftRenalArteryGrowth});
}
// end

// disease: horseshoe-kidney
void apply_horseshoe_kidney(BodyPlan& plan) {
  set_life(plan, kRenalIsthmus, CS17, Week12);
  switch_processes(plan, false, {kLeftGradualRotation, kRightGradualRotation});
  switch_processes(plan, true, {kRenalFusion, kMesentericArrest, kIsthmusGrowth, kIsthmusFixation});
  for (const int kidney : {kLeftMetanephros, kRightMetanephros}) {
    plan.structures[kidney].turns.clear();
    plan.structures[kidney].stops = {kInferiorMesentericOrigin};
  }
  plan.processes[kRenalFusion].fuses = {kLeftMetanephros, kRightMetanephros, kRenalIsthmus};
  plan.processes[kRenalFusion].blend = 0.1e-3;
  for (const int process : {kRenalFusion, kMesentericArrest}) {
    plan.processes[process].interacts = true;
    plan.processes[process].inducer = kLeftMetanephros;
    plan.processes[process].target = kRightMetanephros;
    plan.processes[process].within = 1e-2;
  }
}
// end

// disease: persistent-cloaca
void apply_persistent_cloaca(BodyPlan& plan) {
  never(plan, {kUrogenitalSinus, kAnorectalCanal});
  set_life(plan, kCloaca, CS13, Week12);
  switch_processes(plan, false, {kSeptumDescent, kCloacalDivision});
  plan.structures[kUrorectalSeptum].place_held = middle(plan, CS14);
  plan.divisions[0].active = false;
}
// end

BodyPlan healthy_plan() {
  BodyPlan plan;
  for (const StageDays& days : kStageDays)
    plan.stages.push_back({days.name, days.name, days.order, days.start, days.end});
  for (const char* name : kNames) {
    PlannedStructure structure;
    structure.name = name;
    structure.exists.assign(kStages, false);
    plan.structures.push_back(std::move(structure));
  }
  add_body(plan);
  add_kidneys(plan);
  add_early_ducts(plan);
  add_cloaca(plan);
  add_processes(plan);
  for (const Key& key : plan.structures[kBody].keys)
    plan.crown_rump_length.emplace_back(key.day, 2 * key.geometry.radii.z());
  return plan;
}

BodyPlan plan_of(TableDisease disease, Interpolation interpolation) {
  BodyPlan plan = healthy_plan();
  plan.interpolation = interpolation;
  switch (disease) {
    case TableDisease::renal_agenesis_left:
      apply_renal_agenesis_left(plan);
      break;
    case TableDisease::horseshoe_kidney:
      apply_horseshoe_kidney(plan);
      break;
    case TableDisease::persistent_cloaca:
      apply_persistent_cloaca(plan);
      break;
    case TableDisease::none:
      break;
  }
  return plan;
}

}  // namespace
}  // namespace table

DirectTable::DirectTable(TableDisease disease, Interpolation interpolation)
    : body_(table::plan_of(disease, interpolation)) {}

std::vector<std::string> DirectTable::structures() const {
  return {table::kNames.begin(), table::kNames.end()};
}

std::optional<TableDisease> table_disease(std::string_view name) {
  if (name == "RenalAgenesisLeft") return TableDisease::renal_agenesis_left;
  if (name == "HorseshoeKidney") return TableDisease::horseshoe_kidney;
  if (name == "PersistentCloaca") return TableDisease::persistent_cloaca;
  return std::nullopt;
}

}  // namespace geoprior::embryo
