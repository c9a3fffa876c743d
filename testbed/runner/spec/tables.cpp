#include "testbed/runner/spec/tables.h"

#include <array>

namespace geoprior {
namespace {

constexpr std::array<std::string_view, 2> kSizes{"full", "quick"};
constexpr std::array<std::string_view, 9> kOfReductions{"same", "max",  "min", "median", "p95",
                                                        "p99",  "mean", "sum", "last"};
constexpr std::array<std::string_view, 2> kShadings{"smooth", "flat"};
constexpr std::array<std::string_view, 3> kMaterials{"clay", "paper", "water"};
constexpr std::array<std::string_view, 3> kAcross{"variants", "states", "cases"};

}  // namespace

void describe(OptionVisitor& v, HeaderTable& t) {
  v.value("title", t.title, {.doc = "what is shown, one line", .required = true});
  v.value("figure", t.figure, {.doc = "figure of the thesis; empty for a study of our own"});
  v.value("topic", t.topic,
          {.doc = "topic, whose scenes, methods and metrics are meant", .required = true});
  v.value("id", t.id,
          {.doc = "identifier, two names: topic/name; absent: from the file's folder and name"});
  describe_choice(v, "size", t.size, kSizes, {.doc = "quick in the resolved text of a quick run"});
  v.value("seed", t.seed, {.doc = "seed of every random stream", .min = 0});
  v.value("threads", t.threads, {.doc = "number of threads; 0: all", .min = 0, .max = 1024});
  v.value("input", t.input,
          {.doc = "variant that does nothing, from which claims are graded; absent: the first of "
                  "the topic's inputs"});
}

void describe(OptionVisitor& v, VariantTable& t) {
  v.value("name", t.name, {.doc = "letters, digits, '-' and '_'", .required = true});
  v.value("method", t.method, {.doc = "a name of the topic's method table", .required = true});
  v.value(
      "role", t.role,
      {.doc =
           "method, baseline, ablation, or null (must fail claims; not timed, drawn or blessed); "
           "absent: by the method table"});
  v.value("reference", t.reference,
          {.doc = "variant that metrics of distance between variants compare with"});
  v.value("quick", t.quick, {.doc = "false: quick runs make it only where --variant names it"});
}

void describe(OptionVisitor& v, SweepTable& t) {
  v.value("key", t.key,
          {.doc = "scene.*, seed, threads or variant.<name>.options.*", .required = true});
  v.value("names", t.names, {.doc = "names of the cases, one a value; absent: key=value"});
  v.value("variants", t.variants, {.doc = "variants that run in the sweep's cases; absent: all"});
  v.value("grid", t.grid, {.doc = "product with the other sweeps that say so"});
  v.value("base", t.base, {.doc = "false: no case 'default' beside the sweep's own"});
  v.value(
      "claims_only", t.claims_only,
      {.doc = "the sweep's cases decide claims and studies: not blessed, timed again or drawn"});
}

void describe(OptionVisitor& v, ExceptTable& t) {
  v.value("cases", t.cases, {.doc = "names of cases", .required = true});
  v.value("reason", t.reason, {.doc = "why the claim need not hold there", .required = true});
}

void describe(OptionVisitor& v, ClaimTable& t) {
  v.value("text", t.text, {.doc = "the statement in words", .required = true});
  v.value("metric", t.metric,
          {.doc = "a name of the metric table, timing:<phase>, diagnostic:<name> or study:<name>",
           .required = true});
  v.value("variant", t.variant, {.doc = "variant whose value is judged"});
  v.value("variants", t.variants,
          {.doc = "several of them, of which the one nearest to failing speaks"});
  v.value("of", t.of, {.doc = "variant that the claim's variant is compared with"});
  v.value("value", t.value,
          {.doc = "number that the variant is compared with, in the metric's unit"});
  describe_choice(v, "is", t.is, kComparisons,
                  {.doc = "comparison of the variant's value with the other side"});
  v.value("factor", t.factor, {.doc = "factor on the other side"});
  v.value("offset", t.offset, {.doc = "number added to the other side, in the metric's unit"});
  v.value("tolerance", t.tolerance,
          {.doc = "difference that == allows, in the metric's unit", .min = 0});
  v.value("known_shortfall", t.known_shortfall,
          {.doc = "why the claim falls short, where that is known: check lets it pass"});
  v.value(
      "slack", t.slack,
      {.doc = "why the limit is more than five times off in every case: bless refuses it else"});
  describe_choice(
      v, "reduce", t.reduce, kReductions,
      {.doc = "one number of all frames, without `at`; every: the claim must hold frame by frame"});
  describe_choice(v, "of_reduce", t.of_reduce, kOfReductions,
                  {.doc = "one number of all frames of the other side; same: as `reduce`"});
  describe_list(v, "except", t.except,
                {.doc = "cases in which the claim is decided, but need not hold"});
  describe_choice(
      v, "over", t.over, kClaimOvers,
      {.doc = "what decides: each case, or 9 of 10 seeds of a case together (at least ten seeds)"});
  v.value("null", t.null,
          {.doc = "variant that must fail the same inequality in place of `variant`"});
  v.value("quick", t.quick,
          {.doc = "false: quick runs are too short for the claim, and leave it out"});
}

void describe(OptionVisitor& v, FamilyTable& t) {
  v.value("variants", t.variants,
          {.doc = "one rival at several resolutions, from coarse to fine", .required = true});
}

void describe(OptionVisitor& v, StudyTable& t) {
  v.value("name", t.name, {.doc = "name of the study", .required = true});
  describe_choice(v, "kind", t.kind, kStudyKinds,
                  {.doc = "slope in log-log, observed order of convergence, standard deviation, "
                          "distance of two medians over half the range of `of`, a metric of the "
                          "events of all cases together, largest case over smallest, or what "
                          "rivals cost at equal quality over what the variant costs"});
  v.value("variant", t.variant, {.doc = "variant whose quantity is studied", .required = true});
  v.value(
      "quantity", t.quantity,
      {.doc = "a name of the metric table, timing:<phase> or diagnostic:<name>", .required = true});
  v.value("of", t.of,
          {.doc = "variant whose range is the yardstick (within-spread), or that is right "
                  "(matched; absent: `match` is an error)"});
  v.value("against", t.against, {.doc = "a fact of the scene, or a swept key"});
  describe_choice(v, "finer", t.finer, kFiner,
                  {.doc = "x of the finer discretisation: a step is smaller, a count larger"});
  describe_choice(v, "reduce", t.reduce, kReductions, {.doc = "one number of all frames"});
  v.value("match", t.match,
          {.doc = "metric in which the rivals of a matched study are to be equal"});
  describe_choice(v, "match_reduce", t.match_reduce, kReductions,
                  {.doc = "one number of all frames of `match`, and of `keep`"});
  v.value("keep", t.keep, {.doc = "metric that the rivals of a matched study may not pay with"});
  v.value("keep_within", t.keep_within,
          {.doc = "how much worse rivals may be in it than the variant", .min = 0});
  describe_list(v, "families", t.families,
                {.doc = "rivals of a matched study, each at several resolutions"});
  v.value("cases", t.cases, {.doc = "names of cases; absent: all that have what is asked"});
}

void describe(OptionVisitor& v, TimingTable& t) {
  v.value("repetitions", t.repetitions,
          {.doc = "repetitions of each solve; of processes whole runs", .min = 1, .max = 1000});
  v.value("warm_up", t.warm_up,
          {.doc = "rounds that are not counted; absent: 1 of pose methods, 0 of processes",
           .min = 0,
           .max = 1000});
}

void describe(OptionVisitor& v, CheckTable& t) {
  v.value("bifurcates", t.bifurcates,
          {.doc = "compare medians over the sweep of `seed`, not one path"});
  v.value(
      "metrics", t.metrics,
      {.doc = "metrics with reference values though neither a claim nor the figure reads them"});
  v.value("quick_metrics", t.quick_metrics, {.doc = "further ones, of quick runs alone"});
  v.value("outcomes", t.outcomes,
          {.doc = "the reference keeps a hash of what each case and variant came to (metrics, "
                  "events, artifacts): which options did something"});
}

void describe(OptionVisitor& v, ToleranceTable& t) {
  v.value("absolute", t.absolute,
          {.doc = "difference that is allowed, in the metric's unit", .min = 0});
  v.value("relative", t.relative,
          {.doc = "difference that is allowed, as a fraction of the reference value", .min = 0});
}

void describe(OptionVisitor& v, SectionView& t) {
  v.value("origin", t.origin, {.doc = "point of the cutting plane", .unit = "m"});
  v.value("normal", t.normal, {.doc = "direction across the cutting plane"});
}

void describe(OptionVisitor& v, FurtherRow& t) {
  v.value("part", t.part, {.doc = "part of the frames"});
  v.value("input", t.input,
          {.doc = "a \"run:…\" of the scene whose frames these are; absent: this run's"});
  v.value("label", t.label, {.doc = "label of the row; absent: the part's name"});
  v.value("color_by", t.color_by, {.doc = "array of the part; absent: plain material"});
  v.value("classes", t.classes, {.doc = "names of the integers 0, 1, … in `color_by`"});
  v.value("labels", t.labels, {.doc = "named array whose names stand beside what has them"});
  v.value("target", t.target, {.doc = "point looked at; absent: fitted", .unit = "m"});
  v.value("direction", t.direction, {.doc = "direction towards the eye"});
  v.value("up", t.up, {.doc = "upward in the picture"});
  v.value("height_m", t.height_m,
          {.doc = "height of the view; absent: fitted", .unit = "m", .min = 1e-12});
  v.value("overlays", t.overlays, {.doc = "further parts drawn over `part`"});
  v.value("variants", t.variants,
          {.doc = "whose part it is, when all have the same; absent: those of the figure"});
  v.value("parameters", t.parameters, {.doc = "frames; absent: those of the figure"});
}

void describe(OptionVisitor& v, PlanePoint& t) {
  v.value("u", t.u, {.doc = "first coordinate", .unit = "m", .required = true});
  v.value("v", t.v, {.doc = "second coordinate", .unit = "m", .required = true});
}

void describe(OptionVisitor& v, ExpectedCurve& t) {
  v.value("label", t.label, {.doc = "name of the curve in the legend"});
  describe_list(v, "points", t.points, {.doc = "points of the pattern, joined by straight lines"});
}

void describe(OptionVisitor& v, FigureViewTable& table) {
  FigureView& t = table.view;
  v.value("at_parameter", t.at_parameter, {.doc = "frame that is drawn; absent: the last"});
  v.value("parameters", t.parameters, {.doc = "several frames"});
  describe_choice(
      v, "across", t.across, kAcross,
      {.doc = "what stands side by side; states: the frames, or cases, a row a variant"});
  v.value("part", t.part, {.doc = "part of the frames"});
  v.value("label", t.label,
          {.doc = "label of the rows between `above` and `below`; absent: the part's name"});
  v.value("color_by", t.color_by, {.doc = "array of the part; \"\": plain material"});
  v.value("classes", t.classes,
          {.doc = "names of the integers 0, 1, … in `color_by`: a legend instead of a scale; "
                  "absent: those that the array has"});
  v.value("labels", t.labels,
          {.doc = "named array of the part or of overlays whose names stand beside what has them; "
                  "\"\": no labels"});
  v.value("identities", t.identities,
          {.doc = "the integers of `color_by` tell things apart and 0 is none: a colour each"});
  describe_choice(v, "shading", t.shading, kShadings, {.doc = "flat: one tone a triangle"});
  describe_choice(v, "material", t.material, kMaterials,
                  {.doc = "material of what has no colour; paper: white, the back side darker"});
  v.value("edges", t.edges, {.doc = "edges of the triangles as thin lines"});
  v.value("plain", t.plain,
          {.doc = "adds the same panels plain, flat unless the part has normals, under lights that "
                  "graze: under each row, "
                  "beside it where it has one column"});
  v.value("plain_part", t.plain_part,
          {.doc = "part that the plain panels show where the frames have it; absent: `part`"});
  v.value("target", table.target, {.doc = "point looked at; absent: fitted", .unit = "m"});
  v.value("direction", t.direction, {.doc = "direction from the target to the eye"});
  v.value("up", t.up, {.doc = "upward in the picture"});
  v.value("height_m", t.height_m,
          {.doc = "height of the view; absent: fitted", .unit = "m", .min = 1e-12});
  describe_group(v, "section", t.section,
                 {.doc = "adds a row with the part cut by a plane, overlaps of the solid in red"});
  describe_group(v, "above", t.above, {.doc = "a further row, of another part, on top"});
  describe_group(v, "below", t.below, {.doc = "a further row, of another part, at the bottom"});
  v.value("overlays", t.overlays,
          {.doc = "further parts drawn over `part`: lines thin, points as balls"});
  v.value("pattern", t.pattern,
          {.doc = "overlays that are drawn over the flat pattern beside the sheet; "
                  "absent: no pattern"});
  describe_group(v, "expected", t.expected,
                 {.doc = "a curve that theory says, dashed in the patterns"});
  v.value("variants", t.variants, {.doc = "absent: all"});
  v.value("cases", t.cases, {.doc = "absent: all"});
  v.value("metrics", t.metrics, {.doc = "curves of metrics.svg; absent: all that vary"});
  v.value(
      "contact_sheet", t.contact_sheet,
      {.doc = "frames of contact-sheet.png, evenly spaced; 0: none is drawn", .min = 0, .max = 48});
}

}  // namespace geoprior
