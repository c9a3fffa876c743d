// The experiment files of the topic: that they load, and that no sheet is asked to stretch.

#include <gtest/gtest.h>

#include <set>

#include "experiments/paper/scene.h"
#include "experiments/paper/topic.h"
#include "experiments/runner/spec.h"
#include "experiments/view/view.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> experiment_files() {
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(geoprior_home() / "experiments" / "paper")) {
    if (entry.path().extension() == ".toml") files.insert(entry.path());
  }
  return {files.begin(), files.end()};
}

/// A point of the pattern that a handle moves.
struct Anchor {
  const Handle* handle;
  Eigen::Vector2d pattern;
  Eigen::Vector3d rest, centre;
};

std::vector<Anchor> anchors_of(const Sheet& sheet) {
  std::vector<Anchor> anchors;
  for (const Handle& handle : sheet.handles) {
    if (!handle.motion) continue;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    const std::vector<Eigen::Vector2d> points = handle.anchors();
    for (const Eigen::Vector2d& p : points) {
      centre += sheet.rest_place(p, 1) / static_cast<double>(points.size());
    }
    for (const Eigen::Vector2d& p : points) {
      anchors.push_back({&handle, p, sheet.rest_place(p, 1), centre});
    }
  }
  return anchors;
}

TEST(PaperExperiments, AreTheElevenThatTheTopicHas) {
  EXPECT_EQ(experiment_files().size(), 11U);
  for (const fs::path& file : experiment_files()) {
    for (const bool quick : {false, true}) {
      LoadRequest request;
      request.quick = quick;
      const Experiment experiment = load_experiment(file, all_topics(), request);
      EXPECT_FALSE(experiment.cases.empty()) << file;
      for (const CaseSpec& c : experiment.cases) {
        EXPECT_NO_THROW(paper_topic().load(*c.scene, file.parent_path())) << file;
      }
    }
  }
}

// On a convex pattern two points of an isometric sheet are never farther apart in space than in the
// pattern. The imperfection may add a ten-thousandth.
TEST(PaperExperiments, NeverPullTwoHandlesFartherApartThanTheirPatternAllows) {
  for (const fs::path& file : experiment_files()) {
    const Experiment experiment = load_experiment(file, all_topics(), {});
    const auto scene = paper_topic().load(*experiment.cases[0].scene, file.parent_path());
    const Sheet& sheet = dynamic_cast<const PaperScene&>(*scene).sheet;
    const std::vector<Anchor> anchors = anchors_of(sheet);
    for (int step = 0; step <= 1000; ++step) {
      const double t = sheet.duration * step / 1000;
      for (const Anchor& a : anchors) {
        for (const Anchor& b : anchors) {
          if (!a.handle->is_active(t) || !b.handle->is_active(t)) continue;
          const double apart =
              (a.handle->target(a.rest, a.centre, t) - b.handle->target(b.rest, b.centre, t))
                  .norm();
          ASSERT_LE(apart, (1 + 1e-4) * (a.pattern - b.pattern).norm() + 1e-12)
              << file << ": '" << a.handle->name << "' and '" << b.handle->name << "' at " << t;
        }
      }
    }
  }
}

}  // namespace
}  // namespace geoprior::test
