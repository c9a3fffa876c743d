// The camera that a scene suggests, where the experiment file leaves it free.

#include "testbed/runner/scene_camera.h"

#include <gmock/gmock.h>

#include "testbed/runner/opened_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior {
namespace {

using test::error_of;
using ::testing::HasSubstr;

constexpr std::array<double, 3> kTarget{2, 0, 0};  // of the disc of radius 2 m

class SceneCamera : public test::RunTest {
 protected:
  /// The view in which the record of a run of the disc is drawn.
  [[nodiscard]] FigureView drawn(const std::string& figure_view) const {
    const Experiment experiment = load(
        circle("radius_m = 2\nsuggests_camera = true\nmotion = { frames = 2 }\n" + figure_view));
    const ExecuteResult result = run(experiment, folder() / "out");
    const RunRecord record = OpenedRun(result.folder).record();
    return with_scene_camera(experiment.view, record, "run.h5");
  }
};

TEST_F(SceneCamera, IsTakenWhereTheFileSaysNothingOfTheCamera) {
  const FigureView view = drawn("");
  EXPECT_EQ(view.target, kTarget);
  EXPECT_EQ(view.direction, (std::array<double, 3>{0, 0, 1}));
  EXPECT_EQ(view.height_m, 2);
}

TEST_F(SceneCamera, LeavesOtherKeysOfTheFile) {
  const FigureView view = drawn("[figure_view]\nedges = true\n");
  EXPECT_EQ(view.target, kTarget);
  EXPECT_TRUE(view.edges);
}

TEST_F(SceneCamera, GivesWayToAnyKeyOfTheFilesOwn) {
  for (const char* key :
       {"target = [0, 0, 0]", "direction = [0, 1, 1]", "up = [1, 0, 0]", "height_m = 3"}) {
    std::filesystem::remove_all(folder() / "out");
    EXPECT_NE(drawn(std::string("[figure_view]\n") + key + "\n").target, kTarget) << key;
  }
}

TEST(SceneCameraText, IsReadAsKeysOfAFigureView) {
  const Camera camera{{0.1, -2, 3e-9}, {1, 0, 0}, {0, 0, 1}, 0.25};
  RunRecord record;
  record.cases.resize(1);
  record.cases[0].camera = camera_text(camera);
  const FigureView view = with_scene_camera({}, record, "run.h5");
  EXPECT_EQ(view.target, camera.target);
  EXPECT_EQ(view.up, camera.up);
  EXPECT_EQ(view.height_m, camera.height_m);
}

TEST(SceneCameraText, DamagedIsNamed) {
  RunRecord record;
  record.cases.resize(1);
  record.cases[0].camera = "height_m = -1\n";
  EXPECT_THAT(error_of([&] { with_scene_camera({}, record, "my/run.h5"); }),
              HasSubstr("my/run.h5, camera of the scene"));
}

}  // namespace
}  // namespace geoprior
