// The same program of a later commit, in which the topic has one metric more: what adding a metric
// (docs/architecture.md) makes of program.cpp.
#include <Eigen/Geometry>
#include <cstdlib>

#include "core/error.h"
#include "testbed/metric_rows.h"
#include "testbed/program.h"
#include "testbed/runner/process/build_info.h"
#include "testbed/topic.h"

namespace geoprior {

namespace sample {
Topic make_topic();
}

namespace {

double area(const Scene&, const Frame& frame) {
  const Part& square = frame.require_part("surface");
  double sum = 0;
  for (const auto& triangle : square.triangles.rowwise()) {
    const Eigen::RowVector3d a = square.points.row(triangle[0]);
    const Eigen::RowVector3d b = square.points.row(triangle[1]) - a;
    const Eigen::RowVector3d c = square.points.row(triangle[2]) - a;
    sum += b.cross(c).norm() / 2;
  }
  return sum;
}

Topic topic_with_area() {
  Topic topic = sample::make_topic();
  topic.metrics.push_back(frame_metrics<Scene>(area).row("area", "m^2", "area of the square",
                                                         Direction::none, {1e-12, 1e-9}));
  // Nothing that needs no run makes a method: a test says so, and one that is made is an error.
  if (std::getenv("GEOPRIOR_NO_METHODS") == nullptr) return topic;
  for (MethodEntry& method : topic.methods) {
    method.make = [](const Scene&, const OptionSet&, RunContext&) -> MethodEntry::Instance {
      throw Error("a method was made");
    };
  }
  return topic;
}

}  // namespace

// In the place of that of the library.
const BuildInfo& build_info() {
  static const BuildInfo info{.version = "0.1.0",
                              .git_commit = "a-later-commit",
                              .git_difference = "",
                              .compiler = "",
                              .build_type = "",
                              .flags = "",
                              .instruction_set = GEOPRIOR_ARCH,
                              .libraries = {}};
  return info;
}

std::string version_line() { return "later"; }

}  // namespace geoprior

int main(int argc, char** argv) {
  return geoprior::run_program(argc, argv, {geoprior::topic_with_area()});
}
