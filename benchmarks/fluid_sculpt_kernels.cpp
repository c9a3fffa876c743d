// What cutting features out of a liquid animation and pasting them costs: regions of a frame of
// 10 000 vertices, a cover of 10 000 regions by paths, a map pasted into one frame of a target of
// 65 000 vertices and into a hundred.
//
//   geoprior_kernels --benchmark_filter=sculpting

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/random.h"
#include "solvers/fluid/extraction.h"
#include "solvers/fluid/paste/paste.h"
#include "solvers/fluid/sculpt.h"
#include "solvers/fluid/sculpt_scene.h"
#include "solvers/fluid/tracking/path_cover.h"

namespace geoprior::fluid {
namespace {

/// A hill that travels over a pool of 2 m x 2 m in n x n squares.
TriMesh pool(int n, double time, double height) {
  const double h = 2.0 / n, sigma = 0.08;
  TriMesh mesh;
  mesh.V.resize((n + 1) * (n + 1), 3);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = i * h, y = j * h;
      const double r = std::hypot(x - 0.7 - 0.2 * time, y - 1) / sigma;
      mesh.V.row(j * (n + 1) + i) << x, y, height * std::exp(-0.5 * r * r);
    }
  }
  mesh.F.resize(2 * n * n, 3);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, t = 2 * (j * n + i);
      mesh.F.row(t) << a, a + 1, a + n + 2;
      mesh.F.row(t + 1) << a, a + n + 2, a + n + 1;
    }
  }
  return mesh;
}

StoredSequence hill(int n, int frames) {
  std::vector<SurfaceFrame> result(frames);
  for (int f = 0; f < frames; ++f) {
    SurfaceFrame& frame = result[f];
    frame.time = 0.04 * f;
    frame.mesh = pool(n, frame.time, f < frames / 2 ? 0 : 0.08);
  }
  return {std::move(result), "hill"};
}

/// 100 x 100 vertices; thresholds come from the calm frames before.
void sculpting_segment(benchmark::State& state) {
  const StoredSequence sequence = hill(99, 8);
  const Segmenter segmenter(sequence, SegmentationOptions{});
  const SurfaceFrame frame = sequence.frame(6);
  std::size_t regions = 0;
  for (auto _ : state) regions = segmenter.segment(frame, 6).regions.size();
  state.counters["vertices"] = static_cast<double>(frame.mesh.V.rows());
  state.counters["regions"] = static_cast<double>(regions);
}
BENCHMARK(sculpting_segment)->Unit(benchmark::kMillisecond)->UseRealTime();

/// A hundred frames of a hundred regions, each linked to those of the next three frames whose
/// number is at most `reach` away, with random costs. Reach 0: 30 000 links, as of features that
/// are seldom mistaken for one another; 1: one connected part of 90 000.
void sculpting_path_cover(benchmark::State& state) {
  constexpr int kFrames = 100, kRegions = 100;
  const int reach = static_cast<int>(state.range(0));
  RandomStream random(1, "links");
  std::vector<PathLink> links;
  for (int f = 0; f < kFrames; ++f) {
    for (int r = 0; r < kRegions; ++r) {
      for (int g = 1; g <= 3 && f + g < kFrames; ++g) {
        for (int s = std::max(0, r - reach); s <= std::min(kRegions - 1, r + reach); ++s) {
          links.push_back(
              {f * kRegions + r, (f + g) * kRegions + s, 12 * random.uniform() + g - 1});
        }
      }
    }
  }
  for (auto _ : state) benchmark::DoNotOptimize(cover_by_paths(kFrames * kRegions, links, 10));
  state.counters["links"] = static_cast<double>(links.size());
}
BENCHMARK(sculpting_path_cover)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

/// A hundred frames of a ring wave in a map of n x n texels, half as large as the target's cells:
/// what a map of the target's own animation has.
Feature ring(int n) {
  Feature feature;
  feature.id = 1;
  feature.resolution = n;
  feature.extent = n / 256.0;
  feature.cell = 2.0 / 256;
  for (int f = 0; f < 100; ++f) {
    feature.times.push_back(0.04 * f);
    feature.placement.push_back(Eigen::Isometry3d(Eigen::Translation3d(0.8 + 0.004 * f, 1, 0)));
    feature.area.push_back(0.25 * feature.extent * feature.extent);
    feature.volume.push_back(0);
    MapFrame map;
    map.displacement.resize(n * n, 3);
    map.alpha.resize(n * n);
    for (int t = 0; t < n * n; ++t) {
      const double x = (t % n + 0.5) / n - 0.5, y = (t / n + 0.5) / n - 0.5, r = std::hypot(x, y);
      const double crest = std::exp(-std::pow((r - 0.1 - 0.002 * f) / 0.04, 2));
      map.displacement.row(t) << 0, 0, static_cast<float>(0.05 * feature.extent * crest);
      map.alpha[t] = static_cast<float>(std::clamp(10 * (0.45 - r), 0.0, 1.0));
    }
    feature.maps.push_back(std::move(map));
  }
  return feature;
}

SurfaceFrame target() {
  SurfaceFrame frame;
  frame.mesh = pool(255, 0, 0.02);  // 65 536 vertices
  frame.velocity = Eigen::MatrixX3d::Zero(frame.mesh.V.rows(), 3);
  return frame;
}

/// One frame, by the texels along the map's edge.
void sculpting_paste(benchmark::State& state) {
  const Feature feature = ring(static_cast<int>(state.range(0)));
  const SurfaceFrame into = target();
  PasteReport report;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        paste(into, {{&feature, {}}}, 2, Eigen::Vector3d::UnitZ(), PasteOptions{}, &report));
  }
  state.counters["displaced"] = report.displaced_vertices;
  state.counters["added"] = report.added_triangles;
}
BENCHMARK(sculpting_paste)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond)->UseRealTime();

struct Nowhere final : FrameSink {
  void frame(Frame f) override { benchmark::DoNotOptimize(f); }
  void event(const Event&) override {}
  void artifact(Artifact) override {}
  void checkpoint(const State&) override {}
};

/// All hundred frames of the feature.
void sculpting_edit(benchmark::State& state) {
  SculptScene scene;
  scene.libraries["ring"].push_back(ring(static_cast<int>(state.range(0))));
  scene.target = std::make_shared<StoredSequence>(std::vector{target()}, "pool");
  scene.times = scene.libraries["ring"].front().times;
  scene.edits.resize(1);
  const auto process = make_sculpt(scene, SculptOptions{});
  for (auto _ : state) {
    Nowhere sink;
    RunContext context;
    process->run(sink, context, {});
  }
}
BENCHMARK(sculpting_edit)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace geoprior::fluid
