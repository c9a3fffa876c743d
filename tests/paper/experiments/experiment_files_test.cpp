// The experiment files of the topic: that they load, and that no sheet is asked to stretch.

#include <gtest/gtest.h>

#include <set>

#include "experiments/paper/scene/fast_handles.h"
#include "experiments/paper/scene/pulled_apart.h"
#include "experiments/paper/scene/scene.h"
#include "experiments/paper/topic.h"
#include "testbed/home.h"
#include "testbed/runner/spec/spec.h"

namespace geoprior::paper {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> experiment_files() {
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(geoprior_home() / "experiments" / "paper")) {
    if (entry.path().extension() == ".toml") files.insert(entry.path());
  }
  return {files.begin(), files.end()};
}

/// What moves faster than a sheet follows on purpose: five fast hands, a sheet that is shaken, and
/// short scenes that show what options do.
bool is_fast(const fs::path& file) {
  static const std::set<fs::path> fast{"fast-hands", "shake", "options-hybrid", "options-adaptive",
                                       "options-tears"};
  return fast.contains(file.stem());
}

TEST(PaperExperiments, AreThoseThatTheTopicHas) {
  EXPECT_EQ(experiment_files().size(), 43U);
  for (const fs::path& file : experiment_files()) {
    for (const bool quick : {false, true}) {
      LoadRequest request;
      request.quick = quick;
      const Experiment experiment = load_experiment(file, {make_topic()}, request);
      EXPECT_FALSE(experiment.cases.empty()) << file;
      for (const CaseSpec& c : experiment.cases) {
        EXPECT_NO_THROW(make_topic().load(*c.scene, file.parent_path(), c.seed)) << file;
      }
    }
  }
}

// On a convex pattern two points of an isometric sheet are never farther apart in space than in the
// pattern. The imperfection may add a ten-thousandth.
TEST(PaperExperiments, NeverPullTwoHandlesFartherApartThanTheirPatternAllows) {
  for (const fs::path& file : experiment_files()) {
    const Experiment experiment = load_experiment(file, {make_topic()}, {});
    const auto scene = make_topic().load(*experiment.cases[0].scene, file.parent_path(), 1);
    const Sheet& sheet = dynamic_cast<const PaperScene&>(*scene).sheet;
    if (!sheet.toughness.tears()) {
      const auto worst = worst_pulled_apart(sheet, 1e-4);
      EXPECT_FALSE(worst) << file << ": " << warning_text(sheet, *worst, "scene");
    }
    if (is_fast(file)) continue;  // warns of its speed, below
    EXPECT_TRUE(scene->warnings().empty()) << file;
  }
}

// The fastest hand of all other experiments, the pinching finger of bend-pinch, does 0.16 m/s over
// a sheet of 0.21 m.
TEST(PaperExperiments, OnlyFastHandsAreFasterThanASheetCanFollow) {
  for (const fs::path& file : experiment_files()) {
    const Experiment experiment = load_experiment(file, {make_topic()}, {});
    const auto scene = make_topic().load(*experiment.cases[0].scene, file.parent_path(), 1);
    const auto warning =
        fast_handle_warning(dynamic_cast<const PaperScene&>(*scene).sheet, "scene");
    EXPECT_EQ(warning.has_value(), is_fast(file)) << file << ": " << *warning;
  }
}

}  // namespace
}  // namespace geoprior::paper
