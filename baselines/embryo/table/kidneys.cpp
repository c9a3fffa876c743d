#include "baselines/embryo/table/rows.h"

namespace geoprior::embryo::table {

namespace {

/// Ascent from the first sacral vertebra.
void add_left_kidney(BodyPlan& plan) {
  add_ovoid(plan, kLeftMetanephros, {{-0.1045, 0, 0.9945}, {0, -1, 0}},
            {
                {CS14, {0.042, -0.02, -0.07}, {0.12, 0.12, 0.16}},
                {CS16, {0.042, -0.02, -0.07}, {0.16, 0.15, 0.27}},
                {CS17, {0.043, -0.018, -0.05}, {0.18, 0.165, 0.36}},
                {CS18, {0.044, -0.01, -0.02}, {0.19, 0.17, 0.48}},
                {CS19, {0.046, 0, 0.015}, {0.24, 0.21, 0.62}},
                {CS21, {0.048, 0.019, 0.068}, {0.36, 0.31, 0.95}},
                {CS23, {0.049, 0.028, 0.098}, {0.5, 0.43, 1.3}},
                {Week9, {0.05, 0.03, 0.105}, {0.68, 0.58, 1.77}},
                {Week10, {0.05, 0.03, 0.105}, {0.98, 0.84, 2.44}},
                {Week12, {0.052, 0.03, 0.105}, {1.7, 1.45, 4.32}},
            });
  set_life(plan, kLeftMetanephros, CS14, Week12);
}

void add_left_pelvis(BodyPlan& plan) {
  add_duct(plan, kLeftRenalPelvis, {kLeftMetanephros, kLeftMetanephros},
           {
               {CS16, {0.2, 0, 0}, {1.08, 0, -0.12}, {}, 0.063, 0.02, 3.6},
               {CS17, {0.2, 0, 0}, {1.08, 0, -0.12}, {}, 0.0693, 0.022, 4},
               {CS18, {0.2, 0, 0}, {1.08, 0, -0.12}, {}, 0.0714, 0.024, 4},
               {CS20, {0.2, 0, 0}, {1.08, 0, -0.12}, {}, 0.1092, 0.034, 4},
               {Week12, {0.2, 0, 0}, {1.08, 0, -0.12}, {}, 0.609, 0.19, 4},
           });
  set_life(plan, kLeftRenalPelvis, CS16, Week12);
}

void add_left_ureter(BodyPlan& plan) {
  add_duct(plan, kLeftUreter, {kLeftRenalPelvis, kBladder, kLeftMetanephros},
           {
               {CS17, {0, 0, 1}, {0.72, 0.5, -0.35}, {{-0.0139, -0.0239, -0.0216}}, 0.022, 0.022},
               {CS18, {0, 0, 1}, {0.72, 0.5, -0.35}, {{-0.0129, -0.0222, -0.024}}, 0.024, 0.024},
               {CS20, {0, 0, 1}, {0.72, 0.5, -0.35}, {{-0.0143, -0.0237, -0.0296}}, 0.034, 0.034},
               {CS23, {0, 0, 1}, {0.72, 0.5, -0.35}, {{-0.0157, -0.0253, -0.0336}}, 0.055, 0.055},
               {Week12, {0, 0, 1}, {0.72, 0.5, -0.35}, {{-0.0191, -0.0295, -0.0435}}, 0.19, 0.19},
           });
  set_life(plan, kLeftUreter, CS17, Week12);
}

void add_left_artery(BodyPlan& plan) {
  add_duct(plan, kLeftRenalArtery, {kAorta, kLeftMetanephros},
           {
               {CS19, {0, 0, -0.8733}, {0.85, 0, 0.2}, {}, 0.0375, 0.0375},
               {CS21, {0, 0, -0.52}, {0.85, 0, 0.2}, {}, 0.0495, 0.0495},
               {CS23, {0, 0, -0.32}, {0.85, 0, 0.2}, {}, 0.06, 0.06},
               {Week12, {0, 0, -0.2733}, {0.85, 0, 0.2}, {}, 0.135, 0.135},
           });
  set_life(plan, kLeftRenalArtery, CS19, Week12);
}

/// Bridge between the lower poles; it has no life but in a disease.
void add_isthmus(BodyPlan& plan) {
  add_duct(plan, kRenalIsthmus, {kLeftMetanephros, kRightMetanephros},
           {
               {CS17, {0, 0, -0.8}, {0, 0, -0.8}, {{0, -0.018, -0.073}}, 0.0577, 0.0577},
               {CS18, {0, 0, -0.8}, {0, 0, -0.8}, {{0, -0.0153, -0.0456}}, 0.0595, 0.0595},
               {CS19, {0, 0, -0.8}, {0, 0, -0.8}, {{0, -0.0157, -0.0142}}, 0.0735, 0.0735},
               {CS21, {0, 0, -0.8}, {0, 0, -0.8}, {{0, -0.0159, 0.007}}, 0.1085, 0.1085},
               {CS23, {0, 0, -0.8}, {0, 0, -0.8}, {{0, -0.0161, 0.0041}}, 0.1505, 0.1505},
               {Week12, {0, 0, -0.8}, {0, 0, -0.8}, {{0, -0.0169, -0.0064}}, 0.5075, 0.5075},
           });
}

}  // namespace

void add_kidneys(BodyPlan& plan) {
  add_left_kidney(plan);
  add_left_pelvis(plan);
  add_left_ureter(plan);
  add_left_artery(plan);
  add_isthmus(plan);
  add_mirrored(plan, kRightMetanephros, kLeftMetanephros);
  add_mirrored(plan, kRightRenalPelvis, kLeftRenalPelvis);
  add_mirrored(plan, kRightUreter, kLeftUreter);
  add_mirrored(plan, kRightRenalArtery, kLeftRenalArtery);
}

}  // namespace geoprior::embryo::table
