#include "models/paper/sheet/process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "baselines/paper/adaptive/adaptive.h"
#include "baselines/paper/dense.h"
#include "core/error.h"
#include "models/paper/meshing/transfer.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/sheet/handle_speed.h"
#include "tests/support/recording.h"

namespace geoprior::paper {
namespace {

using test::Recording;

using ::testing::HasSubstr;

/// Wishes to stop once so many frames are done.
class StoppingContext final : public RunContext {
 public:
  explicit StoppingContext(const Recording& recording, std::size_t frames)
      : recording_(recording), frames_(frames) {}
  [[nodiscard]] bool stop_requested() const override { return recording_.frames.size() >= frames_; }

 private:
  const Recording& recording_;
  std::size_t frames_;
};

Keyframe key(double time, const Eigen::Vector3d& shift) {
  return {time, shift, Eigen::Quaterniond::Identity()};
}

/// 10 cm square, two opposite edges of which approach by 4 cm.
Sheet bent_square() {
  Sheet sheet;
  sheet.pattern = rectangle_pattern(0.1, 0.1);
  for (const double side : {-1.0, 1.0}) {
    Handle edge;
    edge.segment = {Eigen::Vector2d(side * 0.05, -0.05), Eigen::Vector2d(side * 0.05, 0.05)};
    edge.motion = Trajectory{{key(0, {0, 0, 0}), key(0.2, {-side * 0.02, 0, 0})}};
    sheet.handles.push_back(edge);
  }
  sheet.duration = 0.2;
  sheet.frame_interval = 0.04;
  sheet.substeps = 4;
  sheet.handle_step = 1;
  return sheet;
}

std::unique_ptr<Process> dense(const Sheet& sheet, const StepperOptions& stepper = {}) {
  DenseOptions options;
  options.triangles = 200;
  options.stepper = stepper;
  return make_dense_sheet(sheet, options);
}

Recording run(Process& process, const std::optional<State>& from = {}) {
  Recording recording;
  RunContext context(7);
  process.run(recording, context, from);
  return recording;
}

void expect_same(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.parameter, b.parameter);
  EXPECT_EQ(a.diagnostics, b.diagnostics);
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (const auto& [name, part] : a.parts) {
    const Part& other = b.require_part(name);
    EXPECT_EQ(part.points, other.points) << name;
    EXPECT_EQ(part.triangles, other.triangles) << name;
    ASSERT_EQ(part.arrays.size(), other.arrays.size());
    for (std::size_t i = 0; i < part.arrays.size(); ++i) {
      EXPECT_EQ(part.arrays[i].values, other.arrays[i].values) << part.arrays[i].name;
    }
  }
}

TEST(SheetProcess, RecordsTheStartAndThenAFrameAnInterval) {
  const Sheet sheet = bent_square();
  const Recording r = run(*dense(sheet));
  ASSERT_EQ(r.frames.size(), 6U);
  EXPECT_EQ(r.frames[0].parameter, 0);
  EXPECT_EQ(r.frames[3].parameter, 0.12);
  for (const Frame& frame : r.frames) {
    const Part& surface = frame.require_part("surface");
    ASSERT_EQ(surface.arrays.size(), 4U);
    EXPECT_EQ(surface.arrays[0].values.rows(), surface.points.rows());
    EXPECT_EQ(surface.arrays[2].values.rows(), surface.triangles.rows());
    EXPECT_EQ(frame.diagnostics.at("triangles"), static_cast<double>(surface.triangles.rows()));
    EXPECT_EQ(frame.diagnostics.at("substeps"), frame.parameter == 0 ? 0 : 4);
  }
  // Bringing the edges together bends the sheet: that takes work.
  EXPECT_GT(r.frames[5].diagnostics.at("handle_work"), 0);
}

/// After every second frame its mesh would be one on which no step converges: a triangle lies on
/// its neighbour.
class FoldingMesher final : public SheetMesher {
 public:
  explicit FoldingMesher(bool gives_back) : gives_back_(gives_back) {}
  ShellState start(const Sheet& sheet, RunContext& context) override {
    return resting_state(sheet, uniform_mesh(sheet.pattern, 60, UniformLayout::equilateral, {}, 1),
                         context.seed());
  }
  bool adapt(const Sheet& /*sheet*/, ShellStepper& /*stepper*/, ShellState& state,
             RunContext& /*context*/) override {
    if (++frames_ % 2 != 0) return false;
    before_ = state;
    const Eigen::RowVector3i t = state.mesh.triangles.row(state.mesh.triangle_count() / 2);
    state.x.row(t[0]) = state.x.row(t[1]) + state.x.row(t[2]) - state.x.row(t[0]);
    state.x.row(t[1]) = state.x.row(t[2]);
    return true;
  }
  bool take_back(const Sheet& /*sheet*/, ShellState& state, RunContext& /*context*/) override {
    ++taken_back_;
    if (gives_back_) state = before_;
    return gives_back_;
  }
  void annotate(const ShellState& /*state*/, Frame& frame) const override {
    frame.diagnostics["taken_back"] = taken_back_;
  }

 private:
  bool gives_back_;
  int frames_ = 0, taken_back_ = 0;
  ShellState before_;
};

TEST(SheetProcess, GoesOnWithTheMeshBeforeOneThatTakesNoStep) {
  Sheet sheet = bent_square();
  sheet.handles.clear();
  sheet.gravity = {0, 0, 0};
  SheetProcess process(sheet, {}, std::make_unique<FoldingMesher>(true));
  const Recording r = run(process);
  ASSERT_EQ(r.frames.size(), 6U);
  EXPECT_EQ(r.frames.back().diagnostics.at("taken_back"), 2);
  EXPECT_LT((r.frames.back().parts.at("surface").points - r.frames[0].parts.at("surface").points)
                .cwiseAbs()
                .maxCoeff(),
            1e-3);
  SheetProcess stuck(sheet, {}, std::make_unique<FoldingMesher>(false));
  EXPECT_THROW(run(stuck), Error);
}

/// Says of every mesh, when the sheet has settled, that it is to be taken back.
class UneasyMesher final : public SheetMesher {
 public:
  ShellState start(const Sheet& sheet, RunContext& context) override {
    return resting_state(sheet, uniform_mesh(sheet.pattern, 60, UniformLayout::equilateral, {}, 1),
                         context.seed());
  }
  bool adapt(const Sheet& /*sheet*/, ShellStepper& /*stepper*/, ShellState& state,
             RunContext& /*context*/) override {
    before_ = state;
    state.x.col(2).array() += 1;
    return true;
  }
  bool settle(const Sheet& /*sheet*/, ShellStepper& /*stepper*/, ShellState& /*state*/,
              RunContext& /*context*/) override {
    return false;
  }
  bool take_back(const Sheet& /*sheet*/, ShellState& state, RunContext& /*context*/) override {
    state = before_;
    return true;
  }
  void annotate(const ShellState& /*state*/, Frame& /*frame*/) const override {}

 private:
  ShellState before_;
};

TEST(SheetProcess, GoesOnWithTheMeshBeforeOneThatItsMesherTakesBack) {
  Sheet sheet = bent_square();
  sheet.handles.clear();
  sheet.gravity = {0, 0, 0};
  SheetProcess process(sheet, {}, std::make_unique<UneasyMesher>());
  const Recording r = run(process);
  ASSERT_EQ(r.frames.size(), 6U);
  EXPECT_LT((r.frames.back().parts.at("surface").points - r.frames[0].parts.at("surface").points)
                .cwiseAbs()
                .maxCoeff(),
            1e-3);
}

TEST(HandleSpeed, IsThatOfTheFastestPointThatHolds) {
  Sheet sheet = bent_square();
  // A patch that turns by a right angle within 0.1 s: its rim at 2 cm goes pi/2 * 0.02 m.
  Handle patch;
  patch.points = {Eigen::Vector2d::Zero()};
  patch.disc_radius = 0.02;
  Keyframe turned = key(0.1, {0, 0, 0});
  turned.turn = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
  patch.motion = Trajectory{{key(0, {0, 0, 0}), turned}};
  sheet.handles = {patch};
  const double way = std::numbers::pi / 2 * 0.02;
  // From rest to rest by a cubic: at most 3/2 of the mean speed, half-way.
  EXPECT_NEAR(handle_speed(sheet, 0, 0.1, 200), 1.5 * way / 0.1, 1e-4);
  EXPECT_EQ(handle_speed(sheet, 0.2, 0.3, 4), 0);
  // While it does not hold the sheet it goes where it likes.
  sheet.handles[0].active = {{0.5, 1}};
  EXPECT_EQ(handle_speed(sheet, 0, 0.1, 4), 0);
}

TEST(HandleSpeed, DecidesHowManyStepsAFrameHas) {
  Sheet sheet = bent_square();
  sheet.handle_step = 1e-3;
  // 0.02 m in 0.2 s, from rest to rest: in the middle frame 0.04 s at close to 0.15 m/s.
  const int middle = substeps_of_frame(sheet, 0.08, 0.12);
  EXPECT_GE(middle, 6);
  EXPECT_LE(middle, 7);
  EXPECT_EQ(substeps_of_frame(sheet, 0.2, 0.24), sheet.substeps) << "at rest";
  sheet.handle_step = 1e-12;
  EXPECT_EQ(substeps_of_frame(sheet, 0.08, 0.12), 1000) << "within reason";
}

TEST(SheetProcess, TakesMoreStepsWhereHandlesAreFast) {
  Sheet sheet = bent_square();
  sheet.handle_step = 1e-3;
  const Recording r = run(*dense(sheet));
  for (std::size_t f = 1; f < r.frames.size(); ++f) {
    EXPECT_EQ(r.frames[f].diagnostics.at("substeps"),
              substeps_of_frame(sheet, r.frames[f - 1].parameter, r.frames[f].parameter));
  }
  EXPECT_GT(r.frames[3].diagnostics.at("substeps"), sheet.substeps);
}

TEST(SheetProcess, PutsHandlesWhereTheirTrajectoriesAre) {
  const Sheet sheet = bent_square();
  const Recording r = run(*dense(sheet));
  for (const Frame& frame : r.frames) {
    const Part& held = frame.require_part("handles");
    ASSERT_GE(held.points.rows(), 4);
    for (Eigen::Index i = 0; i < held.points.rows(); ++i) {
      const auto h = static_cast<std::size_t>(held.arrays[0].values(i, 0));
      const double x =
          (h == 0 ? -0.05 : 0.05) + sheet.handles[h].motion->at(frame.parameter).shift.x();
      EXPECT_NEAR(held.points(i, 0), x, 1e-12) << "at " << frame.parameter;
    }
  }
}

TEST(SheetProcess, GivesTheSameFramesWhenResumed) {
  const Sheet sheet = bent_square();
  AdaptiveOptions options;
  options.size_max = 0.05;
  const auto makers = std::vector<std::function<std::unique_ptr<Process>()>>{
      [&] { return dense(sheet); }, [&] { return make_adaptive_sheet(sheet, options); }};
  for (const auto& make : makers) {
    const Recording whole = run(*make());
    ASSERT_EQ(whole.checkpoints.size(), whole.frames.size());
    for (const std::size_t done : {1U, 4U, 6U}) {
      const Recording rest = run(*make(), whole.checkpoints[done - 1]);
      ASSERT_EQ(rest.frames.size(), whole.frames.size() - done);
      for (std::size_t i = 0; i < rest.frames.size(); ++i) {
        expect_same(rest.frames[i], whole.frames[done + i]);
      }
    }
  }
}

TEST(SheetProcess, RefusesACheckpointThatIsCutOff) {
  const Sheet sheet = bent_square();
  State state = run(*dense(sheet)).checkpoints[2];
  state.resize(state.size() / 2);
  EXPECT_THROW(run(*dense(sheet), state), Error);
}

TEST(SheetProcess, StopsBetweenTwoFrames) {
  const Sheet sheet = bent_square();
  Recording recording;
  StoppingContext context(recording, 3);
  dense(sheet)->run(recording, context, {});
  EXPECT_EQ(recording.frames.size(), 3U);
  EXPECT_EQ(recording.checkpoints.size(), 3U);
}

// The handles rest until 0.08 s; from then on they are asked to go to the end of the numbers.
TEST(SheetProcess, KeepsTheFramesBeforeAStepThatFails) {
  Sheet sheet = bent_square();
  sheet.imperfection = 0;
  sheet.gravity.setZero();
  for (Handle& handle : sheet.handles) {
    handle.motion->keys[0].time = 0.08;
    handle.motion->keys[1].shift.x() = std::numeric_limits<double>::max();
  }
  Recording recording;
  RunContext context;
  std::string error;
  try {
    dense(sheet)->run(recording, context, {});
  } catch (const Error& e) {
    error = e.what();
  }
  EXPECT_THAT(error, HasSubstr("does not converge"));
  EXPECT_THAT(error, HasSubstr("time 0.08"));
  EXPECT_EQ(recording.frames.size(), 3U);
  EXPECT_EQ(recording.checkpoints.size(), 3U);
}

/// Changes to another mesh after the first frame, and remembers that it did.
class SwitchingMesher final : public SheetMesher {
 public:
  ShellState start(const Sheet& sheet, RunContext& context) override {
    ShellState state;
    state.mesh = mesh(sheet, 60);
    const int n = state.mesh.vertex_count();
    state.x.resize(n, 3);
    for (int i = 0; i < n; ++i) {
      state.x.row(i) = sheet.rest_place(state.mesh.pattern.row(i), context.seed());
    }
    state.v.setZero(n, 3);
    state.plastic_curvature.setZero(state.mesh.triangle_count(), 3);
    state.damage.setZero(state.mesh.triangle_count());
    return state;
  }
  bool adapt(const Sheet& sheet, ShellStepper& /*stepper*/, ShellState& state,
             RunContext& /*context*/) override {
    if (switched_) return false;
    switched_ = true;
    state = transfer_state(state, mesh(sheet, 150));
    return true;
  }
  void annotate(const ShellState& /*state*/, Frame& frame) const override {
    frame.diagnostics["switched"] = switched_ ? 1 : 0;
  }
  void save(StateWriter& out) const override { out.number(switched_); }
  void load(const Sheet& /*sheet*/, StateReader& in) override { switched_ = in.number<bool>(); }

 private:
  static ShellMesh mesh(const Sheet& sheet, int triangles) {
    std::vector<Eigen::Vector2d> anchors;
    for (const Handle& handle : sheet.handles) {
      for (const Eigen::Vector2d& p : handle.anchors()) anchors.push_back(p);
    }
    return uniform_mesh(sheet.pattern, triangles, UniformLayout::delaunay, anchors, 1);
  }
  bool switched_ = false;
};

TEST(SheetProcess, GoesOnAfterAChangeOfConnectivityAndSavesTheMesher) {
  const Sheet sheet = bent_square();
  SheetProcess process(sheet, {}, std::make_unique<SwitchingMesher>());
  const Recording whole = run(process);
  ASSERT_EQ(whole.frames.size(), 6U);
  EXPECT_LT(whole.frames[0].diagnostics.at("triangles"), 100);
  EXPECT_GT(whole.frames[1].diagnostics.at("triangles"), 100);
  SheetProcess again(sheet, {}, std::make_unique<SwitchingMesher>());
  const Recording rest = run(again, whole.checkpoints[2]);
  for (std::size_t i = 0; i < rest.frames.size(); ++i) {
    expect_same(rest.frames[i], whole.frames[3 + i]);
  }
}

// A sheet that hangs from its upper edge: rho_s A g. It starts unstretched, so that it first
// settles by the strain of its own weight (1e-7); implicit Euler damps that within a few steps.
TEST(SheetProcess, HangingSheetPullsItsHandleByItsWeight) {
  Sheet sheet = bent_square();
  sheet.handles.resize(1);
  sheet.handles[0].segment = {Eigen::Vector2d(-0.05, 0.05), Eigen::Vector2d(0.05, 0.05)};
  sheet.handles[0].motion = Trajectory{{key(0, {0, 0, 0})}};
  sheet.imperfection = 0;
  sheet.placement = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  const Recording r = run(*dense(sheet));
  const Part& held = r.frames.back().require_part("handles");
  const Eigen::RowVector3d force = held.arrays[1].values.colwise().sum();
  EXPECT_NEAR(force.z(), 0.08 * 0.01 * 9.81, 1e-4 * 0.08 * 0.01 * 9.81);
  EXPECT_NEAR(force.head<2>().norm(), 0, 1e-6);
}

TEST(SheetProcess, RefusesASheetThatIsNotValid) {
  Sheet sheet = bent_square();
  sheet.material.thickness = 0;
  EXPECT_THROW(SheetProcess(sheet, {}, std::make_unique<SwitchingMesher>()), Error);
}

}  // namespace
}  // namespace geoprior::paper
