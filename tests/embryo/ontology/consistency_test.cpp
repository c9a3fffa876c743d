#include "solvers/embryo/ontology/consistency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "models/embryo/surface/mesh.h"
#include "solvers/embryo/rules/effects.h"
#include "solvers/embryo/state/development.h"
#include "tests/embryo/ontology/planted.h"
#include "tests/embryo/ontology/small_ontology.h"

// Each mistake is planted alone in a copy of a small ontology: the checks must find it, on its
// line, and nothing else.

namespace geoprior::embryo {
namespace {

using test::described;
using test::Plant;
using test::planted;
using test::violations_in;

const std::vector<Plant> kSmallPlants = {
    {"anchor_cycle", "e:KidneyS2 a", "e:geometry e:KidneyShape .",
     "e:geometry e:KidneyShape . e:KidneyShape e:frame e:Ureter ."},
    {"anchor_on_no_structure", "e:UreterS3 a", "e:endsOn e:Kidney", "e:endsOn e:Growing"},
    {"anchor_on_no_structure", "e:UreterS3 a", "e:endsOn e:Kidney", "e:endsOn e:Kidny"},
    {"axis_parallel_to_up", "e:KidneyShape a", "e:up (-1 0 1)", "e:up (0 0 -3)"},
    {"axis_zero", "e:TwinS2 a", "e:axis (0 0 1)", "e:axis (0 0 0)"},
    {"axis_zero", "e:Turning a", "e:about (0 0 2)", "e:about (0 0 0.0)"},
    {"child_before_progenitor", "e:Cloaca a", "e:existsUntil e:S2",
     "e:existsUntil e:S2 ; e:developsFrom e:Kidney"},
    {"crown_rump_missing", "", "e:crownRump true", "e:crownRump false"},
    {"crown_rump_not_line", "e:Body a",
     "e:crownRump true ; e:existsFrom e:S1 ; e:existsUntil e:S4 .",
     "e:existsFrom e:S1 ; e:existsUntil e:S4 .\n"
     "e:Ring a e:EmbryologicalEntity ; rdfs:label \"ring\" ; e:side \"median\" ; e:kind \"r\" ; "
     "e:crownRump true ; e:existsFrom e:S1 ; e:existsUntil e:S2 .\n"
     "e:RingS1 a e:SpatioTemporalEntity ; e:of e:Ring ; e:during e:S1 ; e:geometry [ a e:Point ; "
     "e:position (0 0 0) ; e:source e:Drawn ] ."},
    {"crown_rump_twice", "e:Level a", "e:side", "e:crownRump true ; e:side"},
    {"develops_from_cycle", "e:Level a", "e:existsFrom e:S1",
     "e:developsFrom e:Body ; e:existsFrom e:S1 . e:Body e:developsFrom e:Level . e:Level "
     "e:touches e:Body"},
    {"disease_contradicts_itself", "e:Horseshoe a", "e:disables e:Rising", "e:disables e:Joining"},
    {"disease_unknown_process", "e:Horseshoe a", "e:disables e:Rising", "e:disables e:Rsing"},
    {"disease_without_effect", "e:Horseshoe a",
     "; e:enables e:Joining ; e:disables e:Rising , e:Turning", ""},
    {"division_positive_no_product", "e:Dividing a", "e:positive e:Rectum", "e:positive e:Cloaca"},
    {"division_products", "e:Dividing a", "e:Sinus , e:Rectum", "e:Sinus , e:Rectum , e:Twin"},
    {"division_wholes", "e:Dividing a", "e:actsOn e:Cloaca", "e:actsOn e:Cloaca , e:Level"},
    {"duct_with_two_ends", "e:UreterS3 a", "e:startAt (0 0 1)",
     "e:startAt (0 0 1) ; e:startPoint (0 0 0)"},
    {"duct_without_end", "e:UreterS3 a", "e:startsOn e:Cloaca ; e:startAt (0 0 1) ;", ""},
    {"egg_out_of_range", "e:KidneyShape a", "e:egg 0.1", "e:egg -0.6"},
    {"fixation_without_duct", "e:Fixing a", "e:actsOn e:Ureter", "e:actsOn e:Kidney"},
    {"frame_cycle", "e:LevelS2 a", "a e:Point", "a e:Point ; e:frame e:Twin"},
    {"fusion_of_one", "e:Joining a", "e:Kidney , e:Twin", "e:Kidney"},
    {"hole_in_keys", "",
     "e:KidneyS4 a e:SpatioTemporalEntity ; e:of e:Kidney ; e:during e:S4 ; e:geometry [",
     "e:Unused <http://a.org/x> ["},
    {"interval_reversed", "e:Ureter a", "e:existsFrom e:S2 ; e:existsUntil e:S4",
     "e:existsFrom e:S4 ; e:existsUntil e:S2"},
    {"key_outside_existence", "e:KidneyS2 a", "e:during e:S2", "e:during e:S1"},
    {"key_with_two_geometries", "e:KidneyS2 a", "e:geometry e:KidneyShape",
     "e:geometry e:KidneyShape , [ a e:Point ; e:position (0 0 0) ; e:source e:Drawn ]"},
    {"key_with_two_stages", "e:KidneyS2 a", "e:during e:S2", "e:during e:S2 , e:S3"},
    {"key_with_two_structures", "e:KidneyS2 a", "e:of e:Kidney", "e:of e:Kidney , e:Twin"},
    {"key_without_geometry", "e:KidneyS2 a", " ; e:geometry e:KidneyShape", ""},
    {"key_without_stage", "e:KidneyS2 a", "e:during e:S2 ; ", ""},
    {"key_without_structure", "e:KidneyS2 a", "e:of e:Kidney ; ", ""},
    {"measurement_reversed", "e:Length a", "e:low 1 ;", "e:low 1.5 ;"},
    {"measurement_without_value", "e:Length a", "e:low 1 ; e:high 1.4 ;", ""},
    {"mirror_on_one_side", "e:Twin a", "\"right\"", "\"left\""},
    {"misplaced_property", "e:Growing a", "e:from", "e:radius 1 ; e:from"},
    {"missing_property", "e:KidneyShape a", "e:radii (0.2 0.2 0.4) ; ", ""},
    {"missing_property", "e:Kidney a", "rdfs:label \"left kidney\" ; ", ""},
    {"missing_property", "e:Kidney a", "e:existsUntil e:S4 ; ", ""},
    {"missing_property", "e:Inducing a", "e:target e:Kidney ; ", ""},
    {"missing_property", "e:Growing a", "e:actsOn e:Kidney ; ", ""},
    {"missing_property", "e:UreterS3 a", "e:endAt (0.5 0 0) ; ", ""},
    {"missing_source", "e:KidneyShape a", " ; e:source e:Drawn", ""},
    {"missing_source", "e:S2 a", " ; e:source e:Drawn", ""},
    {"missing_source", "e:Slow a", " ; e:source e:Drawn", ""},
    {"missing_source", "e:LevelS2 a", " ; e:source e:Drawn", ""},
    {"missing_unit", "e:KidneyShape a", " ; e:unit \"mm\"", ""},
    {"missing_unit", "e:Turning a", "e:unit \"deg\"", "e:unit \"mm\""},
    {"missing_unit", "e:S2 a", " ; e:unit \"d\"", ""},
    {"negative_number", "e:UreterS3 a", "e:branchings 2", "e:branchings -2"},
    {"no_class", "e:Twin a", "a e:EmbryologicalEntity ;", ""},
    {"not_finite", "e:KidneyShape a", "e:egg 0.1", "e:egg 1e999"},
    {"not_finite", "e:LevelS2 a", "(0 0 0.1)",
     "(0 0 \"NaN\"^^<http://www.w3.org/2001/XMLSchema#double>)"},
    {"not_positive", "e:KidneyShape a", "(0.2 0.2 0.4)", "(0.2 0 0.4)"},
    {"not_positive", "e:TwinS2 a", "e:radius 0.2", "e:radius -0.2"},
    {"part_of_cycle", "e:Kidney a", "e:touches e:Ureter",
     "e:partOf e:Twin . e:Twin e:partOf e:Kidney"},
    {"part_outside_whole", "e:Level a", "e:kind", "e:partOf e:Kidney ; e:kind"},
    {"placed_on_absent", "e:TwinS2 a", "e:frame e:Level", "e:frame e:Rectum"},
    {"primitive_changes", "e:KidneyS4 a",
     "a e:Ovoid ; e:position (0.1 0 0.3) ; e:axis (0 0 1) ; "
     "e:up (-1 0 0) ; e:radii (400 400 800)",
     "a e:Cylinder ; e:position (0.1 0 0.3) ; e:axis (0 0 1) ; e:length 8 ; e:radius 1"},
    {"process_requires_cycle", "e:Growing a", "e:from", "e:requires e:Rising ; e:from"},
    {"process_span_empty", "e:Growing a", "e:to e:S4", "e:to e:S2"},
    {"process_span_reversed", "e:Rising a", "e:from e:S2 ; e:to e:S4", "e:from e:S4 ; e:to e:S2"},
    {"process_unknown_structure", "e:Growing a", "e:actsOn e:Kidney", "e:actsOn e:Kidny"},
    {"product_begins_elsewhere", "e:Sinus a", "e:existsFrom e:S3", "e:existsFrom e:S4"},
    {"product_with_keys", "e:Rectum a", "e:developsFrom e:Cloaca .",
     "e:developsFrom e:Cloaca . e:SinusS3 a e:SpatioTemporalEntity ; e:of e:Sinus ; e:during "
     "e:S3 ; e:geometry e:KidneyShape ."},
    {"repeated_label", "e:Ureter a", "\"ureter\"", "\"cloaca\""},
    {"repeated_property", "e:KidneyShape a", "e:egg 0.1", "e:egg 0.1 , 0.2"},
    {"stage_next_against_order", "e:S2 a", "e:order 2", "e:order 2 ; e:next e:S4"},
    {"stage_order_against_days", "e:S1 a", "e:order 1", "e:order 5"},
    {"stage_order_gap", "e:S4 a", "e:order 4", "e:order 5"},
    {"stage_order_repeated", "e:S4 a", "e:order 4", "e:order 3"},
    {"stage_reversed", "e:S4 a", "e:startDay 20 ; e:endDay 24", "e:startDay 24 ; e:endDay 20"},
    {"stages_overlap", "e:S3 a", "e:startDay 16", "e:startDay 15"},
    {"structure_without_keys", "e:UreterS3 a", "e:during e:S3", "e:during e:S3 ; e:inSet e:Slow"},
    {"structure_without_stages", "e:Kidney a", "e:existsFrom e:S2 ; e:existsUntil e:S4 ; ", ""},
    {"two_classes", "e:Kidney a", "a e:EmbryologicalEntity", "a e:EmbryologicalEntity , e:Disease"},
    {"two_keys_at_one_stage", "e:LevelS3 a", "e:during e:S3", "e:during e:S2"},
    {"two_keys_at_one_stage", "e:KidneyS3 a", "e:during e:S3", "e:during e:S2"},
    {"two_units", "e:KidneyShape a", "e:unit \"mm\"", "e:unit \"mm\" , \"cm\""},
    {"unknown_choice", "e:Kidney a", "\"left\"", "\"Left\""},
    {"unknown_choice", "e:Length a", "\"kidney_length\"", "\"kidney_lenght\""},
    {"unknown_class", "e:Growing a", "a e:Growth", "a e:Grwth"},
    {"unknown_class", "e:Growing a", "a e:Growth", "a e:Process"},
    {"unknown_geometry", "e:KidneyS2 a", "e:KidneyShape", "e:KidneyShpe"},
    {"unknown_parameter_set", "e:KidneyS3 a", "e:inSet e:Slow", "e:inSet e:Slwo"},
    {"unknown_primitive", "e:KidneyShape a", "e:Ovoid", "e:Torus"},
    {"unknown_primitive", "e:KidneyShape a", "e:Ovoid", "e:GeometricalComponent"},
    {"unknown_process", "e:Rising a", "e:requires e:Growing", "e:requires e:Grwing"},
    {"unknown_property", "e:KidneyShape a", "e:egg", "e:eg"},
    {"unknown_source", "e:KidneyShape a", "e:source e:Drawn", "e:source e:Drwan"},
    {"unknown_stage", "e:Growing a", "e:from e:S2", "e:from e:S9"},
    {"unknown_stage", "e:KidneyS2 a", "e:during e:S2", "e:during e:S9"},
    {"unknown_structure", "e:Kidney a", "e:touches e:Ureter", "e:touches e:Uretr"},
    {"unknown_unit", "e:KidneyShape a", "e:unit \"mm\"", "e:unit \"inch\""},
    {"vector_length", "e:KidneyShape a", "(0.2 0.2 0.4)", "(0.2 0.2)"},
    {"vector_length", "e:UreterS3 a", "(0 0 0.05 0.1 0.2 0.3)", "(0 0 0.05 0.1)"},
    {"wrong_value_type", "e:KidneyShape a", "e:egg 0.1", "e:egg \"0.1\""},
    {"wrong_value_type", "e:KidneyShape a", "(0.2 0.2 0.4)", "0.2"},
    {"wrong_value_type", "e:KidneyShape a", "(0.2 0.2 0.4)", "(0.2 \"a\" 0.4)"},
    {"wrong_value_type", "e:S2 a", "e:order 2", "e:order 2.5"},
    {"wrong_value_type", "e:Joining a", "e:dormant true", "e:dormant \"yes\""},
    {"wrong_value_type", "e:Growing a", "e:actsOn e:Kidney", "e:actsOn e:S2"},
    {"wrong_value_type", "e:Kidney a", "e:touches e:Ureter", "e:touches \"ureter\""},
};

TEST(Consistency, FindsNothingInAConsistentOntology) {
  EXPECT_EQ(described(violations_in(test::small_ontology())), "");
}

TEST(Consistency, FindsEachPlantedMistakeAndNoneElse) {
  for (const Plant& plant : kSmallPlants) test::expect_found_alone(test::small_ontology(), plant);
}

TEST(Consistency, HasAPlantOfEveryKind) {
  std::set<std::string> planted_kinds;
  for (const Plant& plant : kSmallPlants) planted_kinds.insert(plant.kind);
  std::set<std::string> kinds;
  for (const ViolationKind& kind : violation_kinds()) {
    kinds.insert(std::string(kind.name));
    EXPECT_TRUE(kind.meaning.ends_with('.')) << kind.name;
  }
  EXPECT_EQ(planted_kinds, kinds);
  EXPECT_EQ(kinds.size(), violation_kinds().size());
  EXPECT_TRUE(std::ranges::is_sorted(violation_kinds(), {}, &ViolationKind::name));
}

/// Of what leaves a model one is made, with surfaces on every day; the rest is refused either way.
TEST(Consistency, LeavesAModelWhereItSaysSo) {
  for (const Plant& plant : kSmallPlants) {
    const std::string text = planted(test::small_ontology(), plant);
    EXPECT_THROW(test::read_ontology(text), Error) << plant.by;
    if (!violation_kind(plant.kind).leaves_a_model) {
      EXPECT_THROW(test::read_ontology(text, {}, Mistakes::counted), Error) << plant.by;
      continue;
    }
    SCOPED_TRACE(plant.kind + ": " + plant.by);
    const Ontology ontology = test::read_ontology(text, {"Slow", 0}, Mistakes::counted);
    const Development development(ontology, effects_without_rules(ontology, std::nullopt), {});
    for (const Stage& stage : ontology.stages)
      EXPECT_FALSE(day_meshes(development.at(stage.middle()), {.triangles = 200}).empty());
  }
}

TEST(Consistency, NamesTheLineOfTheMistake) {
  const Plant plant = {"unknown_unit", "e:KidneyShape a", "e:unit \"mm\"", "\n\ne:unit \"inch\""};
  const std::string text = planted(test::small_ontology(), plant);
  const auto line = 3 + std::count(text.begin(), text.begin() + text.find("e:KidneyShape a"), '\n');
  const std::vector<Violation> found = violations_in(text);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].line, line);
  EXPECT_EQ(found[0].subject, "KidneyShape");
  EXPECT_EQ(found[0].message.find("'unit' of 'KidneyShape' is \"inch\""), 0u);
}

TEST(Consistency, LeavesOtherVocabulariesAlone) {
  const std::string text = test::small_ontology() +
                           "<http://a.org/x> a <http://a.org/Class> ; <http://a.org/size> -1 .\n"
                           "e:Kidney <http://a.org/size> \"large\" .\n";
  EXPECT_EQ(described(violations_in(text)), "");
}

TEST(Consistency, TakesSubclassesOfTheUserForTheirs) {
  std::string text = test::small_ontology();
  const Plant plant = {"", "e:Kidney a", "a e:EmbryologicalEntity", "a e:KidneyClass"};
  text = planted(text, plant);
  EXPECT_FALSE(violations_in(text).empty());
  text +=
      "e:KidneyClass rdfs:subClassOf <http://a.org/Organ> .\n"
      "<http://a.org/Organ> rdfs:subClassOf e:EmbryologicalEntity , e:KidneyClass .\n";
  EXPECT_EQ(described(violations_in(text)), "");
}

TEST(Consistency, EndsOnListsWithoutEnd) {
  const std::string text = test::small_ontology() +
                           "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .\n"
                           "e:Round a e:Point ; e:source e:Drawn ; e:position _:a .\n"
                           "_:a rdf:first 1 ; rdf:rest _:a .\n";
  const std::vector<Violation> found = violations_in(text);
  ASSERT_EQ(found.size(), 1u) << described(found);
  EXPECT_EQ(found[0].kind, "wrong_value_type");
}

}  // namespace
}  // namespace geoprior::embryo
