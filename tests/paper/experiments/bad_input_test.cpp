// Bad sheets given to a whole run: one error that names file, key and place, and no folder is left.

#include <gmock/gmock.h>

#include <fstream>

#include "experiments/paper/topic.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::paper {
namespace {

using namespace test;

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

const std::string kEdges =
    "handles = [\n"
    "  { name = \"left\", segment = [-0.1, -0.05, -0.1, 0.05], keys = [{ t = 0 }] },\n"
    "  { name = \"right\", segment = [0.1, -0.05, 0.1, 0.05], keys = [{ t = 0 }, { t = 1, move = "
    "[-0.05, 0, 0] }] },\n"
    "]\n";
const std::string kRectangle = "pattern = { kind = \"rectangle\", width = 0.2, height = 0.1 }\n";

class BadSheet : public RunTest {
 protected:
  [[nodiscard]] fs::path experiment(const std::string& scene_lines,
                                    const std::string& stepper = "") const {
    return write_experiment("paper/bad",
                            "title = \"Bad input\"\ntopic = \"paper\"\n[scene]\nduration = 0.2\n" +
                                scene_lines +
                                "\n[[variant]]\nname = \"dense\"\nmethod = \"dense\"\noptions = { "
                                "triangles = 40, stepper = { " +
                                stepper + " } }\n");
  }

  ExecuteResult run_paper(const fs::path& file) const {
    ExecuteRequest request;
    request.out = folder() / "out";
    request.timing = false;
    return execute(load_experiment(file, {make_topic()}, {}), {make_topic()}, request);
  }

  /// The error of a run; fails unless it names the experiment's file, or when it left anything.
  [[nodiscard]] std::string refusal(const std::string& scene_lines) const {
    const fs::path file = experiment(scene_lines);
    const std::string error = error_of([&] { run_paper(file); });
    EXPECT_THAT(error, HasSubstr("bad.toml"));
    EXPECT_FALSE(fs::exists(folder() / "out")) << error;
    return error;
  }
};

TEST_F(BadSheet, IsNoneWhenAllIsWell) {
  EXPECT_NO_THROW(run_paper(experiment(kRectangle + kEdges)));
}

TEST_F(BadSheet, NamesTheCornersOfAPatternThatCrossesItself) {
  const std::string bow =
      "pattern = { kind = \"polygon\", points = [{ u = 0, v = 0 }, { u = 1, v = 1 }, { u = 1, v = "
      "0 }, { u = 0, v = 1.5 }] }\n";
  EXPECT_THAT(refusal(bow), AllOf(HasSubstr("scene.pattern"), HasSubstr("edge")));
}

TEST_F(BadSheet, NamesADegeneratePattern) {
  const auto polygon = [](const std::string& points) {
    return "pattern = { kind = \"polygon\", points = [" + points + "] }\n";
  };
  EXPECT_THAT(refusal(polygon("{ u = 0, v = 0 }, { u = 1, v = 1 }")), HasSubstr("scene.pattern"));
  EXPECT_THAT(refusal(polygon("{ u = 0, v = 0 }, { u = 1, v = 1 }, { u = 2, v = 2 }")),
              HasSubstr("scene.pattern"));
  EXPECT_THAT(refusal(polygon("{ u = 0, v = 0 }, { u = 1, v = 0 }, { u = 1, v = 0 }, { u = 0, v = "
                              "1 }")),
              AllOf(HasSubstr("scene.pattern"), HasSubstr("corner")));
  EXPECT_THAT(refusal("pattern = { kind = \"polygon\", points = [{ u = 0 }] }\n"),
              HasSubstr("scene.pattern.points.0.v: is missing"));
}

TEST_F(BadSheet, NamesAHoleThatIsNone) {
  const auto with = [](const std::string& hole) {
    return "pattern = { kind = \"rectangle\", width = 0.2, height = 0.1, holes = [{ points = [{ u "
           "= "
           "0.02, v = 0.02 }, { u = 0.02, v = 0.03 }, { u = 0.03, v = 0.02 }] }, { points = [" +
           hole + "] }] }\n";
  };
  EXPECT_NO_THROW(run_paper(
      experiment(with("{ u = 0, v = 0 }, { u = 0.01, v = 0 }, { u = 0, v = 0.01 }") + kEdges)));
  fs::remove_all(folder() / "out");
  EXPECT_THAT(refusal(with("{ u = 0.2, v = 0 }, { u = 0.21, v = 0 }, { u = 0.2, v = 0.01 }")),
              AllOf(HasSubstr("bad.toml:5:"), HasSubstr("scene.pattern hole 1"),
                    HasSubstr("outside of the border")));
  EXPECT_THAT(refusal(with("{ u = 0, v = 0 }, { u = 0.2, v = 0 }, { u = 0, v = 0.01 }")),
              AllOf(HasSubstr("scene.pattern hole 1 edge"), HasSubstr("of the border")));
  EXPECT_THAT(refusal(with("{ u = 0, v = 0 }, { u = 0.2, v = 0 }")),
              AllOf(HasSubstr("scene.pattern hole 1"), HasSubstr("2 corners")));
  EXPECT_THAT(refusal(with("{ u = 0 }")),
              HasSubstr("scene.pattern.holes.1.points.0.v: is missing"));
}

TEST_F(BadSheet, NamesTheHandleInAHole) {
  const std::string pierced =
      "pattern = { kind = \"rectangle\", width = 0.2, height = 0.1, holes = [{ points = [{ u = "
      "-0.02, v = -0.02 }, { u = 0.02, v = -0.02 }, { u = 0, v = 0.02 }] }] }\n";
  EXPECT_THAT(
      refusal(pierced + "handles = [{ points = [{ u = 0, v = 0 }], keys = [{ t = 0 }] }]\n"),
      AllOf(HasSubstr("bad.toml:6:"), HasSubstr("scene.handles.0.points.0"),
            HasSubstr("in a hole of the pattern")));
}

TEST_F(BadSheet, NamesTheHandleOutsideThePattern) {
  EXPECT_THAT(refusal(kRectangle +
                      "handles = [{ points = [{ u = 0, v = 0 }, { u = 0, v = 0.06 }], keys = [{ t "
                      "= 0 }] }]\n"),
              AllOf(HasSubstr("scene.handles.0.points.1"), HasSubstr("outside the pattern")));
}

TEST_F(BadSheet, NamesTwoHandlesThatMoveOnePointApart) {
  EXPECT_THAT(
      refusal(kRectangle +
              "handles = [{ name = \"a\", points = [{ u = 0.1, v = 0.05 }], keys = [{ t = 0 }] }, "
              "{ name = \"b\", segment = [0.1, -0.05, 0.1, 0.05], keys = [{ t = 0 }, { t = 1, move "
              "= [-0.05, 0, 0] }] }]\n"),
      AllOf(HasSubstr("scene.handles.1 'b'"), HasSubstr("scene.handles.0 'a'"),
            HasSubstr("(0.1, 0.05) m")));
}

TEST_F(BadSheet, NamesTheKeyTimeThatDoesNotIncrease) {
  EXPECT_THAT(refusal(kRectangle +
                      "handles = [{ name = \"a\", points = [{ u = 0, v = 0 }], keys = [{ t = 0 }, "
                      "{ t = 1 }, { t = 0.5 }] }]\n"),
              AllOf(HasSubstr("scene.handles.0 'a'.keys.2.t"), HasSubstr("does not follow 1")));
}

// The shorter way round would be taken, silently; several keys may turn on and on.
TEST_F(BadSheet, NamesTheKeyThatTurnsHalfWayRound) {
  const auto turning = [](const std::string& turns) {
    return kRectangle + "handles = [{ points = [{ u = 0, v = 0 }], keys = [{ t = 0 }, " + turns +
           "] }]\n";
  };
  for (const std::string angle : {"180", "-180", "270", "360", "630", "720"}) {
    EXPECT_THAT(refusal(turning("{ t = 1 }, { t = 2, turn_deg = [0, " + angle + ", 0] }")),
                HasSubstr("scene.handles.0.keys.2.turn_deg: turns by 180 degrees or more"));
  }
  EXPECT_NO_THROW(run_paper(experiment(turning(
      "{ t = 1, turn_deg = [0, 0, 179] }, { t = 2, turn_deg = [0, 0, 358] }, { t = 3, turn_deg = "
      "[0, 0, 530] }"))));
}

TEST_F(BadSheet, NamesLineAndKeyOfAMaterialOutOfRange) {
  EXPECT_THAT(refusal(kRectangle + "material = { thickness = 0 }\n"),
              AllOf(HasSubstr("bad.toml:6"), HasSubstr("scene.material.thickness")));
  EXPECT_THAT(refusal(kRectangle + "material = { young_modulus = -1e9 }\n"),
              HasSubstr("scene.material.young_modulus"));
  EXPECT_THAT(refusal(kRectangle + "material = { area_density = nan }\n"),
              AllOf(HasSubstr("scene.material.area_density"), HasSubstr("not finite")));
  EXPECT_THAT(refusal(kRectangle + "gravity = [0, 0, inf]\n"),
              AllOf(HasSubstr("scene.gravity"), HasSubstr("not finite")));
}

TEST_F(BadSheet, NamesTheRangeOfAMaterialThatThereIsNot) {
  const auto material = [&](const std::string& key_and_value) {
    return refusal(kRectangle + "material = { " + key_and_value + " }\n");
  };
  EXPECT_THAT(material("young_modulus = 1e300"), AllOf(HasSubstr("scene.material.young_modulus"),
                                                       HasSubstr("between 0.001 and 1e+13 Pa")));
  EXPECT_THAT(material("area_density = 1e9"), HasSubstr("between 1e-09 and 1e+06 kg/m^2"));
  for (const char* key : {"yield_curvature", "weakening", "friction", "damping", "thickness"})
    EXPECT_THAT(material(std::string(key) + " = 1e12"), HasSubstr("between")) << key;
  EXPECT_THAT(refusal(kRectangle + "gravity = [0, 0, -1e9]\n"), HasSubstr("scene.gravity"));
}

TEST_F(BadSheet, OfMoreCutsThanAreLookedAtIsRefusedAtOnce) {
  std::string cuts = "cuts = [";
  for (int i = 0; i < 5001; ++i) {
    const std::string u = std::to_string(-0.09 + 3.6e-5 * i);
    cuts += "{ points = [{ u = " + u + ", v = 0.01 }, { u = " + u + ", v = 0.02 }] },\n";
  }
  EXPECT_THAT(
      refusal("pattern = { kind = \"rectangle\", width = 0.2, height = 0.1, " + cuts + "] }\n"),
      AllOf(HasSubstr("10002 points of cuts"), HasSubstr("10000")));
}

TEST_F(BadSheet, NamesTheObstacleThatContainsTheStart) {
  EXPECT_THAT(refusal(kRectangle +
                      "obstacles = [{ kind = \"sphere\", name = \"ball\", radius = 0.02, centre = "
                      "[0.05, 0.01, 0.01] }]\n"),
              AllOf(HasSubstr("scene.obstacles.0 'ball'"), HasSubstr("contains the start")));
}

TEST_F(BadSheet, NamesTheLineOfTheKeyThatTheSceneRefuses) {
  // Lines 1 to 4 are the title, the topic, [scene] and the duration, 5 is the pattern.
  EXPECT_THAT(refusal(kRectangle +
                      "handles = [\n  { points = [{ u = 0, v = 0 }], keys = [{ t = 0 }] },\n"
                      "  { name = \"b\", points = [{ u = 0, v = 0.06 }], keys = [{ t = 0 }] },\n"
                      "]\n"),
              AllOf(HasSubstr("bad.toml:8:"), HasSubstr("scene.handles.1 'b'.points.0")));
  EXPECT_THAT(refusal(kRectangle + "\n[[scene.obstacles]]\nkind = \"plane\"\naxis = [0, 0, 0]\n"),
              HasSubstr("bad.toml:9:"));
}

TEST_F(BadSheet, IsWarnedOfWhereWavesOfTheStartDipIntoAnObstacle) {
  const auto warnings = [&](const std::string& lines) {
    const fs::path file = experiment(kRectangle + lines);
    const auto record = run_paper(file).record.cases.front().warnings;
    fs::remove_all(folder() / "out");
    return record;
  };
  const std::string table = "obstacles = [{ kind = \"plane\", name = \"table\" }]\n";
  const auto dipping = warnings(table);
  ASSERT_EQ(dipping.size(), 1U);
  EXPECT_THAT(dipping[0], AllOf(HasSubstr("scene.obstacles.0 'table'"),
                                HasSubstr("scene.imperfection = 0.0001 m")));
  EXPECT_TRUE(warnings(table + "imperfection = 0\n").empty());
  EXPECT_TRUE(warnings("obstacles = [{ kind = \"plane\", centre = [0, 0, -0.001] }]\n").empty());
}

TEST_F(BadSheet, NamesShapesThatContradictThemselves) {
  EXPECT_THAT(refusal(kRectangle + "handles = [{ segment = [0, 0, 1], keys = [{ t = 0 }] }]\n"),
              AllOf(HasSubstr("scene.handles.0.segment: has 3 numbers"), HasSubstr("allowed: 4")));
  EXPECT_THAT(refusal(kRectangle + "handles = [{ points = [{ u = 0, v = 0 }], force = [0, 1] }]\n"),
              HasSubstr("scene.handles.0.force: has 2 numbers"));
  EXPECT_THAT(refusal(kRectangle + "obstacles = [{ kind = \"plane\", axis = [0, 0, 0] }]\n"),
              HasSubstr("scene.obstacles.0.axis: has no direction"));
  EXPECT_THAT(refusal(kRectangle + "obstacles = [{ kind = \"cone\" }]\n"),
              AllOf(HasSubstr("unknown choice 'cone'"), HasSubstr("hollow-sphere")));
}

TEST_F(BadSheet, NamesTheDrawingAndItsPath) {
  EXPECT_THAT(refusal("pattern = { kind = \"svg\", file = \"none.svg\" }\n"),
              AllOf(HasSubstr("scene.pattern.file"), HasSubstr("none.svg")));
  const fs::path drawing = folder() / "experiments" / "paper" / "bow.svg";
  fs::create_directories(drawing.parent_path());
  std::ofstream(drawing) << "<svg><path id='bow' d='M0 0 L10 10 L10 0 L0 15Z'/></svg>";
  EXPECT_THAT(
      refusal("pattern = { kind = \"svg\", file = \"bow.svg\" }\n"),
      AllOf(HasSubstr("scene.pattern.file"), HasSubstr(drawing.string()), HasSubstr("edge")));
  EXPECT_THAT(refusal("pattern = { kind = \"svg\", file = \"bow.svg\", path = \"arrow\" }\n"),
              AllOf(HasSubstr("scene.pattern.path"), HasSubstr(drawing.string()),
                    HasSubstr("no shape with id 'arrow'")));
  std::ofstream(drawing) << "<svg><path d='M0 0 L10 10 L10'/></svg>";
  EXPECT_THAT(refusal("pattern = { kind = \"svg\", file = \"bow.svg\" }\n"),
              AllOf(HasSubstr("scene.pattern.file"), HasSubstr(drawing.string())));
}

TEST_F(BadSheet, AsksForNoMoreFramesThanCanBeNumbered) {
  const fs::path file = write_experiment(
      "paper/bad",
      "title = \"Bad input\"\ntopic = \"paper\"\n[scene]\nduration = 1e6\nframe_interval = 1e-9\n" +
          kRectangle + kEdges + "[[variant]]\nname = \"dense\"\nmethod = \"dense\"\n");
  EXPECT_THAT(error_of([&] { run_paper(file); }),
              AllOf(HasSubstr("bad.toml:4:1"), HasSubstr("scene.duration: asks for 1e+15 frames"),
                    HasSubstr("at most 100000")));
  EXPECT_FALSE(fs::exists(folder() / "out"));
}

TEST_F(BadSheet, AsksForNoMeshLargerThanItsPatternJustifies) {
  ::setenv("GEOPRIOR_MEMORY_GB", "1", 1);
  const std::string thin =
      "pattern = { kind = \"polygon\", points = [{ u = 0, v = 0 }, { u = 3e2, v = 3e2 }, "
      "{ u = 3e2, v = 300.0012 }, { u = 0, v = 0.0012 }] }\n";
  EXPECT_THAT(refusal(thin), AllOf(HasSubstr("bad.toml:5"), HasSubstr("scene.pattern: asks for"),
                                   HasSubstr("points of a mesh with edges of")));
  ::unsetenv("GEOPRIOR_MEMORY_GB");
  EXPECT_THAT(refusal("pattern = { kind = \"rectangle\", width = 1e6, height = 1e-6 }\n"),
              AllOf(HasSubstr("bad.toml:5"), HasSubstr("too thin for its length")));
  EXPECT_THAT(refusal("pattern = { kind = \"disc\", corners = 10001 }\n"),
              AllOf(HasSubstr("scene.pattern.corners"), HasSubstr("between 3 and 10000")));
}

// Two millimetres wide, where an edge of the hybrid's mesh is six long: bent like any other sheet.
TEST_F(BadSheet, IsNoStripThatIsThinnerThanTheMesh) {
  const fs::path file = write_experiment(
      "paper/bad",
      "title = \"Thin\"\ntopic = \"paper\"\n[scene]\nduration = 0.2\n"
      "pattern = { kind = \"rectangle\", width = 0.2, height = 0.002 }\n"
      "handles = [\n"
      "  { name = \"left\", segment = [-0.1, -0.001, -0.1, 0.001], keys = [{ t = 0 }] },\n"
      "  { name = \"right\", segment = [0.1, -0.001, 0.1, 0.001], keys = [{ t = 0 }, { t = 1, move "
      "= "
      "[-0.05, 0, 0] }] },\n"
      "]\n[[variant]]\nname = \"hybrid\"\nmethod = \"hybrid\"\n");
  const ExecuteResult result = run_paper(file);
  ASSERT_EQ(result.record.cases.size(), 1U);
  for (const VariantRecord& variant : result.record.cases[0].variants)
    EXPECT_EQ(variant.error, "") << variant.name;
}

TEST_F(BadSheet, NamesTheDrawingThatIsNestedTooDeep) {
  std::string svg;
  for (int i = 0; i < 100000; ++i) svg += "<g>";
  const fs::path drawing = folder() / "experiments" / "paper" / "deep.svg";
  fs::create_directories(drawing.parent_path());
  std::ofstream(drawing) << svg;
  EXPECT_THAT(refusal("pattern = { kind = \"svg\", file = \"deep.svg\" }\n"),
              AllOf(HasSubstr("deep.svg, byte"), HasSubstr("nested too deep")));
}

}  // namespace
}  // namespace geoprior::paper
