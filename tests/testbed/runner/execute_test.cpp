#include "testbed/runner/execute.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/runner/case_runner.h"
#include "testbed/runner/journal/content_hash.h"
#include "testbed/runner/journal/frame_table.h"
#include "testbed/runner/journal/recorder.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/spec/spec.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

class Execute : public RunTest {
 protected:
  [[nodiscard]] fs::path out() const { return folder() / "out"; }
};

const VariantRecord& variant_of(const RunRecord& record, const std::string& name) {
  for (const VariantRecord& variant : record.cases.front().variants) {
    if (variant.name == name) return variant;
  }
  throw Error("no variant " + name);
}

TEST_F(Execute, RecordsPosesMetricsAndTimes) {
  const ExecuteResult result = run(load(circle("radius_m = 2")), out());
  EXPECT_FALSE(result.stopped);
  const VariantRecord& polygon = variant_of(result.record, "polygon");
  ASSERT_EQ(polygon.frames.size(), 4U);
  EXPECT_EQ(polygon.frames[3].parameter, 90);
  EXPECT_EQ(polygon.status, "done");
  // A hexagon in the circle of radius 2: 2 (1 - cos 30 deg), reached where a point meets an edge's
  // middle (24 points: every 15 degrees).
  EXPECT_NEAR(polygon.summary.at("radius_error.max").value, 2 * (1 - std::sqrt(3) / 2), 1e-12);
  EXPECT_EQ(polygon.summary.at("radius_error.max").unit, "m");
  EXPECT_EQ(polygon.summary.at("largest_radius_error").value,
            polygon.summary.at("radius_error.max").value);
  EXPECT_EQ(polygon.metrics.at("radius_error").values.size(), 4U);
  EXPECT_THAT(polygon.diagnostics.at("evaluations").values, ElementsAre(24, 24, 24, 24));
  EXPECT_EQ(polygon.timing.at("solve").size(), 4U);
  EXPECT_EQ(polygon.timing.at("solve").front().size(), 3U);
  EXPECT_EQ(polygon.timing.at("rim").front().size(), 3U);
  EXPECT_EQ(polygon.timing.at("prepare").size(), 1U);
  ASSERT_EQ(result.record.cases.front().ratios.size(), 1U);
  EXPECT_EQ(result.record.cases.front().ratios.front().of, "polygon");
}

TEST_F(Execute, GivesTheSeedOfEachCaseToItsScene) {
  std::vector<std::uint64_t> seeds;
  std::vector<Topic> topics = toy::topics();
  for (Topic& topic : topics) {
    topic.load = [&seeds, load = topic.load](const OptionSet& set, const fs::path& where,
                                             std::uint64_t seed) {
      seeds.push_back(seed);
      return load(set, where, seed);
    };
  }
  const auto file = write_experiment(
      "toy-circle/seeds", text_of(circle()) + "\n[[sweep]]\nkey = \"seed\"\nvalues = [4, 9]\n");
  ExecuteRequest request;
  request.out = out();
  execute(load_experiment(file, topics, {}), topics, request);
  ASSERT_FALSE(seeds.empty());
  for (const std::uint64_t seed : {4U, 9U})
    EXPECT_GE(std::count(seeds.begin(), seeds.end(), seed), 1) << seed;
}

TEST_F(Execute, RecordsDiagnosticsWithUnitAndMeaning) {
  run(load(circle()), out());
  const RunRecord read = read_run_file(out() / "run.h5");
  const DiagnosticColumn& column = variant_of(read, "polygon").diagnostics.at("evaluations");
  EXPECT_EQ(column.unit, "1");
  EXPECT_EQ(column.definition, "points of the rim");
  EXPECT_EQ(column.values.size(), 4U);
}

TEST_F(Execute, ADiagnosticThatIsNotDeclaredIsAnErrorOfTestsAndHasNoUnitElsewhere) {
  std::vector<Topic> topics = toy::topics();
  for (Topic& topic : topics) topic.diagnostics.clear();
  const Experiment experiment = load_experiment(circle(), topics, {});
  ExecuteRequest request;
  request.out = out();
  request.only_declared = true;
  EXPECT_THAT(error_of([&] { execute(experiment, topics, request); }),
              AllOf(HasSubstr("'evaluations'"), HasSubstr("topic 'toy-circle'")));
  request.only_declared = false;
  const ExecuteResult result = execute(experiment, topics, request);
  EXPECT_EQ(variant_of(result.record, "polygon").diagnostics.at("evaluations").unit, "");
}

TEST_F(Execute, RunsReferencesFirstAndComparesEqualParameters) {
  const ExecuteResult result = run(load(circle()), out());
  // The reference stands after the variant in the file; the record keeps the file's order.
  EXPECT_EQ(result.record.cases.front().variants.front().name, "polygon");
  const VariantRecord& polygon = variant_of(result.record, "polygon");
  // Points move along rays, so that the distance to the exact point is the error of the radius.
  const auto& distance = polygon.metrics.at("distance_to_reference").values;
  const auto& error = polygon.metrics.at("radius_error").values;
  for (std::size_t i = 0; i < distance.size(); ++i) EXPECT_NEAR(distance[i], error[i], 1e-15);
  EXPECT_FALSE(variant_of(result.record, "exact").metrics.contains("distance_to_reference"));
}

TEST_F(Execute, WritesFilesWithTheirChecksums) {
  const ExecuteResult result = run(load(pendulum()), out());
  for (const VariantRecord& variant : result.record.cases.front().variants) {
    for (const FrameRecord& frame : variant.frames) {
      ASSERT_EQ(frame.files.size(), 4U);  // rod, bob, warmth and the table
      for (const StoredFile& file : frame.files) {
        EXPECT_EQ(sha256_of_file(result.folder / file.name), file.sha256) << file.name;
      }
    }
    ASSERT_EQ(variant.artifacts.size(), 1U);
    EXPECT_EQ(sha256_of_file(result.folder / variant.artifacts[0].name),
              variant.artifacts[0].sha256);
    EXPECT_FALSE(variant.events.empty());
    EXPECT_EQ(variant.timing.at("run").size(), 9U);
    EXPECT_EQ(variant.timing.at("run").front().size(), 1U);
    EXPECT_TRUE(std::isnan(variant.timing.at("solve").front().front())) << "nothing solved yet";
    EXPECT_EQ(variant.timing.at("finish").size(), 1U);
    EXPECT_TRUE(fs::exists(result.folder / "frames/default" / (variant.name + ".pvd")));
  }
  double time = -1;
  (void)read_vtk_part(result.folder / "frames/default/exact/warmth_0008.vti", &time);
  EXPECT_EQ(time, 2);
  EXPECT_FALSE(fs::exists(result.folder / "checkpoints"));
  EXPECT_EQ(text_of(result.folder / "spec.toml"), result.record.experiment_toml);
  const RunRecord read = read_run_file(result.folder / "run.h5");
  EXPECT_EQ(read.content_sha256, result.record.content_sha256);
  EXPECT_EQ(content_sha256(read), read.content_sha256);
  EXPECT_EQ(frames_sha256(read), read.frames_sha256);
  EXPECT_EQ(metrics_sha256(read), read.metrics_sha256);
}

TEST_F(Execute, ContentDoesNotDependOnThreadsOrFolder) {
  LoadRequest one;
  one.threads = 1;
  LoadRequest two;
  two.threads = 2;
  const auto file = pendulum();
  const ExecuteResult first = run(load(file, one), out());
  const ExecuteResult second = run(load(file, two), folder() / "elsewhere");
  EXPECT_EQ(first.record.cases.front().threads, 1);
  EXPECT_EQ(second.record.cases.front().threads, 2);
  EXPECT_EQ(first.record.content_sha256, second.record.content_sha256);
  auto files = lasting_files(first.folder);
  auto others = lasting_files(second.folder);
  for (const char* spec : {"spec.toml", "spec.json"}) {
    files.erase(spec);
    others.erase(spec);
  }
  EXPECT_EQ(files, others);
}

TEST_F(Execute, RepeatsProcessesAsOftenAsTimingAsks) {
  std::string text = text_of(pendulum("frames = 2\nduration_s = 0.1"));
  const auto file = write_experiment("toy-pendulum/swing", text + "[timing]\nrepetitions = 3\n");
  const ExecuteResult result = run(load(file), out());
  EXPECT_EQ(variant_of(result.record, "euler").timing.at("run").size(), 3U);
  EXPECT_EQ(variant_of(result.record, "euler").timing.at("run").front().size(), 3U);
  EXPECT_EQ(variant_of(result.record, "euler").timing.at("prepare").front().size(), 1U);
}

TEST_F(Execute, TimesAFrameOfAProcessFromTheOneBefore) {
  // Every frame waits first: the sleep is at least as long as asked.
  const ExecuteResult result = run(load(pendulum("frames = 3\nframe_delay_ms = 10")), out());
  for (const VariantRecord& variant : result.record.cases.front().variants) {
    for (const auto& row : variant.timing.at("run")) EXPECT_GE(row.front(), 0.01);
    EXPECT_LT(variant.timing.at("finish").front().front(), 0.01) << "no waiting after the last";
  }
}

class FailedProcess : public Execute {
 protected:
  /// The second variant breaks off at the given time; frames are 0.25 s apart.
  [[nodiscard]] fs::path failing(const std::string& at_s) const {
    std::string text = text_of(pendulum());
    const std::string method = "method = \"explicit-euler\"\n";
    text.insert(text.find(method) + method.size(), "options = { fail_at_s = " + at_s + " }\n");
    return write_experiment("toy-pendulum/swing", text + R"(
[timing]
repetitions = 2
[[claim]]
text = "Euler stays near"
metric = "angle_error"
variant = "euler"
value = 100
[[claim]]
text = "the midpoint rule is nearer than Euler"
metric = "angle_error"
variant = "midpoint"
of = "euler"
[[claim]]
text = "the midpoint rule stays near"
metric = "angle_error"
variant = "midpoint"
value = 100
)");
  }
};

TEST_F(FailedProcess, KeepsItsFramesAndTheOtherVariantsRun) {
  const ExecuteResult result = run(load(failing("0.6")), out());
  const VariantRecord& euler = variant_of(result.record, "euler");
  EXPECT_EQ(euler.status, "failed");
  EXPECT_THAT(euler.error, HasSubstr("time 0.750000 s: does not converge"));
  ASSERT_EQ(euler.frames.size(), 4U);  // 0, 0.25, 0.5, 0.75 s
  for (const FrameRecord& frame : euler.frames) {
    for (const StoredFile& file : frame.files) {
      EXPECT_EQ(sha256_of_file(result.folder / file.name), file.sha256);
    }
  }
  EXPECT_TRUE(fs::exists(result.folder / "frames/default/euler.pvd"));
  EXPECT_EQ(euler.metrics.at("angle_error").values.size(), 4U);
  EXPECT_EQ(euler.timing.at("run").size(), 4U);
  EXPECT_FALSE(euler.summary.contains("largest_angle_error")) << "of the whole sequence";
  EXPECT_EQ(variant_of(result.record, "midpoint").status, "done");
  EXPECT_EQ(variant_of(result.record, "midpoint").frames.size(), 9U);
  EXPECT_EQ(variant_of(result.record, "midpoint").timing.at("run").front().size(), 2U);
  const VariantRecord read = variant_of(read_run_file(out() / "run.h5"), "euler");
  EXPECT_EQ(read.status, "failed");
  EXPECT_EQ(read.error, euler.error);
}

TEST_F(FailedProcess, DecidesNoClaim) {
  const ExecuteResult result = run(load(failing("0.6")), out());
  ASSERT_EQ(result.record.claims.size(), 3U);
  for (const std::size_t about_euler : {0U, 1U}) {
    EXPECT_FALSE(result.record.claims[about_euler].holds);
    EXPECT_THAT(result.record.claims[about_euler].detail,
                HasSubstr("variant 'euler' failed after 4 frames"));
  }
  EXPECT_TRUE(result.record.claims[2].holds);
}

TEST_F(FailedProcess, BeforeItsFirstFrameEndsTheRun) {
  EXPECT_THAT(error_of([&] { run(load(failing("0")), out()); }),
              HasSubstr("variant 'euler': time 0.000000 s: does not converge"));
  EXPECT_FALSE(fs::exists(out() / "run.h5"));
}

TEST_F(FailedProcess, StaysFailedWhenTheRunIsResumed) {
  const auto file = failing("0.6");
  run(load(file), out());
  fs::remove(out() / "run.h5");
  const ExecuteResult again = run(load(file), out(), true);
  EXPECT_EQ(variant_of(again.record, "euler").status, "failed");
  EXPECT_EQ(variant_of(again.record, "euler").frames.size(), 4U);
}

/// A variant whose method the scene is not for; `exact` or all others as they are.
class RefusedMethod : public Execute {
 protected:
  [[nodiscard]] fs::path refused() const {
    return write_experiment("toy-circle/refused", text_of(circle()) + R"(
[[variant]]
name = "too-fine"
method = "polygon"
reference = "exact"
options = { segments = 50000 }
[[variant]]
name = "coarse"
method = "polygon"
reference = "too-fine"
[[study]]
name = "order"
kind = "exponent"
variant = "too-fine"
quantity = "radius_error"
against = "vertices"
[[claim]]
text = "it converges"
metric = "study:order"
value = 2
[[claim]]
text = "finer is nearer"
metric = "radius_error"
variant = "too-fine"
of = "polygon"
[[claim]]
text = "a hexagon stays near"
metric = "radius_error"
variant = "polygon"
value = 1
)");
  }
};

TEST_F(RefusedMethod, FailsAloneAndTheOtherVariantsRun) {
  const ExecuteResult result = run(load(refused()), out());
  const VariantRecord& fine = variant_of(result.record, "too-fine");
  EXPECT_EQ(fine.status, "failed");
  EXPECT_THAT(fine.error, HasSubstr("50000 corners"));
  EXPECT_TRUE(fine.frames.empty());
  EXPECT_FALSE(fine.timing.contains("solve"));
  for (const std::string other : {"polygon", "exact", "coarse"}) {
    EXPECT_EQ(variant_of(result.record, other).status, "done") << other;
    EXPECT_EQ(variant_of(result.record, other).frames.size(), 4U) << other;
    EXPECT_TRUE(variant_of(result.record, other).timing.contains("solve")) << other;
  }
  ASSERT_EQ(result.record.claims.size(), 3U);
  EXPECT_FALSE(result.record.claims[0].holds) << "of a study that there is not";
  EXPECT_FALSE(result.record.claims[1].holds);
  EXPECT_THAT(result.record.claims[1].detail, HasSubstr("variant 'too-fine' cannot run"));
  EXPECT_TRUE(result.record.claims[2].holds);
  EXPECT_FALSE(fs::exists(out() / "frames/default/too-fine.pvd"));
  const VariantRecord read = variant_of(read_run_file(out() / "run.h5"), "too-fine");
  EXPECT_EQ(read.status, "failed");
  EXPECT_EQ(read.error, fine.error);
}

TEST_F(RefusedMethod, StaysRefusedWhenTheRunIsResumed) {
  run(load(refused()), out());
  fs::remove(out() / "run.h5");
  const ExecuteResult again = run(load(refused()), out(), true);
  EXPECT_EQ(variant_of(again.record, "too-fine").status, "failed");
  EXPECT_EQ(variant_of(again.record, "coarse").frames.size(), 4U);
}

/// Two variants, both of which have as many corners.
std::string two_polygons(const std::string& corners) {
  return "title = \"Two polygons\"\ntopic = \"toy-circle\"\nseed = 1\n"
         "[[variant]]\nname = \"one\"\nmethod = \"polygon\"\noptions = { segments = " +
         corners +
         " }\n[[variant]]\nname = \"other\"\nmethod = \"polygon\"\noptions = { segments = " +
         corners + " }\n";
}

TEST_F(RefusedMethod, OfAllVariantsEndsTheRunWithoutAFolder) {
  const fs::path file = write_experiment("toy-circle/alone", two_polygons("50000"));
  EXPECT_THAT(error_of([&] { execute(load(file), toy::topics(), {}); }),
              AllOf(HasSubstr("50000 corners"), HasSubstr("variant 'one'")));
  EXPECT_FALSE(find_run(load(file)).has_value());
  EXPECT_THAT(error_of([&] { run(load(file), out()); }), HasSubstr("50000 corners"));
  EXPECT_FALSE(fs::exists(out() / "journal.jsonl"));
}

TEST_F(RefusedMethod, OfAllVariantsOfACaseLeavesTheOtherCases) {
  const fs::path file = write_experiment(
      "toy-circle/cases",
      two_polygons("50000") + "[[sweep]]\nkey = \"scene.points\"\nvalues = [60]\n");
  const ExecuteResult result = run(load(file), out());
  ASSERT_EQ(result.record.cases.size(), 2U);
  for (const VariantRecord& variant : result.record.cases[0].variants)
    EXPECT_TRUE(could_not_run(variant)) << variant.name;
  for (const VariantRecord& variant : result.record.cases[1].variants)
    EXPECT_EQ(variant.status, "done") << variant.name;
}

TEST_F(Execute, RefusesAFolderThatIsNotEmpty) {
  fs::create_directories(out());
  std::ofstream(out() / "precious") << "data";
  EXPECT_THAT(error_of([&] { run(load(circle()), out()); }), HasSubstr("never overwritten"));
  EXPECT_EQ(text_of(out() / "precious"), "data");
}

TEST_F(Execute, RefusesAFolderThatCannotBeMade) {
  std::ofstream(folder() / "file") << "no folder";
  const auto below = folder() / "file" / "run";
  const std::string message = error_of([&] { run(load(circle()), below); });
  EXPECT_THAT(message, HasSubstr((folder() / "file").string()));
}

TEST_F(Execute, FindsAFinishedRunOfTheSameHash) {
  const Experiment experiment = load(circle());
  EXPECT_FALSE(find_run(experiment).has_value());
  const ExecuteResult result = execute(experiment, toy::topics(), {});
  ASSERT_TRUE(find_run(experiment).has_value());
  EXPECT_EQ(fs::canonical(*find_run(experiment)), result.folder);
  LoadRequest other;
  other.sets = {"scene.radius_m=3"};
  EXPECT_FALSE(find_run(load(circle(), other)).has_value());
}

TEST(ReferencesFirst, KeepsTheOrderAndFindsCircles) {
  std::vector<VariantSpec> variants(4);
  const char* names[] = {"a", "b", "c", "d"};
  for (std::size_t i = 0; i < 4; ++i) variants[i].name = names[i];
  variants[0].reference = "c";
  variants[2].reference = "d";
  variants[3].reference = "left-out";
  std::string order;
  for (const VariantSpec* variant : references_first(variants)) order += variant->name;
  EXPECT_EQ(order, "bdca");
  variants[3].reference = "a";
  EXPECT_THROW((void)references_first(variants), Error);
}

/// Pose method of a topic of the tests: a point that goes wrong, or one taken from another run.
struct FollowerSceneOptions {
  std::string input;
  std::optional<std::string> second;
  int frames = 3;
};
void describe(OptionVisitor& v, FollowerSceneOptions& o) {
  v.value("input", o.input, {.doc = "frames of a pendulum"});
  v.value("second", o.second, {.doc = "frames of another"});
  v.value("frames", o.frames, {.doc = "frames"});
}
struct NoOptions {};
void describe(OptionVisitor&, NoOptions&) {}

class FollowerScene final : public Scene {
 public:
  FollowerSceneOptions options;
  [[nodiscard]] std::vector<double> parameters() const override {
    std::vector<double> all;
    for (int i = 0; i < options.frames; ++i) all.push_back(i);
    return all;
  }
  [[nodiscard]] std::string parameter_name() const override { return "index"; }
  [[nodiscard]] std::string parameter_unit() const override { return "1"; }
  [[nodiscard]] std::vector<fs::path> inputs() const override {
    if (!options.second || !options.second->ends_with(".wav")) return {};
    return {*options.second};
  }
};

class Follower final : public PoseMethod {
 public:
  Follower(const FollowerScene& scene, bool breaks) : scene_(scene), breaks_(breaks) {}
  void solve(double parameter, RunContext&) override {
    frame_ = {};
    Part& bob = frame_.parts["bob"];
    if (breaks_) {
      bob.kind = Part::Kind::points;
      bob.points = Eigen::MatrixX3d::Zero(3, 3);
      if (parameter == 2) bob.points(1, 2) = std::numeric_limits<double>::quiet_NaN();
    } else {
      char name[32];
      std::snprintf(name, sizeof name, "bob_%04d.vtp", static_cast<int>(parameter));
      bob = read_vtk_part(fs::path(scene_.options.input) / name);
    }
  }
  [[nodiscard]] Frame frame() const override { return frame_; }

 private:
  const FollowerScene& scene_;
  bool breaks_;
  Frame frame_;
};

/// Its frame holds the sum of the parameters since it began its path; asks once to stop, at 2.
class Walker final : public PoseMethod {
 public:
  explicit Walker(bool stops) : stops_(stops) {}
  void solve(double parameter, RunContext&) override {
    sum_ += parameter;
    if (stops_ && parameter == 2) request_stop();
  }
  [[nodiscard]] bool path_dependent() const override { return true; }
  void restart() override { sum_ = 0; }
  [[nodiscard]] Frame frame() const override {
    Frame frame;
    Part& bob = frame.parts["bob"];
    bob.kind = Part::Kind::points;
    bob.points = Eigen::MatrixX3d::Constant(1, 3, sum_);
    return frame;
  }

 private:
  bool stops_;
  double sum_ = 0;
};

Topic follower_topic() {
  Topic topic;
  topic.name = "follower";
  topic.default_scene = [] { return std::make_unique<TypedOptions<FollowerSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const fs::path&, std::uint64_t) -> std::shared_ptr<Scene> {
    auto scene = std::make_shared<FollowerScene>();
    scene->options = dynamic_cast<const TypedOptions<FollowerSceneOptions>&>(set).options;
    return scene;
  };
  for (const bool breaks : {false, true}) {
    topic.methods.push_back(method_entry<FollowerScene, NoOptions>(
        breaks ? "broken" : "follow", false, "of the tests", "none",
        [breaks](const FollowerScene& scene, const NoOptions&, RunContext&) {
          return std::make_unique<Follower>(scene, breaks);
        }));
  }
  topic.methods.push_back(method_entry<FollowerScene, NoOptions>(
      "walk", false, "of the tests", "none",
      [stops = std::make_shared<bool>(true)](const FollowerScene&, const NoOptions&, RunContext&) {
        return std::make_unique<Walker>(std::exchange(*stops, false));
      }));
  return topic;
}

class Inputs : public Execute {
 protected:
  void SetUp() override {
    Execute::SetUp();
    topics = toy::topics();
    topics.push_back(follower_topic());
  }
  [[nodiscard]] fs::path follower(const std::string& name, const std::string& scene,
                                  const std::string& method = "follow") const {
    return write_experiment("follower/" + name,
                            "title = \"f\"\ntopic = \"follower\"\n[scene]\n" + scene +
                                "\n[[variant]]\nname = \"v\"\nmethod = \"" + method + "\"\n");
  }
  ExecuteResult run_file(const fs::path& file, const fs::path& to) {
    ExecuteRequest request;
    request.out = to;
    return execute(load_experiment(file, topics, {}), topics, request);
  }
  std::vector<Topic> topics;
};

TEST_F(Inputs, AMethodThatDependsOnItsPathWalksItAgainWhenARunIsResumed) {
  const auto file = follower("walk", "input = \"\"\nframes = 5", "walk");
  const Experiment experiment = load_experiment(file, topics, {});
  ExecuteRequest request;
  request.out = out();
  (void)execute(experiment, topics, request);
  clear_stop();
  EXPECT_TRUE(fs::exists(out() / "frames/default/v/bob_0002.vtp"));
  EXPECT_FALSE(fs::exists(out() / "frames/default/v/bob_0003.vtp"));
  request.resume = true;
  (void)execute(experiment, topics, request);
  // 0 + 1 + 2 + 3 + 4; a walk that began at the third frame would end at 7.
  EXPECT_EQ(read_vtk_part(out() / "frames/default/v/bob_0004.vtp").points(0, 0), 10);
}

TEST_F(Inputs, AreMadeWhenMissingAndFoundAgain) {
  (void)pendulum();
  const auto file = follower("f", "input = \"run:toy-pendulum/swing/exact\"");
  const ExecuteResult result = run_file(file, out());
  ASSERT_EQ(result.record.inputs.size(), 1U);
  EXPECT_EQ(result.record.inputs[0].name, "run:toy-pendulum/swing/exact");
  const auto input = find_run(load(folder() / "experiments/toy-pendulum/swing.toml"));
  ASSERT_TRUE(input.has_value());
  EXPECT_EQ(result.record.inputs[0].sha256, read_run_file(*input / "run.h5").content_sha256);
  const Part original = read_vtk_part(*input / "frames/default/exact/bob_0002.vtp");
  const Part followed = read_vtk_part(out() / "frames/default/v/bob_0002.vtp");
  EXPECT_EQ(original.points, followed.points);
  const auto made = fs::last_write_time(*input / "run.h5");
  run_file(file, folder() / "again");
  EXPECT_EQ(fs::last_write_time(*input / "run.h5"), made);
  EXPECT_EQ(std::distance(fs::directory_iterator(input->parent_path()), {}), 1);
}

TEST_F(Inputs, MayBeAnArtifact) {
  (void)pendulum();
  const auto scene = [](const std::string& file) {
    return "input = \"run:toy-pendulum/swing/exact\"\n"
           "second = \"run:toy-pendulum/swing/exact#" +
           file + "\"";
  };
  const ExecuteResult result = run_file(follower("f", scene("swing.wav")), out());
  const auto input = find_run(load(folder() / "experiments/toy-pendulum/swing.toml"));
  ASSERT_TRUE(input.has_value());
  const std::string hash = sha256_of_file(*input / "artifacts/default/exact/swing.wav");
  EXPECT_EQ(std::count_if(result.record.inputs.begin(), result.record.inputs.end(),
                          [&](const StoredFile& file) { return file.sha256 == hash; }),
            1);
  EXPECT_THAT(error_of([&] { run_file(follower("g", scene("song.wav")), folder() / "g"); }),
              HasSubstr("allowed: swing.wav"));
  EXPECT_THAT(error_of([&] { run_file(follower("h", scene("")), folder() / "h"); }),
              HasSubstr("#<file>"));
}

TEST_F(Inputs, InFoldersThatAreNoUtf8AreKnownAgain) {
  ::setenv("GEOPRIOR_RUNS", (folder() / "runs\xe9 \xff").c_str(), 1);
  (void)pendulum();
  const auto file = follower("f",
                             "input = \"run:toy-pendulum/swing/exact\"\n"
                             "second = \"run:toy-pendulum/swing/exact#swing.wav\"");
  const Experiment experiment = load_experiment(file, topics, {});
  const ExecuteResult result = execute(experiment, topics, {});
  EXPECT_EQ(find_run(experiment), result.folder);
  EXPECT_THAT(text_of(result.folder / "journal.jsonl"), HasSubstr(R"(runs\\xe9 \\xff/toy)"));
}

TEST_F(Inputs, NamingAVariantThatIsNotThereIsAnError) {
  (void)pendulum();
  const auto file = follower("f", "input = \"run:toy-pendulum/swing/default/nobody\"");
  EXPECT_THAT(error_of([&] { run_file(file, out()); }), HasSubstr("default/exact"));
}

TEST_F(Inputs, ThatNeedEachOtherAreAnError) {
  (void)follower("b", "input = \"run:follower/a/v\"");
  const auto a = follower("a", "input = \"\"\nsecond = \"run:follower/b/v\"");
  EXPECT_THAT(error_of([&] { run_file(a, out()); }),
              HasSubstr("follower/a -> follower/b -> follower/a"));
}

TEST_F(Inputs, WithoutExperimentOrWithTooFewPartsAreErrors) {
  EXPECT_THAT(error_of([&] { run_file(follower("f", "input = \"run:no/such/v\""), out()); }),
              HasSubstr("there is no experiment 'no/such'"));
  EXPECT_THAT(error_of([&] { run_file(follower("g", "input = \"run:x/v\""), folder() / "g"); }),
              HasSubstr("run:<topic>/<experiment>/<variant>"));
}

TEST_F(Inputs, PositionThatIsNotFiniteNamesMethodFrameAndPoint) {
  const std::string message =
      error_of([&] { run_file(follower("f", "input = \"\"", "broken"), out()); });
  for (const char* part : {"variant 'v'", "method 'broken'", "frame 2", "part 'bob'", "point 1"}) {
    EXPECT_THAT(message, HasSubstr(part));
  }
  EXPECT_FALSE(fs::exists(out() / "run.h5"));
  EXPECT_FALSE(fs::exists(out() / "frames/default/v/bob_0002.vtp"));
  EXPECT_THAT(text_of(out() / "journal.jsonl"), HasSubstr("\"kind\":\"error\""));
}

TEST(FrameTable, SurvivesCsvExactly) {
  FrameTable table;
  table.columns = {"angle, \"theta\" [rad]", "x"};
  table.rows.resize(3, 2);
  table.rows << 0.1, -0.0, 1e-310, std::numeric_limits<double>::infinity(), 1.0 / 3,
      std::numeric_limits<double>::quiet_NaN();
  const std::string text = table_to_csv(table);
  const FrameTable read = table_from_csv(text, "t.csv");
  EXPECT_EQ(read.columns, table.columns);
  EXPECT_EQ(table_to_csv(read), text);
  EXPECT_EQ(read.rows.topRows(2), table.rows.topRows(2));
  EXPECT_THAT(error_of([&] { (void)table_from_csv("\"a\",\"b\"\n1\n", "t.csv"); }),
              HasSubstr("line 2"));
}

}  // namespace
}  // namespace geoprior::test
