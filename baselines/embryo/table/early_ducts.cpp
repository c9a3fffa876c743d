#include "baselines/embryo/table/rows.h"

namespace geoprior::embryo::table {

namespace {

void add_left_mesonephros(BodyPlan& plan) {
  add_ovoid(plan, kLeftMesonephros, {{0, 0, 1}, {1, 0, 0}, 0.1},
            {
                {CS13, {0.07, -0.07, 0.175}, {0.13, 0.143, 0.6}},
                {CS15, {0.07, -0.07, 0.175}, {0.22, 0.242, 0.95}},
                {CS17, {0.07, -0.07, 0.175}, {0.3, 0.33, 1.2}},
                {CS19, {0.07, -0.07, 0.175}, {0.26, 0.286, 1}},
                {CS22, {0.07, -0.07, 0.175}, {0.12, 0.132, 0.4}},
            });
  set_life(plan, kLeftMesonephros, CS13, CS22);
}

void add_left_nephric_duct(BodyPlan& plan) {
  add_duct(plan, kLeftNephricDuct, {kLeftMesonephros, kCloaca},
           {
               {CS13,
                {1, 0, 0.55},
                {0.75, 0.1, 0.3},
                {{0.1069, -0.075, 0.12}, {0.075, -0.065, 0.02}, {0.062, -0.05, -0.06}},
                0.03,
                0.03},
               {CS15,
                {1, 0, 0.55},
                {0.75, 0.1, 0.3},
                {{0.1073, -0.075, 0.12}, {0.075, -0.065, 0.02}, {0.062, -0.05, -0.06}},
                0.03,
                0.03},
               {CS17,
                {1, 0, 0.55},
                {0.75, 0.1, 0.3},
                {{0.102, -0.075, 0.12}, {0.075, -0.065, 0.02}, {0.062, -0.05, -0.06}},
                0.03,
                0.03},
           });
  set_life(plan, kLeftNephricDuct, CS13, CS17);
}

void add_left_bud(BodyPlan& plan) {
  add_duct(plan, kLeftUretericBud, {kLeftNephricDuct},
           {
               {CS13, {0, 0, 0.66}, {0.055, -0.0395, -0.0732}, {}, 0.028, 0.034},
               {CS14, {0, 0, 0.66}, {0.044, -0.023, -0.0705}, {}, 0.028, 0.034},
               {CS16, {0, 0, 0.66}, {0.042, -0.02, -0.07}, {}, 0.028, 0.034},
           });
  set_life(plan, kLeftUretericBud, CS13, CS16);
}

void add_left_mesenchyme(BodyPlan& plan) {
  add_ovoid(plan, kLeftMetanephricMesenchyme, {{-0.1045, 0, 0.9945}, {0, -1, 0}},
            {
                {CS13, {0.042, -0.02, -0.07}, {0.095, 0.095, 0.114}},
                {CS14, {0.042, -0.02, -0.07}, {0.11, 0.11, 0.132}},
            });
  set_life(plan, kLeftMetanephricMesenchyme, CS13, CS14);
}

}  // namespace

void add_early_ducts(BodyPlan& plan) {
  add_left_mesonephros(plan);
  add_left_nephric_duct(plan);
  add_left_bud(plan);
  add_left_mesenchyme(plan);
  add_mirrored(plan, kRightMesonephros, kLeftMesonephros);
  add_mirrored(plan, kRightNephricDuct, kLeftNephricDuct);
  add_mirrored(plan, kRightUretericBud, kLeftUretericBud);
  add_mirrored(plan, kRightMetanephricMesenchyme, kLeftMetanephricMesenchyme);
}

}  // namespace geoprior::embryo::table
