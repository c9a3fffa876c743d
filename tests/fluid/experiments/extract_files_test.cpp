// Features that leave an extraction: maps a frame, the library, pictures; and what a library is
// for.

#include "experiments/fluid/scene/extract_files.h"

#include <gtest/gtest.h>

#include "experiments/fluid/scene/exr_maps.h"
#include "experiments/fluid/scene/feature_files.h"
#include "solvers/fluid/sculpt.h"
#include "tests/fluid/paste/sculpt_fixture.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::fluid {
namespace {

using sculpt_fixture::Sink;
using test::expect_error;

/// A hill that grows from 0.1 m (frame 4) to 0.17 m (frame 11) in a calm pool, and a drop.
SculptScene splash_scene() {
  SculptScene scene;
  scene.sources["splash"] = sculpt_fixture::splash();
  return scene;
}

StoredExtractOptions lifting() {
  StoredExtractOptions options;
  options.extract.lift = true;
  return options;
}

Sink extract(const StoredExtractOptions& options, const std::optional<State>& resume = {}) {
  Sink sink;
  RunContext context;
  make_extract(splash_scene(), options.extract, feature_files(options))->run(sink, context, resume);
  return sink;
}

const Eigen::MatrixXd& array(const Part& part, const std::string& name) {
  return part.require_array(name, NamedArray::On::points).values;
}

class ExtractFiles : public test::ScratchFolder {
 protected:
  std::vector<Feature> library_of(const Sink& sink) {
    return read_feature_library(write("features.h5", test::text_of(sink.artifacts.at(0).bytes)));
  }
};

TEST_F(ExtractFiles, MapOfTheHillIsInEveryFrameAndTheHillInTheMap) {
  const Sink sink = extract(lifting());
  ASSERT_EQ(sink.frames.size(), 12U);
  const Part& first = sink.frames.front().require_part("map");
  for (const Frame& frame : sink.frames) {
    const Part& map = frame.require_part("map");
    EXPECT_EQ(map.kind, Part::Kind::grid);
    EXPECT_EQ(map.grid_size, first.grid_size);
    EXPECT_EQ(array(map, "height"),
              array(map, "alpha").cwiseProduct(array(map, "displacement").col(2)));
  }
  // The pool is calm up to frame 3: there is no hill yet, and nothing in its map.
  EXPECT_EQ(array(first, "alpha").cwiseAbs().maxCoeff(), 0);
  // 0.17 m, less its foot, which lies below the threshold.
  const Eigen::MatrixXd& height = array(sink.frames.back().require_part("map"), "height");
  Eigen::Index top = 0;
  EXPECT_NEAR(height.col(0).maxCoeff(&top), 0.17, 0.03);
  // It stands in the middle of its map, to a texel.
  const int n = first.grid_size[0];
  EXPECT_NEAR(static_cast<double>(top % n), (n - 1) / 2.0, 1.5);
  EXPECT_NEAR(static_cast<double>(top / n), (n - 1) / 2.0, 1.5);
  EXPECT_NEAR(first.grid_origin.x(), -first.grid_spacing.x() * (n - 1) / 2.0, 1e-12);
}

TEST_F(ExtractFiles, LibraryAndPicturesHoldWhatWasLifted) {
  StoredExtractOptions options = lifting();
  options.exr = true;
  const Sink sink = extract(options);
  ASSERT_FALSE(sink.artifacts.empty());
  EXPECT_EQ(sink.artifacts[0].name, "features.h5");
  const std::vector<Feature> features = library_of(sink);
  ASSERT_EQ(features.size(), 2U);
  const bool first_is_wave = features[0].kind == RegionKind::differential;
  const Feature& wave = features[first_is_wave ? 0 : 1];
  const Feature& drop = features[first_is_wave ? 1 : 0];
  EXPECT_EQ(wave.kind, RegionKind::differential);
  EXPECT_EQ(drop.kind, RegionKind::isolated);
  ASSERT_EQ(sink.artifacts.size(), 1 + wave.maps.size());
  std::vector<std::filesystem::path> pictures;
  for (std::size_t i = 1; i < sink.artifacts.size(); ++i) {
    pictures.push_back(write(sink.artifacts[i].name, test::text_of(sink.artifacts[i].bytes)));
  }
  EXPECT_EQ(sink.artifacts[1].name, "feature" + std::to_string(wave.id) + "_0000.exr");
  EXPECT_EQ(read_exr_maps(pictures).maps.back().displacement, wave.maps.back().displacement);

  double file_bytes = 0;
  for (const Artifact& file : sink.artifacts) file_bytes += static_cast<double>(file.bytes.size());
  const std::map<std::string, double>& known = sink.frames.back().diagnostics;
  EXPECT_EQ(known.at("lifted_features"), 2);
  EXPECT_EQ(known.at("feature_bytes"), static_cast<double>(wave.bytes() + drop.bytes()));
  EXPECT_EQ(known.at("feature_file_bytes"), file_bytes);
  // 65 x 65 vertices twice and the drop's 66; 24 bytes a position, 12 a triangle, 12 frames.
  const TriMesh mesh = splash_scene().sources.at("splash")->frame(0).mesh;
  EXPECT_EQ(known.at("sequence_bytes"),
            12.0 * (24.0 * (2 * 65 * 65 + 66) + 12.0 * mesh.triangle_count()));
  EXPECT_EQ(sink.frames.back().require_table("features").rows.rows(), 2);
}

TEST_F(ExtractFiles, PastingFromALibraryIsPastingWhatIsLiftedAnewBitForBit) {
  SculptScene scene = splash_scene();
  SurfaceFrame still;
  still.mesh = waves::tank(40, 4, 1, 0.2);
  scene.target = std::make_shared<StoredSequence>(std::vector<SurfaceFrame>{still}, "still");
  for (int f = 0; f < 12; ++f) scene.times.push_back(0.04 * f + 0.01);  // between frames, too
  Edit edit;
  edit.name = "splash";
  edit.move = {1, 1, 0};
  edit.turn_deg = 30;
  scene.edits = {edit};
  RunContext context;
  Sink lifted, stored;
  make_sculpt(scene, {})->run(lifted, context, {});
  scene.sources.clear();
  scene.libraries["stored"] = library_of(extract(lifting()));
  make_sculpt(scene, {})->run(stored, context, {});
  ASSERT_EQ(lifted.frames.size(), 12U);
  ASSERT_EQ(stored.frames.size(), 12U);
  EXPECT_EQ(lifted.frames[10].diagnostics.at("features"), 2);
  for (std::size_t i = 0; i < 12; ++i) {
    const Part& a = lifted.frames[i].require_part("surface");
    const Part& b = stored.frames[i].require_part("surface");
    EXPECT_EQ(a.points, b.points) << i;
    EXPECT_EQ(a.triangles, b.triangles) << i;
    EXPECT_EQ(array(a, "velocity"), array(b, "velocity")) << i;
    EXPECT_EQ(array(a, "feature"), array(b, "feature")) << i;
  }
}

TEST_F(ExtractFiles, AreTheSameAfterAnInterruption) {
  const StoredExtractOptions options = lifting();
  const Sink whole = extract(options);
  Sink first;
  sculpt_fixture::Stopping context(first, 5);
  make_extract(splash_scene(), options.extract, feature_files(options))->run(first, context, {});
  ASSERT_EQ(first.frames.size(), 5U);
  EXPECT_TRUE(first.artifacts.empty());
  const Sink rest = extract(options, first.states.back());
  ASSERT_EQ(rest.frames.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(array(rest.frames[i].require_part("map"), "displacement"),
              array(whole.frames[i + 5].require_part("map"), "displacement"));
  }
  ASSERT_EQ(rest.artifacts.size(), 1U);
  EXPECT_EQ(rest.artifacts[0].bytes, whole.artifacts[0].bytes);
  // Artifacts come before the last checkpoint: a run that goes on from there leaves none twice.
  const Sink nothing = extract(options, whole.states.back());
  EXPECT_TRUE(nothing.frames.empty());
  EXPECT_TRUE(nothing.artifacts.empty());
}

TEST_F(ExtractFiles, OnlyWhenAskedForAndOfAFeatureThatIsThere) {
  const Sink plain = extract({});
  EXPECT_TRUE(plain.artifacts.empty());
  EXPECT_FALSE(plain.frames.back().parts.contains("map"));
  EXPECT_FALSE(plain.frames.back().diagnostics.contains("lifted_features"));
  StoredExtractOptions options = lifting();
  options.extract.map_feature = 99;
  expect_error([&] { extract(options); }, {"no differential feature 99", "map_feature"});
}

}  // namespace
}  // namespace geoprior::fluid
