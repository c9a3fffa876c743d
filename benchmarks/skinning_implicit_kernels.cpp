// What implicit skinning spends its time on: one sample of a bone's cached field, the operators,
// and a whole pose of a finger of about 18 k vertices (dual quaternion start included).
//
//   geoprior_kernels --benchmark_filter=implicit

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

#include "core/geometry/procedural.h"
#include "core/parallel.h"
#include "core/random.h"
#include "solvers/skinning/field/field_cache.h"
#include "solvers/skinning/field/operators.h"
#include "solvers/skinning/implicit.h"

namespace geoprior::skinning {
namespace {

/// A unit sphere as the skin of one bone.
struct SphereField {
  SphereField() {
    RandomStream random(1, "benchmark sphere");
    Eigen::MatrixX3d points(52, 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      points.row(i) =
          Eigen::RowVector3d(random.normal(), random.normal(), random.normal()).normalized();
      bone.vertices.push_back(static_cast<int>(i));
    }
    bone.head = -Eigen::Vector3d::UnitZ();
    bone.tail = Eigen::Vector3d::UnitZ();
    bone.radius = 1;
    hrbf = Hrbf(points, points, 1);
    box = field_box(bone, points);
  }
  FieldBone bone;
  Hrbf hrbf;
  FieldBox box;
};

void implicit_cache_sample(benchmark::State& state) {
  const SphereField sphere;
  const FieldCache cache(sphere.hrbf, sphere.box, static_cast<int>(state.range(0)));
  RandomStream random(2, "benchmark points");
  std::vector<Float4> points;
  for (int i = 0; i < 4096; ++i) {
    const Eigen::Vector3d u = Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform())
                                  .cwiseProduct(cache.extent());
    points.push_back(Float4{static_cast<float>(u.x()), static_cast<float>(u.y()),
                            static_cast<float>(u.z()), 0.0F});
  }
  for (auto _ : state) {
    Float4 sum{};
    for (const Float4 u : points) sum += cache.sample(u);
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(implicit_cache_sample)->Arg(32)->Arg(64);

void implicit_exact_field(benchmark::State& state) {
  const SphereField sphere;
  const Eigen::Vector3d p(0.3, 0.9, -0.2);
  for (auto _ : state) benchmark::DoNotOptimize(sphere.hrbf(p));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(implicit_exact_field);

void implicit_gradient_controlled(benchmark::State& state) {
  double f = 0.3;
  for (auto _ : state) {
    f = f < 0.6 ? f + 1e-4 : 0.3;
    benchmark::DoNotOptimize(gradient_controlled(f, 0.45, 0.3));
  }
}
BENCHMARK(implicit_gradient_controlled);

void implicit_bulge_in_contact(benchmark::State& state) {
  double f = 0.3;
  for (auto _ : state) {
    f = f < 0.5 ? f + 1e-4 : 0.3;
    benchmark::DoNotOptimize(bulge_in_contact(f, 0.45, 0.3));
  }
}
BENCHMARK(implicit_bulge_in_contact);

/// A pose with the middle joint at `range(0)` degrees on `range(1)` threads.
void implicit_pose(benchmark::State& state) {
  FingerOptions finger;
  finger.segments = 90;
  const RiggedMesh rig = capsule_finger(finger);
  RunContext context;
  ImplicitSkinning skin(rig, {}, context);
  const int joint = rig.skeleton.index_of("middle");
  const Eigen::AngleAxisd turn(static_cast<double>(state.range(0)) * std::numbers::pi / 180,
                               Eigen::Vector3d::UnitY());
  const Pose pose = pose_from_rotations(rig.skeleton, {{joint, Eigen::Quaterniond(turn)}});
  Eigen::MatrixX3d posed;
  with_threads(static_cast<int>(state.range(1)), [&] {
    for (auto _ : state) skin.deform(pose, posed, context);
  });
  state.counters["vertices"] = rig.mesh.vertex_count();
  for (const auto& [name, value] : skin.diagnostics()) state.counters[name] = value;
}
BENCHMARK(implicit_pose)
    ->ArgsProduct({{0, 60, 120}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace geoprior::skinning
