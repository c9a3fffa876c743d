// How many d-cones dense runs of one scene have, from seed to seed, and whether the hybrid's lie
// among them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "baselines/paper/dense.h"
#include "experiments/paper/measures.h"
#include "experiments/paper/topic.h"
#include "solvers/paper/hybrid.h"
#include "testbed/home.h"
#include "testbed/runner/spec/spec.h"
#include "tests/support/recording.h"

namespace geoprior::paper {
namespace {

using test::Recording;

namespace fs = std::filesystem;

/// GEOPRIOR_LONG asks for all scenes, ten seeds and 4,096 triangles.
bool is_long() { return std::getenv("GEOPRIOR_LONG") != nullptr; }

/// Where the hybrid's median lies. What is known to fall short is said, so that its end is seen.
enum class Place { below, within, above };

struct Planned {
  std::string scene;
  Place place = Place::within;
};

struct Plan {
  std::vector<Planned> scenes;
  int seeds = 2;
  int triangles = 300;
};

Plan plan() {
  if (!is_long()) return {{{"bend"}}, 2, 300};
  return {{{"bend"},
           {"bend-pinch", Place::above},
           {"rigidity", Place::above},
           {"four-handles-finger"},
           {"cylinder-crush", Place::below},
           {"dense-adaptive-hybrid", Place::above},
           {"twist"},
           {"a4-pinch"},
           {"star"},
           {"on-ball", Place::below},
           {"fast-hands"}},
          10,
          4096};
}

Place place_among(const std::vector<int>& dense, int median) {
  const auto [least, most] = std::minmax_element(dense.begin(), dense.end());
  return median < *least ? Place::below : median > *most ? Place::above : Place::within;
}

std::shared_ptr<const PaperScene> load(const std::string& id) {
  const fs::path file = geoprior_home() / "experiments" / "paper" / (id + ".toml");
  const Experiment experiment = load_experiment(file, {make_topic()}, {});
  const CaseSpec& first = experiment.cases[0];
  return std::dynamic_pointer_cast<const PaperScene>(
      make_topic().load(*first.scene, file.parent_path(), first.seed));
}

/// D-cones that the metric finds in the last frame of a run.
int cones_at_the_end(const PaperScene& scene, Process& process, std::uint64_t seed) {
  Recording recording;
  RunContext context(seed);
  process.run(recording, context, {});
  ConeMemo memo;
  return crease_measures(memo, sheet_frame(scene, recording.frames.back())).cones;
}

int dense_cones(const PaperScene& scene, int triangles, std::uint64_t seed) {
  DenseOptions options;
  options.triangles = triangles;
  return cones_at_the_end(scene, *make_dense_sheet(scene.sheet, options), seed);
}

int hybrid_cones(const PaperScene& scene, std::uint64_t seed) {
  return cones_at_the_end(scene, *make_hybrid_sheet(scene.sheet, {}), seed);
}

std::string text(const std::vector<int>& counts) {
  std::string all;
  for (const int count : counts) all += (all.empty() ? "" : " ") + std::to_string(count);
  return all;
}

TEST(LongDenseSpread, HybridHasAsManyDConesAsSomeDenseRun) {
  const Plan wanted = plan();
  for (const auto& [id, place] : wanted.scenes) {
    const auto scene = load(id);
    std::vector<int> dense, hybrid;
    for (int seed = 1; seed <= wanted.seeds; ++seed) {
      dense.push_back(dense_cones(*scene, wanted.triangles, static_cast<std::uint64_t>(seed)));
      hybrid.push_back(hybrid_cones(*scene, static_cast<std::uint64_t>(seed)));
    }
    std::printf("%-24s dense %s | hybrid %s\n", id.c_str(), text(dense).c_str(),
                text(hybrid).c_str());
    std::fflush(stdout);
    std::sort(hybrid.begin(), hybrid.end());
    EXPECT_EQ(place_among(dense, hybrid[hybrid.size() / 2]), place) << id;
  }
}

// 4,096 triangles are not enough to say how many there are: at least one scene has others with
// 8,192. What is beyond the dense runs' spread above may be beyond their resolution.
TEST(LongDenseSpread, DenseCountsHaveNotConverged) {
  if (!is_long()) GTEST_SKIP() << "8,192 triangles: with GEOPRIOR_LONG";
  int most = 0;
  for (const char* id : {"bend-pinch", "cylinder-crush", "a4-pinch"}) {
    const auto scene = load(id);
    const int coarse = dense_cones(*scene, 4096, 1), fine = dense_cones(*scene, 8192, 1);
    std::printf("%-24s 4,096 triangles %d, 8,192 %d\n", id, coarse, fine);
    most = std::max(most, std::abs(fine - coarse));
  }
  EXPECT_GT(most, 1);
}

}  // namespace
}  // namespace geoprior::paper
