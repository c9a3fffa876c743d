#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/embryo/ontology/planted.h"

// Mistakes planted one by one in copies of the ontology of the urinary system. They are anchored on
// its names and properties, not on its numbers.

namespace geoprior::embryo {
namespace {

using test::Plant;

const std::string& urinary_text() {
  static const std::string text = [] {
    std::ifstream in(GEOPRIOR_SOURCE_DIR "/experiments/embryo/urinary.ttl");
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }();
  return text;
}

constexpr const char* kKidneyKey = "e:LeftMetanephros_CS16_Ascent a";
constexpr const char* kUreterKey = "e:LeftUreter_CS18_Ascent a";

const std::vector<Plant>& shape_plants() {
  static const std::vector<Plant> plants = {
      {"anchor_cycle", "e:of e:Bladder ;", "e:geometry [", "e:geometry [ e:frame e:LeftUreter ;"},
      {"anchor_on_no_structure", kUreterKey, "e:startsOn e:LeftRenalPelvis",
       "e:startsOn e:LeftAscent"},
      {"anchor_on_no_structure", kUreterKey, "e:startsOn e:LeftRenalPelvis",
       "e:startsOn e:LeftPelvis"},
      {"axis_parallel_to_up", kKidneyKey, "e:axis (", "e:axis (0 -2 0) ; e:up (0 1 0)",
       "e:up (0 -1 0)"},
      {"axis_zero", kKidneyKey, "e:axis (", "e:axis (0 0 0)", ")"},
      {"axis_zero", "e:LeftGradualRotation a", "e:about (", "e:about (0 0 0)", ")"},
      {"duct_with_two_ends", kUreterKey, "e:startsOn", "e:startPoint (0 0 0) ; e:startsOn"},
      {"duct_without_end", kUreterKey, "e:startsOn e:LeftRenalPelvis ; ", ""},
      {"egg_out_of_range", kKidneyKey, "e:radii", "e:egg 0.51 ; e:radii"},
      {"frame_cycle", "e:AorticBifurcation_CS13 a", "a e:Point ;",
       "a e:Point ; e:frame e:AorticBifurcation ;"},
      {"missing_property", kKidneyKey, "e:radii (", "", ") ;"},
      {"missing_property", kUreterKey, "e:endAt (", "", ") ;"},
      {"missing_source", kKidneyKey, "; e:source e:Assumed , e:EmbryologyCh", ""},
      {"missing_unit", kKidneyKey, "e:unit \"mm\" ;", ""},
      {"not_finite", kKidneyKey, "e:radii (", "e:radii (1e400 1 1)", ")"},
      {"not_positive", kKidneyKey, "e:radii (", "e:radii (0 1 1)", ")"},
      {"not_positive", kUreterKey, "e:radius ", "e:radius -"},
      {"placed_on_absent", kUreterKey, "e:endsOn e:Bladder", "e:endsOn e:LeftUretericBud"},
      {"primitive_changes", "e:Aorta_CS13 a", "e:geometry [",
       "e:geometry [ a e:Point ; e:position (0 0 0) ; e:source e:Assumed ]", "]"},
      {"repeated_property", kKidneyKey, "e:position (", "e:position (1 1 1) , ("},
      {"two_units", kKidneyKey, "e:unit \"mm\"", "e:unit \"mm\" , \"m\""},
      {"unknown_primitive", kKidneyKey, "a e:Ovoid", "a e:Egg"},
      {"unknown_property", kKidneyKey, "e:radii", "e:colour \"red\" ; e:radii"},
      {"unknown_source", kKidneyKey, "e:source e:Assumed", "e:source e:Guessed"},
      {"unknown_unit", kKidneyKey, "e:unit \"mm\"", "e:unit \"furlong\""},
      {"vector_length", kKidneyKey, "e:position (", "e:position (0 "},
      {"vector_length", kUreterKey, "e:via (", "e:via (0 "},
      {"wrong_value_type", kUreterKey, "e:radius ", "e:radius \"thin\" ; e:endRadius "},
  };
  return plants;
}

const std::vector<Plant>& time_plants() {
  static const std::vector<Plant> plants = {
      {"child_before_progenitor", "e:LeftMetanephros a",
       "e:developsFrom e:LeftMetanephricMesenchyme",
       "e:developsFrom e:LeftMetanephricMesenchyme , e:Bladder"},
      {"develops_from_cycle", "e:Cloaca a", "e:existsFrom",
       "e:developsFrom e:Cloaca ; e:existsFrom"},
      {"hole_in_keys", "", "e:Hindgut_Week12 a", "", "] ."},
      {"interval_reversed", "e:LeftRenalPelvis a", "e:existsFrom e:CS16 ; e:existsUntil e:Week12",
       "e:existsFrom e:Week12 ; e:existsUntil e:CS16"},
      {"key_outside_existence", kUreterKey, "e:during e:CS18", "e:during e:CS13"},
      {"key_with_two_geometries", kKidneyKey, "e:geometry [",
       "e:geometry [ a e:Point ; e:position (0 0 0) ; e:source e:Assumed ] , ["},
      {"key_with_two_stages", kKidneyKey, "e:during e:CS16", "e:during e:CS16 , e:CS15"},
      {"key_with_two_structures", kKidneyKey, "e:of e:LeftMetanephros",
       "e:of e:LeftMetanephros , e:Body"},
      {"key_without_geometry", kKidneyKey, "e:geometry [", "<http://a.org/shape> ["},
      {"key_without_stage", kKidneyKey, "e:during e:CS16 ; ", ""},
      {"key_without_structure", kKidneyKey, "e:of e:LeftMetanephros ; ", ""},
      {"part_of_cycle", "e:UrinarySystem a", "e:partOf e:Body",
       "e:partOf e:Body , e:UrinarySystem"},
      {"part_outside_whole", "e:Aorta a", "e:partOf e:Body", "e:partOf e:LeftMetanephros"},
      {"repeated_label", "e:LeftUreter a", "rdfs:label \"left ureter\"", "rdfs:label \"cloaca\""},
      {"stage_order_gap", "e:Week12 a", "e:order 27", "e:order 29"},
      {"stage_order_repeated", "e:CS18 a", "e:order 18", "e:order 17"},
      {"stage_reversed", "e:Week12 a", "e:endDay ", "e:endDay 1.0 ; <http://a.org/was> "},
      {"stages_overlap", "e:CS16 a", "e:endDay ", "e:endDay 43.5 ; <http://a.org/was> "},
      {"structure_without_stages", "e:LeftUreter a",
       "e:existsFrom e:CS17 ; e:existsUntil e:Week12 ;", ""},
      {"two_keys_at_one_stage", kKidneyKey, "e:during e:CS16", "e:during e:CS17"},
      {"unknown_stage", kKidneyKey, "e:during e:CS16", "e:during e:CS24"},
      {"unknown_structure", "e:LeftMetanephros a", "e:developsFrom e:LeftMetanephricMesenchyme",
       "e:developsFrom e:LeftBlastema"},
  };
  return plants;
}

const std::vector<Plant>& process_plants() {
  static const std::vector<Plant> plants = {
      {"disease_unknown_process", "e:MalrotationLeft a", "e:disables e:LeftGradualRotation",
       "e:disables e:LeftRotation"},
      {"disease_without_effect", "e:PersistentCloaca a", "e:disables", "<http://a.org/disables>"},
      {"division_positive_no_product", "e:CloacalDivision a", "e:positive e:AnorectalCanal",
       "e:positive e:Cloaca"},
      {"division_products", "e:CloacalDivision a", "e:produces e:UrogenitalSinus ,",
       "e:produces e:UrogenitalSinus , e:Bladder ,"},
      {"division_wholes", "e:CloacalDivision a", "e:actsOn e:Cloaca",
       "e:actsOn e:Cloaca , e:Hindgut"},
      {"fixation_without_duct", "e:LeftUrinaryFixation a", "e:actsOn e:LeftRenalPelvis",
       "e:actsOn e:LeftMetanephros"},
      {"measurement_reversed", "e:Length_CS13 a", "e:low ", "e:low 1"},
      {"measurement_without_value", "e:LeftHilum_CS17 a", "e:mean", "<http://a.org/mean>"},
      {"missing_property", "e:LeftInduction a", "e:within ", "<http://a.org/within> "},
      {"missing_unit", "e:LeftGradualRotation a", "e:unit \"deg\"", "e:unit \"mm\""},
      {"process_requires_cycle", "e:LeftBudding a", "e:produces",
       "e:requires e:LeftInduction ; e:produces"},
      {"process_span_reversed", "e:LeftAscent a", "e:from e:CS16 ; e:to e:Week9",
       "e:from e:Week9 ; e:to e:CS16"},
      {"process_unknown_structure", "e:LeftAscent a", "e:actsOn e:LeftMetanephros",
       "e:actsOn e:LeftKidney"},
      {"unknown_choice", "e:Length_CS13 a", "\"crown_rump_length\"", "\"crown_rump\""},
      {"unknown_class", "e:LeftAscent a", "a e:Migration", "a e:Ascension"},
      {"unknown_parameter_set", "e:LeftAscent a", "e:inSet e:Ascent", "e:inSet e:Rise"},
      {"unknown_process", "e:LeftKidneyGrowth a", "e:requires e:LeftInduction",
       "e:requires e:LeftAppetite"},
  };
  return plants;
}

TEST(UrinaryOntology, HasNoViolation) {
  EXPECT_EQ(test::described(test::violations_in(urinary_text())), "");
}

TEST(UrinaryOntology, ShowsEachPlantedMistakeOfAShape) {
  for (const Plant& plant : shape_plants()) test::expect_found_alone(urinary_text(), plant);
}

TEST(UrinaryOntology, ShowsEachPlantedMistakeInTime) {
  for (const Plant& plant : time_plants()) test::expect_found_alone(urinary_text(), plant);
}

TEST(UrinaryOntology, ShowsEachPlantedMistakeOfAProcess) {
  for (const Plant& plant : process_plants()) test::expect_found_alone(urinary_text(), plant);
}

}  // namespace
}  // namespace geoprior::embryo
