#include <array>
#include <cmath>

#include "baselines/embryo/table/rows.h"

namespace geoprior::embryo::table {
namespace {

/// First and last stage of a process.
struct Span {
  int from, to;
};

/// In the order of ProcessRow.
constexpr std::array<Span, kProcesses> kSpans{
    Span{CS13, CS18},    // allantoic growth
    Span{CS17, Week12},  // bladder growth
    Span{CS17, Week12},  // bladder shift
    Span{CS13, Week12},  // body growth
    Span{CS13, Week12},  // cloacal descent
    Span{CS14, CS18},    // cloacal division
    Span{CS13, Week12},  // cloacal growth
    Span{CS13, Week12},  // gut growth
    Span{CS17, Week12},  // isthmus fixation
    Span{CS17, Week12},  // isthmus growth
    Span{CS16, Week9},   // left ascent
    Span{CS13, CS16},    // left bud elongation
    Span{CS13, CS16},    // left budding
    Span{CS16, Week12},  // left collecting system growth
    Span{CS16, Week12},  // left crossed fixation
    Span{CS14, Week12},  // left crossed growth
    Span{CS13, CS14},    // left crossed induction
    Span{CS14, Week12},  // left crossing
    Span{CS16, Week9},   // left gradual rotation
    Span{CS13, Week12},  // left iliac fixation
    Span{CS13, CS14},    // left induction
    Span{CS14, Week12},  // left kidney growth
    Span{CS13, CS14},    // left mesenchyme condensation
    Span{CS13, CS22},    // left mesonephric turnover
    Span{CS13, CS17},    // left nephric duct growth
    Span{CS13, CS17},    // left nephric fixation
    Span{CS19, Week12},  // left renal artery growth
    Span{CS13, CS16},    // left second bud elongation
    Span{CS13, CS16},    // left second bud fixation
    Span{CS13, CS16},    // left second budding
    Span{CS16, Week12},  // left upper pole fixation
    Span{CS16, Week12},  // left upper pole growth
    Span{CS16, Week12},  // left urinary fixation
    Span{CS19, Week12},  // left vascular fixation
    Span{CS17, Week12},  // mesenteric arrest
    Span{CS17, Week12},  // renal fusion
    Span{CS16, Week9},   // right ascent
    Span{CS13, CS16},    // right bud elongation
    Span{CS13, CS16},    // right budding
    Span{CS16, Week12},  // right collecting system growth
    Span{CS16, Week9},   // right gradual rotation
    Span{CS13, Week12},  // right iliac fixation
    Span{CS13, CS14},    // right induction
    Span{CS14, Week12},  // right kidney growth
    Span{CS13, CS14},    // right mesenchyme condensation
    Span{CS13, CS22},    // right mesonephric turnover
    Span{CS13, CS17},    // right nephric duct growth
    Span{CS13, CS17},    // right nephric fixation
    Span{CS19, Week12},  // right renal artery growth
    Span{CS16, Week12},  // right urinary fixation
    Span{CS19, Week12},  // right vascular fixation
    Span{CS14, CS18},    // septum descent
    Span{CS14, Week12},  // septum growth
    Span{CS19, Week12},  // urachal fixation
    Span{CS19, Week12},  // urachal growth
    Span{CS13, Week12},  // vessel growth
};

/// What no healthy body has.
constexpr std::array kAsleep{
    kIsthmusFixation,   kIsthmusGrowth,         kLeftCrossedFixation,     kLeftCrossedGrowth,
    kLeftCrossing,      kLeftCrossedInduction,  kLeftSecondBudElongation, kLeftSecondBudFixation,
    kLeftSecondBudding, kLeftUpperPoleFixation, kLeftUpperPoleGrowth,     kMesentericArrest,
    kRenalFusion};

void set_interaction(BodyPlan& plan, int process, int inducer, int target, double within) {
  PlannedProcess& interaction = plan.processes[process];
  interaction.interacts = true;
  interaction.inducer = inducer;
  interaction.target = target;
  interaction.within = within;
}

/// From ventral to medial, about the kidney's own axis.
void add_quarter_turn(BodyPlan& plan, int kidney, const Eigen::Vector3d& about) {
  constexpr double kQuarter = 1.5707963267948966;
  plan.structures[kidney].turns.push_back(
      {about.normalized(), kQuarter, middle(plan, CS16), middle(plan, Week9)});
}

}  // namespace

void add_processes(BodyPlan& plan) {
  for (const Span& span : kSpans) {
    PlannedProcess process;
    process.from = middle(plan, span.from);
    process.to = middle(plan, span.to);
    plan.processes.push_back(process);
  }
  for (const int process : kAsleep) plan.processes[process].active = false;
  set_interaction(plan, kLeftInduction, kLeftUretericBud, kLeftMetanephricMesenchyme, 1e-4);
  set_interaction(plan, kRightInduction, kRightUretericBud, kRightMetanephricMesenchyme, 1e-4);
  add_quarter_turn(plan, kLeftMetanephros, {0.1045, 0, -0.9945});
  add_quarter_turn(plan, kRightMetanephros, {0.1045, 0, 0.9945});
  PlannedDivision division;
  division.whole = kCloaca;
  division.products = {{kAnorectalCanal, 1.0}, {kUrogenitalSinus, -1.0}};
  division.from = middle(plan, CS14);
  division.to = plan.stages[CS18].start_day;
  division.normal = {0, 1, 0};
  division.descent = {0, 0, -1};
  division.thickness = 1e-4;
  plan.processes[kCloacalDivision].to = division.to;
  plan.divisions.push_back(division);
}

}  // namespace geoprior::embryo::table
