#include "testbed/topic.h"

#include "solvers/sample/growing_square.h"
#include "testbed/metric_rows.h"

namespace geoprior::sample {

Topic make_topic();

namespace {

struct SampleSceneOptions {
  int frames = 2;
};

void describe(OptionVisitor& v, SampleSceneOptions& options) {
  v.value("frames", options.frames, {.doc = "seconds 1, 2, …", .min = 1, .max = 1000});
}

class SampleScene final : public Scene {
 public:
  explicit SampleScene(const SampleSceneOptions& options) : options_(options) {}
  [[nodiscard]] std::vector<double> parameters() const override {
    std::vector<double> times;
    for (int i = 1; i <= options_.frames; ++i) times.push_back(i);
    return times;
  }
  [[nodiscard]] std::string parameter_name() const override { return "time"; }
  [[nodiscard]] std::string parameter_unit() const override { return "s"; }
  [[nodiscard]] std::vector<std::filesystem::path> inputs() const override { return {}; }

 private:
  SampleSceneOptions options_;
};

double edge(const SampleScene&, const Frame& frame) {
  const Part& square = frame.require_part("surface");
  return (square.points.row(1) - square.points.row(0)).norm();
}

}  // namespace

Topic make_topic() {
  Topic topic;
  topic.name = "sample";
  topic.summary = "a square that grows";
  topic.default_scene = [] { return std::make_unique<TypedOptions<SampleSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path&, std::uint64_t) {
    return std::make_shared<SampleScene>(
        dynamic_cast<const TypedOptions<SampleSceneOptions>&>(set).options);
  };
  topic.methods.push_back(method_entry<SampleScene, GrowingSquareOptions>(
      "growing-square", false, "a square of edge rate * t", "elementary geometry",
      [](const SampleScene&, const GrowingSquareOptions& options, RunContext&) {
        return std::make_unique<GrowingSquare>(options);
      }));
  topic.metrics.push_back(frame_metrics<SampleScene>(edge).row("edge", "m", "edge of the square",
                                                               Direction::none, {1e-12, 1e-9}));
  return topic;
}

}  // namespace geoprior::sample
