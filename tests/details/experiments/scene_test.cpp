#include "models/details/scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <string>

#include "core/error.h"
#include "tests/details/detail_scenes.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

DetailScene square_scene() {
  const TriMesh mesh = shapes::square(8);
  return scene(mesh, random_details(mesh, 20, 1), stretch(mesh, 2, 2));
}

/// Runs `act` and returns the message of its Error; empty when it throws none.
template <class Act>
std::string message(const Act& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::string message_of(const DetailScene& scene) {
  return message([&] { require_valid(scene); });
}

TEST(DetailScene, AValidSceneIsAccepted) { EXPECT_EQ(message_of(square_scene()), ""); }

TEST(DetailScene, FewerThanThreeDetailsAreNamed) {
  DetailScene s = square_scene();
  s.details.resize(2);
  EXPECT_EQ(message_of(s),
            "scene: 2 details (allowed: at least 3: a mesh of details has triangles)");
}

TEST(DetailScene, DetailsOffTheSurfaceAreNamed) {
  DetailScene s = square_scene();
  s.details[4].at.barycentric = {1.2, -0.1, -0.1};
  EXPECT_NE(message_of(s).find("detail 4: is off the surface"), std::string::npos);
  s = square_scene();
  s.details[5].at.face = 128;
  EXPECT_NE(message_of(s).find("detail 5: is off the surface: face 128 (allowed: 0 … 127)"),
            std::string::npos);
}

TEST(DetailScene, TwoDetailsInOnePlaceAreNamed) {
  DetailScene s = square_scene();
  s.details[17].at = s.details[3].at;
  EXPECT_NE(message_of(s).find("detail 17: is in the place of detail 3"), std::string::npos);
}

TEST(DetailScene, SurfacesThatAreNoManifoldAreNamed) {
  DetailScene s = square_scene();
  s.surface.F.conservativeResize(s.surface.F.rows() + 1, 3);
  s.surface.F.row(s.surface.F.rows() - 1) << 0, 1, 40;
  EXPECT_NE(message_of(s).find("has more than two triangles, or two that turn opposite ways"),
            std::string::npos);
  // Two tetrahedra that share a vertex: every edge is fine, the vertex is not.
  s = square_scene();
  const TriMesh one = shapes::tetrahedron();
  s.surface.V.resize(7, 3);
  s.surface.V << one.V, -one.V.bottomRows(3);
  s.surface.F.resize(8, 3);
  Eigen::MatrixX3i mirrored = one.F.rowwise().reverse();
  for (Eigen::Index i = 0; i < 12; ++i) mirrored.data()[i] += mirrored.data()[i] > 0 ? 3 : 0;
  s.surface.F << one.F, mirrored;
  EXPECT_NE(message_of(s).find("two sheets meet in vertex 0"), std::string::npos);
}

TEST(DetailScene, TwoPiecesAreRefused) {
  DetailScene s = square_scene();
  const TriMesh one = shapes::tetrahedron();
  s.surface.V.resize(8, 3);
  s.surface.V << one.V, one.V.array() + 2.0;
  s.surface.F.resize(8, 3);
  s.surface.F << one.F, one.F.array() + 4;
  EXPECT_NE(message_of(s).find("is in another piece"), std::string::npos);
}

TEST(DetailScene, NotANumberIsNamed) {
  DetailScene s = square_scene();
  s.surface.V(7, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of(s).find("vertex 7 is not finite"), std::string::npos);
}

TEST(DetailScene, AMotionStartsAtRest) {
  DetailScene s = square_scene();
  s.motion = stretch(shapes::square(4), 2, 2);
  EXPECT_NE(message_of(s).find("frame 0 of the motion is not the surface"), std::string::npos);
}

TEST(DetailScene, ASequenceWhoseTopologyChangesIsNamed) {
  std::vector<SurfaceFrame> frames(3);
  for (int i = 0; i < 3; ++i) {
    frames[i].time = i;
    frames[i].mesh = shapes::square(4);
  }
  EXPECT_EQ(motion_of_sequence(StoredSequence(frames, "clip"))->frame_count(), 3);
  frames[2].mesh.F.row(3).swap(frames[2].mesh.F.row(4));
  EXPECT_EQ(message([&] { motion_of_sequence(StoredSequence(frames, "clip")); }),
            "clip, frame 2: its triangles are not those of the first frame (allowed: a sequence of "
            "fixed topology)");
}

TEST(DetailScene, ADeformationThatInvertsATriangleIsNamed) {
  const TriMesh mesh = shapes::square(4);
  Eigen::MatrixX3d folded = mesh.V;
  folded.row(12) << 0.95, 0.5, 0;  // the centre, pushed over its neighbours to the right
  EXPECT_NE(message([&] {
              require_valid_step(mesh.F, mesh.V, folded, 3, "clip");
            }).find("clip, frame 3: triangle"),
            std::string::npos);
  // A turn of the whole square by 120 degrees in one frame inverts nothing.
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::MatrixX3d turned = mesh.V * turn.transpose();
  EXPECT_EQ(message([&] { require_valid_step(mesh.F, mesh.V, turned, 3, "clip"); }), "");
}

}  // namespace
}  // namespace geoprior::details
