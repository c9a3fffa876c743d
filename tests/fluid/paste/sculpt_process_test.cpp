#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "solvers/fluid/extract.h"
#include "solvers/fluid/sculpt.h"
#include "solvers/fluid/sculpt_scene.h"
#include "solvers/fluid/warnings.h"
#include "tests/core/geometry/shapes.h"
#include "tests/fluid/features/map_waves.h"
#include "tests/fluid/paste/sculpt_fixture.h"

namespace geoprior::fluid {
namespace {

using namespace waves;
using sculpt_fixture::Sink;
using sculpt_fixture::splash;
using sculpt_fixture::Stopping;

/// A library with one drop and one wave, each living from 0 to 0.2 s.
std::vector<Feature> library() {
  const Labelled source =
      labelled(tank(30, 2, 1, 0.25), 31 * 31, hill({.velocity = {0.5, 0}}), 6, 0.04, 2.0 / 30);
  Feature wave = source.lift(), drop;
  drop.id = 2;
  drop.kind = RegionKind::isolated;
  for (int f = 0; f < 6; ++f) {
    drop.times.push_back(0.04 * f);
    drop.placement.emplace_back(Eigen::Translation3d(1, 1, 1 - 0.1 * f));
    drop.meshes.push_back(shapes::sphere(2));
    drop.meshes.back().V *= 0.1;
    drop.area.push_back(0.13);
  }
  return {wave, drop};
}

SculptScene scene() {
  SculptScene result;
  result.libraries["waves"] = library();
  SurfaceFrame still;
  still.mesh = tank(20, 2, 1, 0.25);
  result.target = std::make_shared<StoredSequence>(std::vector<SurfaceFrame>{still}, "still");
  for (int f = 0; f < 8; ++f) result.times.push_back(0.04 * f);
  Edit edit;
  edit.name = "both";
  edit.move = {0.1, 0, 0};
  result.edits = {edit};
  return result;
}

Sink run(const SculptScene& s, const std::optional<State>& resume = {}) {
  Sink sink;
  RunContext context;
  make_sculpt(s, {})->run(sink, context, resume);
  return sink;
}

const NamedArray& array(const Frame& frame, const std::string& name) {
  return frame.require_array("surface", name, NamedArray::On::points);
}

TEST(Sculpt, PastesALibraryWhileItsFeaturesLive) {
  const SculptScene s = scene();
  const Sink sink = run(s);
  ASSERT_EQ(sink.frames.size(), 8U);
  EXPECT_EQ(sink.states.size(), 8U);
  const int target = s.target->frame(0).mesh.triangle_count();
  for (std::size_t i = 0; i < 8; ++i) {
    const Frame& frame = sink.frames[i];
    const bool alive = frame.parameter < 0.2 + 1e-9;
    EXPECT_EQ(frame.diagnostics.at("features"), alive ? 2 : 0) << i;
    EXPECT_EQ(frame.require_table("insertions").rows.rows(), alive ? 2 : 0);
    EXPECT_EQ(frame.require_part("surface").triangles.rows(),
              target + frame.diagnostics.at("added_triangles"));
    const Eigen::MatrixXd& ids = array(frame, "feature").values;
    EXPECT_EQ(ids.maxCoeff(), alive ? 2 : 0);
    EXPECT_EQ((ids.array() == 1).any(), alive);
    EXPECT_EQ(array(frame, "velocity").values.rows(), frame.require_part("surface").points.rows());
  }
  EXPECT_EQ(sink.frames[0].diagnostics.at("lifted_features"), 2);
}

TEST(Sculpt, GoesOnWhereItWasStopped) {
  const SculptScene s = scene();
  const Sink whole = run(s);
  Sink first;
  Stopping context(first, 3);
  make_sculpt(s, {})->run(first, context, {});
  ASSERT_EQ(first.frames.size(), 3U);
  const Sink rest = run(s, first.states.back());
  ASSERT_EQ(rest.frames.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(rest.frames[i].require_part("surface").points,
              whole.frames[i + 3].require_part("surface").points);
  }
  EXPECT_THROW(run(s, State{}), Error);
}

TEST(Sculpt, WarnsOnceOfEachThing) {
  SculptScene s = scene();
  s.edits[0].ids = {1};
  s.edits.push_back(s.edits[0]);
  s.edits[1].name = "again";
  s.edits[1].move = {0.2, 0, 0};  // overlaps in every frame
  s.edits.push_back(s.edits[0]);
  s.edits[2].name = "late";
  s.edits[2].start = 100;
  const Sink sink = run(s);
  ASSERT_EQ(sink.events.size(), 2U);
  EXPECT_NE(sink.events[0].kind.find("edit 'late', feature 1: lives at none"), std::string::npos);
  EXPECT_NE(sink.events[1].kind.find("'again' and 'both' overlap"), std::string::npos);
}

TEST(Sculpt, RefusesWhatCannotBeMeant) {
  const auto message = [](auto change) -> std::string {
    SculptScene s = scene();
    change(s);
    try {
      run(s);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(message([](SculptScene& s) { s.edits[0].ids = {9}; }), "allowed: 1, 2"));
  EXPECT_TRUE(has(message([](SculptScene& s) { s.edits[0].source = "sea"; }), "allowed: waves"));
  EXPECT_TRUE(has(message([](SculptScene& s) {
                    s.edits[0].move = {50, 0, 0};
                  }),
                  "lies off the target at all times"));
  EXPECT_TRUE(has(message([](SculptScene& s) { s.edits.push_back(s.edits[0]); }), "this name"));
  EXPECT_TRUE(has(message([](SculptScene& s) { s.edits.clear(); }), "no edits"));
  EXPECT_TRUE(has(message([](SculptScene& s) { s.times.clear(); }), "no times"));
  EXPECT_TRUE(has(message([](SculptScene& s) { s.target = nullptr; }), "a target"));
}

TEST(Sculpt, WarningsRememberWhatTheyTold) {
  Warnings warnings;
  Sink sink;
  warnings.warn("a at 1 s", "a", 1, sink);
  warnings.warn("a at 2 s", "a", 2, sink);
  warnings.warn("b", "b", 2, sink);
  EXPECT_EQ(sink.events.size(), 2U);
  StateWriter out;
  warnings.save(out);
  const State saved = out.take();
  StateReader in(saved);
  Warnings back;
  back.load(in);
  back.warn("a at 3 s", "a", 3, sink);
  back.warn("b", "b", 3, sink);
  EXPECT_EQ(sink.events.size(), 2U);
  back.warn("c", "c", 3, sink);
  EXPECT_EQ(sink.events.size(), 3U);
}

TEST(Sculpt, ExtractsWaveAndDropAndPastesThemElsewhere) {
  SculptScene s;
  s.sources["splash"] = splash();
  Sink extracted;
  RunContext context;
  make_extract(s, {})->run(extracted, context, {});
  ASSERT_EQ(extracted.frames.size(), 12U);
  const Frame& last = extracted.frames.back();
  const Eigen::MatrixXd& tracks = last.require_table("tracks").rows;
  ASSERT_EQ(tracks.rows(), 2);
  EXPECT_EQ(tracks.col(1).minCoeff(), 1);  // the drop
  EXPECT_EQ(tracks.col(1).maxCoeff(), 2);  // the hill
  EXPECT_EQ(array(last, "kind").values.maxCoeff(), 2);
  EXPECT_EQ(last.diagnostics.at("regions"), 2);

  SurfaceFrame still;
  still.mesh = tank(40, 4, 1, 0.2);
  s.target = std::make_shared<StoredSequence>(std::vector<SurfaceFrame>{still}, "still");
  for (int f = 0; f < 12; ++f) s.times.push_back(0.04 * f);
  Edit edit;
  edit.name = "splash";
  edit.move = {1, 1, 0};
  s.edits = {edit};
  const Sink pasted = run(s);
  ASSERT_EQ(pasted.frames.size(), 12U);
  EXPECT_EQ(pasted.frames[1].diagnostics.at("features"), 1);
  EXPECT_EQ(pasted.frames[11].diagnostics.at("features"), 2);
  // The hill of 0.17 m stands at (2, 2) of the target now, its foot lost below the threshold.
  const Eigen::MatrixX3d& V = pasted.frames[11].require_part("surface").points;
  const Eigen::MatrixXd& feature = array(pasted.frames[11], "feature").values;
  double top = 0;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    if ((V.row(v).head<2>() - Eigen::RowVector2d(2, 2)).norm() < 0.3 && feature(v, 0) > 0) {
      top = std::max(top, V(v, 2));
    }
  }
  EXPECT_NEAR(top, 0.17, 0.03);
}

}  // namespace
}  // namespace geoprior::fluid
