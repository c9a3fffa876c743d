#include "solvers/skinning/field/hrbf.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "solvers/skinning/field/field_cache.h"

namespace geoprior::skinning {
namespace {

struct Sphere {
  Eigen::MatrixX3d points;
  Eigen::MatrixX3d normals;
};

Sphere sphere(int n, double radius) {
  RandomStream random(3, "sphere");
  Sphere s{Eigen::MatrixX3d(n, 3), Eigen::MatrixX3d(n, 3)};
  for (int i = 0; i < n; ++i) {
    const Eigen::RowVector3d d(random.normal(), random.normal(), random.normal());
    s.normals.row(i) = d.normalized();
    s.points.row(i) = radius * d.normalized() + Eigen::RowVector3d(0.3, 1.2, -0.4);
  }
  return s;
}

// The interpolation conditions of thesis eq. 3.1; tolerances: the project's acceptance figures.
TEST(Hrbf, InterpolatesSamplesAndNormals) {
  const double r = 0.08;
  const Sphere s = sphere(50, r);
  const Hrbf field(s.points, s.normals, r);
  for (Eigen::Index i = 0; i < 50; ++i) {
    const Hrbf::Value v = field(s.points.row(i));
    EXPECT_LE(std::abs(v.value), 1e-8);
    EXPECT_LE((v.gradient.transpose() - s.normals.row(i)).norm(), 1e-6);
  }
}

TEST(Hrbf, GradientIsTheDerivativeOfTheValue) {
  const double r = 0.08, h = 1e-6;
  const Sphere s = sphere(30, r);
  const Hrbf field(s.points, s.normals, r);
  RandomStream random(5, "points");
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p = Eigen::Vector3d(0.3, 1.2, -0.4) +
                              0.12 * Eigen::Vector3d(random.normal(), random.normal(), 0.3);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d e = h * Eigen::Vector3d::Unit(k);
      // value is d / r: central differences err by h^2 and by round-off / h, both below 1e-7.
      const double slope = r * (field(p + e).value - field(p - e).value) / (2 * h);
      EXPECT_NEAR(field(p).gradient(k), slope, 1e-6);
    }
  }
}

// The sign is that of a distance; the values are not: phi = x^3 grows faster than it. (One radius
// outside a sphere the field is above 1 r, in its centre above -1 r.)
TEST(Hrbf, HasTheSignOfADistanceButNotItsValue) {
  const double r = 0.08;
  const Sphere s = sphere(60, r);
  const Hrbf field(s.points, s.normals, r);
  const Eigen::Vector3d centre(0.3, 1.2, -0.4);
  for (double t = 0.1; t < 2; t += 0.1) {
    const double value = field(centre + Eigen::Vector3d(t * r, 0, 0)).value;
    if (std::abs(t - 1) < 0.05) continue;  // on the surface
    EXPECT_EQ(value > 0, t > 1) << t;
  }
  EXPECT_GT(field(centre).value, -1);
  EXPECT_GT(field(centre + Eigen::Vector3d(2 * r, 0, 0)).value, 1);
}

TEST(Hrbf, DoesNotDependOnTheUnitOfLength) {
  const Sphere s = sphere(30, 0.08);
  const Hrbf metres(s.points, s.normals, 0.08);
  const Hrbf millimetres(1000 * s.points, s.normals, 80);
  const Eigen::Vector3d p(0.33, 1.21, -0.35);
  EXPECT_NEAR(metres(p).value, millimetres(1000 * p).value, 1e-9);
}

TEST(Hrbf, VectorisedEvaluationAgreesWithThePoint) {
  const Sphere s = sphere(30, 0.08);
  const Hrbf field(s.points, s.normals, 0.08);
  const Sphere at = sphere(11, 0.1);
  Eigen::MatrixX4d values;
  field.evaluate(at.points, values);
  for (Eigen::Index i = 0; i < 11; ++i) {
    const Hrbf::Value v = field(at.points.row(i));
    EXPECT_NEAR(values(i, 3), v.value, 1e-9);
    EXPECT_LE((values.row(i).head<3>() - v.gradient.transpose()).norm(), 1e-9);
  }
}

TEST(Hrbf, RefusesCoincidingSamples) {
  Sphere s = sphere(10, 0.1);
  s.points.row(7) = s.points.row(2);
  EXPECT_THROW(Hrbf(s.points, s.normals, 0.1), Error);
  EXPECT_THROW(Hrbf(s.points, s.normals.topRows(9), 0.1), Error);
}

FieldBone stub_bone(const Sphere& s) {
  FieldBone bone;
  bone.head = Eigen::Vector3d(0.3, 1.12, -0.4);
  bone.tail = Eigen::Vector3d(0.3, 1.28, -0.4);
  bone.radius = 0.08;
  for (int i = 0; i < s.points.rows(); ++i) bone.vertices.push_back(i);
  return bone;
}

/// Largest difference of a cache from the exact value over points within the box.
double cache_error(int grid) {
  const Sphere s = sphere(50, 0.08);
  const Hrbf field(s.points, s.normals, 0.08);
  const FieldBox box = field_box(stub_bone(s), s.points);
  const FieldCache cache(field, box, grid);
  RandomStream random(9, "cache");
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d u = Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform())
                                  .cwiseProduct(cache.extent());
    const Eigen::Vector3d p = box.axes * (box.low + cache.cell_size() * u);
    const Float4 v = cache.sample(Float4{static_cast<float>(u.x()), static_cast<float>(u.y()),
                                         static_cast<float>(u.z()), 0.0F});
    worst = std::max(worst, std::abs(static_cast<double>(v[3]) - field(p).value));
  }
  return worst;
}

TEST(FieldCache, SamplesTheTrilinearSumOfTheFieldAtItsNodes) {
  const Sphere s = sphere(50, 0.08);
  const Hrbf field(s.points, s.normals, 0.08);
  const FieldBox box = field_box(stub_bone(s), s.points);
  const FieldCache cache(field, box, 12);
  RandomStream random(4, "samples");
  for (int sample = 0; sample < 200; ++sample) {
    const Eigen::Vector3d u = Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform())
                                  .cwiseProduct(cache.extent());
    Eigen::Vector4d expected = Eigen::Vector4d::Zero();
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d node =
          u.array().floor() + Eigen::Array3d(corner % 2, corner / 2 % 2, corner / 4);
      const double weight = (1 - (u - node).array().abs()).prod();
      const Hrbf::Value v = field(box.axes * (box.low + cache.cell_size() * node));
      expected += weight * Eigen::Vector4d(v.gradient.x(), v.gradient.y(), v.gradient.z(), v.value);
    }
    const Float4 got = cache.sample(Float4{static_cast<float>(u.x()), static_cast<float>(u.y()),
                                           static_cast<float>(u.z()), 0.0F});
    // Grid coordinates and values are in single precision.
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(got[k], expected[k], 1e-5);
  }
}

// Trilinear interpolation of a C2 function is of second order: doubling the grid quarters the
// error; 3 leaves room for the third derivative's jumps at the samples.
TEST(FieldCache, ConvergesWithSecondOrder) {
  const double coarse = cache_error(24);
  const double fine = cache_error(47);
  EXPECT_LT(coarse, 0.06);
  EXPECT_LT(fine, coarse / 3);
}

TEST(FieldCache, HasAboutTheAskedNumberOfNodesWhateverTheBox) {
  Sphere s = sphere(50, 0.08);
  s.points.col(1) *= 3;
  FieldBone bone = stub_bone(s);
  bone.head.y() *= 3;
  bone.tail.y() *= 3;
  const Hrbf field(s.points, s.normals, 0.08);
  const FieldCache cache(field, field_box(bone, s.points), 32);
  EXPECT_NEAR(static_cast<double>(cache.bytes()) / 16, 32 * 32 * 32, 0.2 * 32 * 32 * 32);
}

}  // namespace
}  // namespace geoprior::skinning
