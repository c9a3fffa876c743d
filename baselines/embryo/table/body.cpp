#include "baselines/embryo/table/rows.h"

namespace geoprior::embryo::table {

namespace {

/// Lengths.
void add_lengths(BodyPlan& plan) {
  add_line(plan, kBody, {0, 0, 0.25},
           {
               {CS13, 4.5},
               {CS14, 6},
               {CS15, 7.5},
               {CS16, 9.5},
               {CS17, 12.5},
               {CS18, 15},
               {CS19, 17},
               {CS20, 20},
               {CS21, 23},
               {CS22, 25.5},
               {CS23, 29},
               {Week9, 36},
               {Week10, 48},
               {Week11, 60.5},
               {Week12, 74.5},
           });
  set_life(plan, kBody, CS13, Week12);
  add_line(plan, kMidline, {0, 0.04, 0},
           {
               {CS13, 2.25},
               {CS16, 4.75},
               {CS18, 7.5},
               {CS21, 11.5},
               {CS23, 14.5},
               {Week12, 37.25},
           });
  set_life(plan, kMidline, CS13, Week12);
}

/// Vertebrae and other landmarks.
void add_landmarks(BodyPlan& plan) {
  add_point(plan, kT12, {0, 0.04, 0.14});
  set_life(plan, kT12, CS13, Week12);
  add_point(plan, kL1, {0, 0.04, 0.105});
  set_life(plan, kL1, CS13, Week12);
  add_point(plan, kL2, {0, 0.04, 0.07});
  set_life(plan, kL2, CS13, Week12);
  add_point(plan, kL3, {0, 0.04, 0.035});
  set_life(plan, kL3, CS13, Week12);
  add_point(plan, kL4, {0, 0.04, 0});
  set_life(plan, kL4, CS13, Week12);
  add_point(plan, kL5, {0, 0.04, -0.035});
  set_life(plan, kL5, CS13, Week12);
  add_point(plan, kS1, {0, 0.04, -0.07});
  set_life(plan, kS1, CS13, Week12);
  add_point(plan, kAorticBifurcation, {0, 0, 0});
  set_life(plan, kAorticBifurcation, CS13, Week12);
  add_point(plan, kInferiorMesentericOrigin, {0, -0.01, 0.04});
  set_life(plan, kInferiorMesentericOrigin, CS13, Week12);
}

/// Great vessels.
void add_vessels(BodyPlan& plan) {
  add_rod(plan, kAorta,
          {
              {CS13, {0, 0, 0.15}, 1.35, 0.06},
              {CS14, {0, 0, 0.15}, 1.8, 0.07},
              {CS15, {0, 0, 0.15}, 2.25, 0.075},
              {CS16, {0, 0, 0.15}, 2.85, 0.085},
              {CS17, {0, 0, 0.15}, 3.75, 0.095},
              {CS18, {0, 0, 0.15}, 4.5, 0.11},
              {CS19, {0, 0, 0.15}, 5.1, 0.125},
              {CS20, {0, 0, 0.15}, 6, 0.145},
              {CS21, {0, 0, 0.15}, 6.9, 0.165},
              {CS22, {0, 0, 0.15}, 7.65, 0.18},
              {CS23, {0, 0, 0.15}, 8.7, 0.2},
              {Week9, {0, 0, 0.15}, 10.8, 0.24},
              {Week10, {0, 0, 0.15}, 14.4, 0.3},
              {Week11, {0, 0, 0.15}, 18.15, 0.37},
              {Week12, {0, 0, 0.15}, 22.35, 0.45},
          });
  set_life(plan, kAorta, CS13, Week12);
  add_duct(plan, kLeftCommonIliacArtery, {kAorticBifurcation},
           {
               {CS13, {0, 0, 0}, {0.075, 0.04, -0.085}, {{0.03, 0.01, -0.028}}, 0.045, 0.036},
               {CS18, {0, 0, 0}, {0.075, 0.04, -0.085}, {{0.03, 0.01, -0.028}}, 0.0825, 0.066},
               {CS23, {0, 0, 0}, {0.075, 0.04, -0.085}, {{0.03, 0.01, -0.028}}, 0.15, 0.12},
               {Week12, {0, 0, 0}, {0.075, 0.04, -0.085}, {{0.03, 0.01, -0.028}}, 0.3375, 0.27},
           });
  set_life(plan, kLeftCommonIliacArtery, CS13, Week12);
  add_mirrored(plan, kRightCommonIliacArtery, kLeftCommonIliacArtery);
}

}  // namespace

void add_body(BodyPlan& plan) {
  add_lengths(plan);
  add_landmarks(plan);
  add_vessels(plan);
}

}  // namespace geoprior::embryo::table
