// Good glTF files, changed in all that the format leaves free, against what they mean.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/error.h"
#include "testbed/formats/gltf/reader.h"
#include "tests/skinning/experiments/perturbed_gltf.h"
#include "tests/support/perturbed.h"

namespace geoprior::skinning {
namespace {

/// Vertices of the meaning that those of a mesh are, by position.
std::vector<int> matched(const Eigen::MatrixX3d& V, const GltfMeaning& meaning) {
  std::vector<int> match;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    int nearest = -1;
    double distance = 1e-4;
    for (std::size_t i = 0; i < meaning.V.size(); ++i) {
      const double d = (meaning.V[i].transpose() - V.row(v)).norm();
      if (d < distance) {
        distance = d;
        nearest = static_cast<int>(i);
      }
    }
    match.push_back(nearest);
  }
  return match;
}

void expect_mesh(const GltfCharacter& c, const GltfMeaning& meaning) {
  ASSERT_EQ(c.mesh.V.rows(), static_cast<Eigen::Index>(meaning.V.size()));
  const std::vector<int> match = matched(c.mesh.V, meaning);
  ASSERT_EQ(std::set<int>(match.begin(), match.end()).size(), meaning.V.size());
  ASSERT_THAT(match, testing::Not(testing::Contains(-1)));
  std::set<std::array<int, 3>> triangles;
  for (Eigen::Index f = 0; f < c.mesh.F.rows(); ++f) {
    std::array<int, 3> t{match[c.mesh.F(f, 0)], match[c.mesh.F(f, 1)], match[c.mesh.F(f, 2)]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.insert(t);
  }
  EXPECT_EQ(triangles, meaning.triangles);
  for (Eigen::Index v = 0; v < c.mesh.V.rows(); ++v) {
    for (int j = 0; j < c.skeleton->size(); ++j) {
      const auto& expected = meaning.weights[match[v]];
      const auto it = expected.find(c.skeleton->joints[j].name);
      EXPECT_NEAR(c.weights.coeff(v, j), it == expected.end() ? 0 : it->second, 1e-6);
    }
  }
}

void expect_skeleton(const GltfCharacter& c, const GltfMeaning& meaning) {
  ASSERT_EQ(c.skeleton->joints.size(), meaning.parents.size());
  ASSERT_EQ(c.clips.size(), 1U);
  const Pose end = clip_pose(c, c.clips[0], 1);
  for (std::size_t j = 0; j < end.size(); ++j) {
    const Joint& joint = c.skeleton->joints[j];
    ASSERT_TRUE(meaning.parents.contains(joint.name)) << joint.name;
    EXPECT_EQ(joint.parent < 0 ? std::string() : c.skeleton->joints[joint.parent].name,
              meaning.parents.at(joint.name));
    EXPECT_NEAR((joint.head - meaning.heads.at(joint.name)).norm(), 0, 1e-4) << joint.name;
    EXPECT_NEAR((end[j].matrix() - meaning.end_pose.at(joint.name).matrix()).norm(), 0, 1e-4)
        << joint.name;
  }
}

TEST(LongPerturbedGltf, MeansWhatItsGeneratorWrote) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PerturbedGltf file(seed);
    GltfCharacter c;
    try {
      c = read_gltf_bytes(file.bytes(), "perturbed");
    } catch (const Error& e) {
      ADD_FAILURE() << e.what();
      continue;
    }
    ASSERT_TRUE(c.skeleton);
    expect_mesh(c, file.meaning());
    expect_skeleton(c, file.meaning());
    for (const std::string& name : file.meaning().left_out) {
      EXPECT_THAT(c.warnings,
                  testing::Contains(testing::AllOf(testing::HasSubstr("left out"),
                                                   testing::HasSubstr("mesh '" + name + "'"))));
    }
    if (HasFailure()) break;
  }
}

}  // namespace
}  // namespace geoprior::skinning
