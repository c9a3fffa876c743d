#pragma once

#include <string>

namespace geoprior::embryo::test {

/// A system with one structure or more of every class, and no violation.
inline std::string small_ontology() {
  return R"(@prefix e: <urn:geoprior:embryo#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
e:Drawn a e:Source ; rdfs:label "drawn" .
e:Slow a e:ParameterSet ; rdfs:label "slow" ; e:source e:Drawn .
e:Fast a e:ParameterSet ; rdfs:label "fast" ; e:source e:Drawn .
e:S1 a e:TemporalEntity ; rdfs:label "one" ; e:order 1 ; e:startDay 10 ; e:endDay 12 ; e:unit "d" ; e:source e:Drawn .
e:S2 a e:TemporalEntity ; rdfs:label "two" ; e:order 2 ; e:startDay 12 ; e:endDay 16 ; e:unit "d" ; e:source e:Drawn .
e:S3 a e:TemporalEntity ; rdfs:label "three" ; e:order 3 ; e:startDay 16 ; e:endDay 20.0 ; e:unit "d" ; e:source e:Drawn .
e:S4 a e:TemporalEntity ; rdfs:label "four" ; e:order 4 ; e:startDay 20 ; e:endDay 24 ; e:unit "d" ; e:source e:Drawn .
e:Body a e:EmbryologicalEntity ; rdfs:label "body" ; e:side "median" ; e:kind "body" ; e:crownRump true ; e:existsFrom e:S1 ; e:existsUntil e:S4 .
e:BodyS1 a e:SpatioTemporalEntity ; e:of e:Body ; e:during e:S1 ; e:geometry [ a e:Line ; e:position (0 0 0.2) ; e:axis (0 0 2) ; e:length 10 ; e:unit "mm" ; e:source e:Drawn ] .
e:BodyS4 a e:SpatioTemporalEntity ; e:of e:Body ; e:during e:S4 ; e:geometry [ a e:Line ; e:position (0 0 0.2) ; e:axis (0 0 1) ; e:length 2 ; e:unit "cm" ; e:source e:Drawn ] .
e:System a e:EmbryologicalEntity ; rdfs:label "system" ; e:side "median" ; e:kind "system" ; e:partOf e:Body .
e:Kidney a e:EmbryologicalEntity ; rdfs:label "left kidney" ; e:side "left" ; e:kind "kidney" ; e:existsFrom e:S2 ; e:existsUntil e:S4 ; e:partOf e:System ; e:touches e:Ureter .
e:Twin a e:EmbryologicalEntity ; rdfs:label "right kidney" ; e:side "right" ; e:kind "kidney" ; e:existsFrom e:S2 ; e:existsUntil e:S4 ; e:partOf e:System ; e:mirrorOf e:Kidney ; e:developsFrom e:Level .
e:KidneyS2 a e:SpatioTemporalEntity ; e:of e:Kidney ; e:during e:S2 ; e:geometry e:KidneyShape .
e:KidneyShape a e:Ovoid ; e:position (0.1 0 0) ; e:axis (0 0 1) ; e:up (-1 0 1) ; e:radii (0.2 0.2 0.4) ; e:egg 0.1 ; e:unit "mm" ; e:source e:Drawn .
e:KidneyS3 a e:SpatioTemporalEntity ; e:of e:Kidney ; e:during e:S3 ; e:inSet e:Slow ; e:geometry [ a e:Ovoid ; e:position (0.1 0 0.1) ; e:axis (0 0 1) ; e:up (-1 0 0) ; e:radii (0.3 0.3 0.6) ; e:unit "mm" ; e:source e:Drawn ] .
e:KidneyS4 a e:SpatioTemporalEntity ; e:of e:Kidney ; e:during e:S4 ; e:geometry [ a e:Ovoid ; e:position (0.1 0 0.3) ; e:axis (0 0 1) ; e:up (-1 0 0) ; e:radii (400 400 800) ; e:unit "um" ; e:source e:Drawn ] .
e:TwinS2 a e:SpatioTemporalEntity ; e:of e:Twin ; e:during e:S2 ; e:geometry [ a e:Cylinder ; e:frame e:Level ; e:position (-0.1 0 0) ; e:axis (0 0 1) ; e:length 1 ; e:radius 0.2 ; e:unit "mm" ; e:source e:Drawn ] .
e:TwinS4 a e:SpatioTemporalEntity ; e:of e:Twin ; e:during e:S4 ; e:geometry [ a e:Cylinder ; e:frame e:Level ; e:position (-0.1 0 0) ; e:axis (0 0 1) ; e:length 2 ; e:radius 0.4 ; e:unit "mm" ; e:source e:Drawn ] .
e:Level a e:EmbryologicalEntity ; rdfs:label "level" ; e:side "median" ; e:kind "landmark" ; e:existsFrom e:S1 ; e:existsUntil e:S4 .
e:LevelS2 a e:SpatioTemporalEntity ; e:of e:Level ; e:during e:S2 ; e:geometry [ a e:Point ; e:position (0 0 0.1) ; e:source e:Drawn ] .
e:LevelS3 a e:SpatioTemporalEntity ; e:of e:Level ; e:during e:S3 ; e:geometry [ a e:Point ; e:position (0 0 0.2) ; e:source e:Drawn ] .
e:Ureter a e:EmbryologicalEntity ; rdfs:label "ureter" ; e:side "left" ; e:kind "duct" ; e:existsFrom e:S2 ; e:existsUntil e:S4 ; e:partOf e:System .
e:UreterS3 a e:SpatioTemporalEntity ; e:of e:Ureter ; e:during e:S3 ; e:geometry [ a e:Duct ; e:startsOn e:Cloaca ; e:startAt (0 0 1) ; e:endsOn e:Kidney ; e:endAt (0.5 0 0) ; e:via (0 0 0.05 0.1 0.2 0.3) ; e:radius 0.05 ; e:branchings 2 ; e:unit "mm" ; e:source e:Drawn ] .
e:Cloaca a e:EmbryologicalEntity ; rdfs:label "cloaca" ; e:side "median" ; e:kind "cloaca" ; e:existsFrom e:S1 ; e:existsUntil e:S2 .
e:CloacaS1 a e:SpatioTemporalEntity ; e:of e:Cloaca ; e:during e:S1 ; e:geometry [ a e:Cylinder ; e:position (0 0 -0.1) ; e:axis (0 0 1) ; e:length 1 ; e:radius 0.3 ; e:unit "mm" ; e:source e:Drawn ] .
e:CloacaS4 a e:SpatioTemporalEntity ; e:of e:Cloaca ; e:during e:S4 ; e:geometry [ a e:Cylinder ; e:position (0 0 -0.1) ; e:axis (0 0 1) ; e:length 2 ; e:radius 0.3 ; e:unit "mm" ; e:source e:Drawn ] .
e:Sinus a e:EmbryologicalEntity ; rdfs:label "sinus" ; e:side "median" ; e:kind "cloaca" ; e:existsFrom e:S3 ; e:existsUntil e:S4 ; e:developsFrom e:Cloaca .
e:Rectum a e:EmbryologicalEntity ; rdfs:label "rectum" ; e:side "median" ; e:kind "gut" ; e:existsFrom e:S3 ; e:existsUntil e:S4 ; e:developsFrom e:Cloaca .
e:Growing a e:Growth ; rdfs:label "growing" ; e:actsOn e:Kidney ; e:from e:S2 ; e:to e:S4 .
e:Rising a e:Migration ; rdfs:label "rising" ; e:actsOn e:Kidney ; e:from e:S2 ; e:to e:S4 ; e:requires e:Growing ; e:stopsAt e:Level .
e:Turning a e:Rotation ; rdfs:label "turning" ; e:actsOn e:Kidney ; e:from e:S2 ; e:to e:S3 ; e:inSet e:Fast ; e:about (0 0 2) ; e:angle 90 ; e:unit "deg" ; e:source e:Drawn .
e:Inducing a e:Interaction ; rdfs:label "inducing" ; e:inducer e:Ureter ; e:target e:Kidney ; e:within 0.1 ; e:from e:S2 ; e:to e:S2 ; e:unit "mm" ; e:source e:Drawn .
e:Joining a e:Interaction ; rdfs:label "joining" ; e:fuses e:Kidney , e:Twin ; e:blend 0.1 ; e:dormant true ; e:from e:S3 ; e:to e:S4 ; e:unit "mm" ; e:source e:Drawn .
e:Dividing a e:Division ; rdfs:label "dividing" ; e:actsOn e:Cloaca ; e:produces e:Sinus , e:Rectum ; e:positive e:Rectum ; e:normal (0 1 0) ; e:descent (0 0 -1) ; e:thickness 0.05 ; e:from e:S2 ; e:to e:S3 ; e:unit "mm" ; e:source e:Drawn .
e:Fixing a e:Fixation ; rdfs:label "fixing" ; e:actsOn e:Ureter ; e:from e:S2 ; e:to e:S4 .
e:Horseshoe a e:Disease ; rdfs:label "horseshoe" ; e:side "median" ; e:enables e:Joining ; e:disables e:Rising , e:Turning .
e:Length a e:Measurement ; e:quantity "kidney_length" ; e:of e:Kidney ; e:during e:S3 ; e:low 1 ; e:high 1.4 ; e:unit "mm" ; e:source e:Drawn ; e:inputOf e:Slow .
e:Angle a e:Measurement ; e:quantity "hilum_angle" ; e:of e:Kidney ; e:during e:S3 ; e:mean 90 ; e:deviation 30 ; e:unit "deg" ; e:source e:Drawn .
)";
}

}  // namespace geoprior::embryo::test
