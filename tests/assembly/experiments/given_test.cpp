// What a program from outside is given of models: enough to join their parts again.
#include "experiments/assembly/scene/given.h"

#include <gtest/gtest.h>

#include "models/assembly/search/variation.h"
#include "tests/assembly/assemblies.h"

namespace geoprior::assembly {
namespace {

using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

/// The motion in the last twelve columns of a row.
Pose pose_of(const FrameTable& table, Eigen::Index row) {
  const Eigen::RowVectorXd last = table.rows.row(row).tail<12>();
  Pose pose;
  pose.matrix().topRows<3>() = Eigen::Map<const RowMajor34>(last.data());
  return pose;
}

/// The rows of one model as tables of a frame.
Frame frame_of_model(const Frame& given, int model) {
  Frame frame;
  for (const char* name : {"parts", "connections"}) {
    const FrameTable& all = given.require_table(name);
    FrameTable& own = frame.tables[name];
    own.columns.assign(all.columns.begin() + 1, all.columns.end());
    for (Eigen::Index r = 0; r < all.rows.rows(); ++r) {
      if (all.rows(r, 0) != model) continue;
      own.rows.conservativeResize(own.rows.rows() + 1, all.rows.cols() - 1);
      own.rows.bottomRows<1>() = all.rows.row(r).tail(all.rows.cols() - 1);
    }
  }
  return frame;
}

TEST(GivenAssembly, GivenPortsAreWhereThoseJoinedMeet) {
  const AssemblyInput& input = marble_run();
  const Frame given = given_frame(input);
  const Assembly model = variation_of(frame_of_model(given, 0)).assembly;
  ASSERT_EQ(model.parts.size(), input.set.models[0].parts.size());
  ASSERT_EQ(model.connections.size(), input.set.models[0].connections.size());
  const FrameTable& ports = given.require_table("ports");
  const auto placed = [&](PortRef ref) {
    for (Eigen::Index r = 0; r < ports.rows.rows(); ++r)
      if (ports.rows(r, 0) == model.parts[ref.part].type && ports.rows(r, 1) == ref.port)
        return model.parts[ref.part].pose * pose_of(ports, r);
    ADD_FAILURE() << "no port " << ref.port << " of part " << ref.part;
    return Pose::Identity();
  };
  for (const auto& [a, b] : model.connections) {
    const Misfit gap = misfit(placed(a), placed(b));
    EXPECT_LT(gap.translation, 1e-9);
    EXPECT_LT(gap.angle, 1e-7);
  }
}

TEST(GivenAssembly, EveryModelHasItsRowsInTheirOrder) {
  const AssemblyInput input = oval_input();
  const Frame given = given_frame(input);
  for (int m = 0; m < 2; ++m) {
    const Assembly read = variation_of(frame_of_model(given, m)).assembly;
    const Assembly& model = input.set.models[m];
    ASSERT_EQ(read.parts.size(), model.parts.size());
    for (std::size_t i = 0; i < model.parts.size(); ++i) {
      EXPECT_EQ(read.parts[i].type, model.parts[i].type);
      EXPECT_TRUE(read.parts[i].pose.matrix() == model.parts[i].pose.matrix());
    }
  }
}

TEST(GivenAssembly, PortsOfAClassAreThoseThatASymmetryExchanges) {
  const Frame given = given_frame(oval_input());
  const Eigen::MatrixXd& ports = given.require_table("ports").rows;
  ASSERT_EQ(ports.rows(), 6);
  // A curve that only turns to the left has two ends, a straight has one kind of end.
  EXPECT_NE(ports(0, 2), ports(1, 2));
  EXPECT_EQ(ports(2, 2), ports(3, 2));
  EXPECT_NE(ports(2, 2), ports(4, 2));
  // The half turn that exchanges the ends of a straight of 0.2 m.
  const FrameTable& symmetries = given.require_table("symmetries");
  ASSERT_EQ(symmetries.rows.rows(), 2);
  const Pose motion = pose_of(symmetries, 0);
  EXPECT_LT((motion * Eigen::Vector3d::Zero() - Eigen::Vector3d(0.2, 0, 0)).norm(), 1e-12);
}

TEST(GivenAssembly, BodiesAndWaysAreThoseOfTheKindsAndNamed) {
  const AssemblyInput& input = marble_run();
  const Frame given = given_frame(input);
  const Part& bodies = given.require_part("bodies", Part::Kind::triangles);
  const NamedArray& label = bodies.require_array("label", NamedArray::On::cells, 1);
  Eigen::Index triangle = 0, vertex = 0, ways = 0, boxes = 0;
  for (std::size_t t = 0; t < input.set.types.size(); ++t) {
    const PartType& type = input.set.types[t];
    EXPECT_EQ(label.names.at(t), type.label);
    const Eigen::Index n = type.mesh.F.rows();
    EXPECT_TRUE((label.values.middleRows(triangle, n).array() == static_cast<double>(t)).all());
    EXPECT_TRUE(bodies.points.middleRows(vertex, type.mesh.V.rows()) == type.mesh.V);
    triangle += n;
    vertex += type.mesh.V.rows();
    ways += std::ssize(type.ways);
    boxes += std::ssize(type.boxes);
  }
  EXPECT_EQ(bodies.triangles.rows(), triangle);
  EXPECT_EQ(std::ssize(given.require_part("ways", Part::Kind::lines).lines), ways);
  EXPECT_EQ(given.require_table("boxes").rows.rows(), boxes);
}

}  // namespace
}  // namespace geoprior::assembly
