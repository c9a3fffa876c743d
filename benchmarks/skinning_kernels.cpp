// How fast the baselines stream a skin, beside the fastest copy of as many bytes on this machine.
//
//   geoprior_kernels --benchmark_filter='/18000'         what an interactive frame costs
//   geoprior_kernels --benchmark_filter='copy|/1000000'  share of the copy bandwidth
//
// "bytes_per_second" counts what a kernel must move: rest positions and influences read, posed
// positions written (PackedInfluences::bytes_per_vertex). "of_copy_bandwidth" divides it by the
// rate of a copy of as many bytes (half read, half written past the caches, same blocks and
// threads), measured in this run just before.

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "baselines/skinning/centers_of_rotation/centers_of_rotation.h"
#include "baselines/skinning/delta_mush.h"
#include "baselines/skinning/direct_delta_mush/direct_delta_mush.h"
#include "baselines/skinning/dual_quaternion/dual_quaternion.h"
#include "baselines/skinning/linear_blend/linear_blend.h"
#include "baselines/skinning/shared/lanes.h"
#include "core/parallel.h"
#include "core/random.h"

namespace geoprior::skinning {
namespace {

constexpr int kJoints = 60;
constexpr int kThreads = 2;

/// A tube of about `vertices` vertices along a chain of joints; every vertex has four influences.
RiggedMesh tube(int vertices) {
  const int segments = std::max(3, static_cast<int>(std::lround(std::sqrt(vertices / 6.0))));
  const int rings = vertices / segments;
  RiggedMesh rig;
  rig.mesh.V.resize(static_cast<Eigen::Index>(segments) * rings, 3);
  rig.mesh.F.resize(2 * static_cast<Eigen::Index>(segments) * (rings - 1), 3);
  std::vector<Eigen::Triplet<double>> weights;
  RandomStream random(1, "benchmark weights");
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < segments; ++k) {
      const int v = i * segments + k;
      const double angle = 2 * std::numbers::pi * k / segments;
      rig.mesh.V.row(v) << 2.0 * i / rings, 0.1 * std::cos(angle), 0.1 * std::sin(angle);
      const int first = std::min(kJoints - 4, i * kJoints / rings);
      Eigen::Vector4d w;
      for (int j = 0; j < 4; ++j) w(j) = 0.1 + random.uniform();
      w /= w.sum();
      for (int j = 0; j < 4; ++j) weights.emplace_back(v, first + j, w(j));
    }
  }
  Eigen::Index t = 0;
  for (int i = 0; i + 1 < rings; ++i) {
    for (int k = 0; k < segments; ++k) {
      const int a = i * segments + k, b = i * segments + (k + 1) % segments;
      rig.mesh.F.row(t++) << a, b, b + segments;
      rig.mesh.F.row(t++) << a, b + segments, a + segments;
    }
  }
  rig.weights.resize(rig.mesh.V.rows(), kJoints);
  rig.weights.setFromTriplets(weights.begin(), weights.end());
  for (int j = 0; j < kJoints; ++j) {
    Joint joint;
    joint.name = "joint " + std::to_string(j);
    joint.parent = j - 1;
    joint.head = {2.0 * j / kJoints, 0, 0};
    joint.tail = Eigen::Vector3d(2.0 * (j + 1) / kJoints, 0, 0);
    rig.skeleton.joints.push_back(joint);
  }
  return rig;
}

const RiggedMesh& shared_tube(int vertices) {
  static std::map<int, RiggedMesh> tubes;
  const auto it = tubes.find(vertices);
  return it != tubes.end() ? it->second : tubes.emplace(vertices, tube(vertices)).first->second;
}

Pose curled(const Skeleton& skeleton) {
  std::vector<JointRotation> rotations;
  for (int j = 0; j < skeleton.size(); ++j) {
    rotations.push_back({j, Eigen::Quaterniond(Eigen::AngleAxisd(
                                0.07, Eigen::Vector3d(0.3, 1, 0.2).normalized()))});
  }
  return pose_from_rotations(skeleton, rotations);
}

/// Source and destination of a copy that moves `bytes` in all.
class Copy {
 public:
  explicit Copy(double bytes)
      : from_(static_cast<std::size_t>(bytes / 16), 1.0), to_(from_.size(), 0.0) {}
  void run() {
    constexpr std::size_t kBlock = 2048;
    parallel_blocks(from_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      if (from_.size() * sizeof(double) > (8U << 20U)) {
        lanes::stream(from_.data() + begin, to_.data() + begin, end - begin);
        lanes::stream_fence();
      } else {
        std::copy(from_.begin() + begin, from_.begin() + end, to_.begin() + begin);
      }
      benchmark::ClobberMemory();
    });
  }

 private:
  std::vector<double> from_;
  std::vector<double> to_;
};

/// Median rate of the copy (bytes a second).
double copy_bandwidth(double bytes) {
  using Clock = std::chrono::steady_clock;
  Copy copy(bytes);
  std::vector<double> seconds;
  for (int i = 0; i < 31; ++i) {
    const auto start = Clock::now();
    copy.run();
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + 15, seconds.end());
  return bytes / seconds[15];
}

void report(benchmark::State& state, double bytes, double seconds) {
  const double rate = bytes * static_cast<double>(state.iterations()) / seconds;
  state.counters["bytes_per_second"] = rate;
  state.counters["of_copy_bandwidth"] = rate / copy_bandwidth(bytes);
}

/// Runs `deform` under the clock; reports the rate at `bytes` a call when that is known.
template <class Deform>
void measure(benchmark::State& state, double bytes, const Deform& deform) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, kThreads);
  deform();
  const auto start = std::chrono::steady_clock::now();
  for (auto _ : state) {
    deform();
    benchmark::ClobberMemory();
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  if (bytes > 0) report(state, bytes, elapsed.count());
}

double bytes_of(const PackedInfluences& influences) {
  return influences.bytes_per_vertex * influences.vertex_count;
}

void skin_linear_blend(benchmark::State& state) {
  const RiggedMesh& rig = shared_tube(static_cast<int>(state.range(0)));
  const LinearBlend method(rig);
  const Pose pose = curled(rig.skeleton);
  Eigen::MatrixX3d posed;
  measure(state, bytes_of(method.influences()), [&] { method.deform(pose, posed); });
  state.counters["bytes_per_vertex"] = method.influences().bytes_per_vertex;
}

void skin_dual_quaternion(benchmark::State& state) {
  const RiggedMesh& rig = shared_tube(static_cast<int>(state.range(0)));
  const DualQuaternionBlend method(rig);
  const Pose pose = curled(rig.skeleton);
  Eigen::MatrixX3d posed;
  measure(state, bytes_of(method.influences()), [&] { method.deform(pose, posed); });
  state.counters["bytes_per_vertex"] = method.influences().bytes_per_vertex;
}

void skin_delta_mush(benchmark::State& state) {
  const RiggedMesh& rig = shared_tube(static_cast<int>(state.range(0)));
  DeltaMush method(rig, {});
  const Pose pose = curled(rig.skeleton);
  Eigen::MatrixX3d posed;
  measure(state, 0, [&] { method.deform(pose, posed); });
}

void skin_centers_of_rotation(benchmark::State& state) {
  const RiggedMesh& rig = shared_tube(static_cast<int>(state.range(0)));
  const CentersOfRotation method(rig);
  const Pose pose = curled(rig.skeleton);
  Eigen::MatrixX3d posed;
  // The arms are read beside what linear blending moves.
  const double bytes =
      bytes_of(method.influences()) + 3.0 * sizeof(double) * rig.mesh.vertex_count();
  measure(state, bytes, [&] { method.deform(pose, posed); });
}

void skin_direct_delta_mush(benchmark::State& state) {
  const RiggedMesh& rig = shared_tube(static_cast<int>(state.range(0)));
  static const DirectDeltaMush method(rig);  // prepared once: its one size takes seconds
  const Pose pose = curled(rig.skeleton);
  Eigen::MatrixX3d posed;
  measure(state, 0, [&] { method.deform(pose, posed); });
  state.counters["influences_per_vertex"] = method.influences_per_vertex();
}

/// What a rig costs once.
template <class Method>
void prepare(benchmark::State& state) {
  const RiggedMesh& rig = shared_tube(static_cast<int>(state.range(0)));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, kThreads);
  for (auto _ : state) benchmark::DoNotOptimize(Method(rig));
}

void copy_same_bytes(benchmark::State& state) {
  const double bytes = bytes_of(PackedInfluences(shared_tube(static_cast<int>(state.range(0)))));
  Copy copy(bytes);
  measure(state, bytes, [&] { copy.run(); });
}

BENCHMARK(copy_same_bytes)->Arg(18000)->Arg(1000000)->Arg(4000000)->UseRealTime();
BENCHMARK(skin_linear_blend)->Arg(18000)->Arg(1000000)->Arg(4000000)->UseRealTime();
BENCHMARK(skin_dual_quaternion)->Arg(18000)->Arg(1000000)->Arg(4000000)->UseRealTime();
BENCHMARK(skin_centers_of_rotation)->Arg(18000)->UseRealTime();
BENCHMARK(skin_direct_delta_mush)->Arg(18000)->UseRealTime();
BENCHMARK(prepare<CentersOfRotation>)
    ->Arg(18000)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(prepare<DirectDeltaMush>)
    ->Arg(18000)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(skin_delta_mush)->Arg(18000)->Arg(1000000)->UseRealTime();

}  // namespace
}  // namespace geoprior::skinning
