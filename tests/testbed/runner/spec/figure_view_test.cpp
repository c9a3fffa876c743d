// The view that a figure is drawn with, and the frames that it asks for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testbed/runner/spec/spec_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SpecView : public SpecTest {};

TEST_F(SpecView, FigureViewHasClassesOfItsColours) {
  const Experiment e = load(disc_with(
      "[figure_view]\ncolor_by = \"kind\"\nclasses = [\"flat\", \"cone\"]\nshading = \"flat\"\n"
      "material = \"paper\"\nedges = true\n"));
  EXPECT_THAT(e.view.classes, ElementsAre("flat", "cone"));
  EXPECT_EQ(e.view.shading, FigureView::Shading::flat);
  EXPECT_EQ(e.view.material, FigureView::Material::paper);
  EXPECT_TRUE(e.view.edges);
  EXPECT_THAT(error_of(disc_with("[figure_view]\nclasses = [\"flat\"]\n")),
              HasSubstr("the values of no array"));
  EXPECT_THAT(error_of(disc_with("[figure_view]\nmaterial = \"wood\"\n")), HasSubstr("clay"));
}

TEST_F(SpecView, FigureViewNamesTheArrayThatLabelsAreOf) {
  EXPECT_EQ(load(disc_with("")).view.labels, "");
  const Experiment e = load(
      disc_with("[figure_view]\nlabels = \"organ\"\n[figure_view.below]\nlabels = \"vessel\"\n"));
  EXPECT_EQ(e.view.labels, "organ");
  EXPECT_EQ(e.view.below->labels, "vessel");
  EXPECT_THAT(error_of(disc_with("[figure_view]\nlabels = [\"organ\"]\n")), HasSubstr("labels"));
}

TEST_F(SpecView, FigureViewDrawsOverThePatternWhatItDrawsOverTheSheet) {
  const auto view = [&](const std::string& pattern) {
    return disc_with("[figure_view]\noverlays = [\"rulings\", \"tears\"]\n" + pattern);
  };
  EXPECT_TRUE(load(view("")).view.pattern.empty());
  EXPECT_THAT(load(view("pattern = [\"tears\"]\n")).view.pattern, ElementsAre("tears"));
  EXPECT_THAT(error_of(view("pattern = [\"tear\"]\n")),
              AllOf(HasSubstr("pattern"), HasSubstr("'tear'"), HasSubstr("tears")));
  const std::string curve = "expected = { points = [{ u = 0, v = 0 }, { u = 0, v = 1 }] }\n";
  EXPECT_EQ(load(view("pattern = [\"tears\"]\n" + curve)).view.expected->points.at(1).v, 1);
  EXPECT_THAT(error_of(view(curve)), HasSubstr("expected"));
}

TEST_F(SpecView, FigureViewBeginsWithThatOfTheTopic) {
  for (Topic& topic : topics_) {
    topic.view.color_by = "kind";
    topic.view.classes = {"flat", "cone"};
    topic.view.material = FigureView::Material::paper;
    topic.view.overlays = {"rulings"};
    topic.view.target = {1, 2, 3};
  }
  const auto view_of = [&](const std::string& lines) { return load(disc_with(lines)).view; };
  const FigureView plain = view_of("");
  EXPECT_EQ(plain.color_by, "kind");
  EXPECT_THAT(plain.classes, ElementsAre("flat", "cone"));
  EXPECT_EQ(plain.material, FigureView::Material::paper);
  EXPECT_THAT(plain.overlays, ElementsAre("rulings"));
  EXPECT_EQ(plain.target, (std::array<double, 3>{1, 2, 3}));
  const FigureView other = view_of("[figure_view]\ncolor_by = \"speed\"\noverlays = []\n");
  EXPECT_EQ(other.color_by, "speed");
  EXPECT_TRUE(other.classes.empty()) << "those are of another array";
  EXPECT_TRUE(other.overlays.empty());
  EXPECT_EQ(other.material, FigureView::Material::paper);
  EXPECT_FALSE(view_of("[figure_view]\ncolor_by = \"\"\n").color_by);
}

std::vector<double> drawn_parameters(const Experiment& e) { return e.view.parameters; }

// The toy's disc ends at 90 degrees, its quick run at what the test says.
TEST_F(SpecView, AFrameOfTheFigureBeyondTheEndOfTheRunIsRefused) {
  const auto text = [](const std::string& frames) {
    return disc_with("[figure_view]\n" + frames + "\n");
  };
  EXPECT_THAT(drawn_parameters(load(text("parameters = [30, 90]"))), ElementsAre(30, 90));
  const std::string message = error_of(text("parameters = [30, 91]"));
  EXPECT_THAT(message, AllOf(HasSubstr("disc.toml:"), HasSubstr("figure_view.parameters"),
                             HasSubstr("91 deg lies beyond the end of the run"),
                             HasSubstr("at most 90 deg")));
  EXPECT_THAT(error_of(text("at = { angle_deg = 120 }")),
              AllOf(HasSubstr("figure_view.at"), HasSubstr("120 deg")));
  EXPECT_THAT(error_of(text("parameters = [30]"), with({"figure_view.parameters=[95]"})),
              AllOf(HasSubstr("--set figure_view.parameters"), HasSubstr("95 deg")));
}

// A shortened run shows its own end; what is judged is the run that the file describes.
TEST_F(SpecView, FramesOfTheFigureAreJudgedAgainstTheFullRun) {
  const auto text = [](const std::string& frames) {
    return disc_with("[figure_view]\n" + frames + "\n[quick]\n\"scene.motion.to_deg\" = 20\n");
  };
  EXPECT_THAT(drawn_parameters(load(text("parameters = [10, 90]"), sized(true))),
              ElementsAre(10, 20));
  EXPECT_THAT(error_of(text("parameters = [91]"), sized(true)), HasSubstr("at most 90 deg"));
  const LoadRequest shorter = with({"scene.motion.to_deg=45"});
  EXPECT_THAT(drawn_parameters(load(text("parameters = [10, 90]"), shorter)), ElementsAre(10, 45));
  const LoadRequest longer = with({"scene.motion.to_deg=180", "figure_view.parameters=[135]"});
  EXPECT_THAT(drawn_parameters(load(text("parameters = [10]"), longer)), ElementsAre(135));
  for (const LoadRequest& request : {sized(true), shorter, longer}) {
    const Experiment first = load(text("parameters = [10, 90]"), request);
    const Experiment again =
        load_experiment(home_.write("spec.toml", first.resolved_toml), topics_, {});
    EXPECT_EQ(drawn_parameters(again), drawn_parameters(first))
        << "the resolved text is an experiment file itself";
  }
}

// The cases of a sweep may end apart: a frame is wanted of the longest that is drawn.
TEST_F(SpecView, FramesOfTheFigureMayLieInAnyCaseThatIsDrawn) {
  const auto text = [](const std::string& view) {
    return toy::disc_experiment() +
           "[[sweep]]\nkey = \"scene.motion.to_deg\"\nvalues = [30, 180]\n" +
           "[figure_view]\nparameters = [150]\n" + view;
  };
  EXPECT_THAT(drawn_parameters(load(text(""))), ElementsAre(150));
  EXPECT_THAT(error_of(text("cases = [\"default\", \"to_deg=30\"]\n")),
              HasSubstr("at most 90 deg"));
}

}  // namespace
}  // namespace geoprior::test
