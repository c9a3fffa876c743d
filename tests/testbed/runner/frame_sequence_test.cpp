// The frames of a long run are dropped once they are written; metrics get them back from the disk.

#include "testbed/frame_sequence.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/runner/journal/recorded_frames.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/judgement/measure.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::HasSubstr;

namespace fs = std::filesystem;

/// A finished run of the pendulum, 9 frames, opened again.
class FramesOfARun : public RunTest {
 protected:
  void SetUp() override {
    RunTest::SetUp();
    record_ = *find_variant(run(load(pendulum()), out()).record.cases.at(0), "midpoint");
    files_.emplace(out());
  }
  [[nodiscard]] fs::path out() const { return folder() / "out"; }
  [[nodiscard]] const FrameFiles& files() const { return *files_; }
  [[nodiscard]] const VariantRecord& record() const { return record_; }

 private:
  VariantRecord record_;
  std::optional<FrameFiles> files_;
};

TEST_F(FramesOfARun, HoldNoMoreThanAFewFramesInMemory) {
  const KeptFrames none(0);
  const RecordedFrames frames(files(), record(), none);
  ASSERT_EQ(frames.size(), 9U);
  std::vector<std::weak_ptr<const Frame>> seen;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    seen.push_back(frames.frame(i));
    // A metric of second differences looks back by two frames.
    if (i >= 2) {
      EXPECT_EQ(frames.frame(i - 2), seen[i - 2].lock());
    }
    const auto alive =
        std::count_if(seen.begin(), seen.end(), [](const auto& frame) { return !frame.expired(); });
    EXPECT_LE(alive, static_cast<std::ptrdiff_t>(RecordedFrames::kRemembered));
  }
  EXPECT_EQ(frames.frames_read(), 9U) << "each once";
}

TEST_F(FramesOfARun, AreEqualWhetherTheyWereKeptOrRead) {
  const Frame first = files().frame(record(), 0);
  KeptFrames kept(3 * memory_of(first));
  for (std::size_t i = 0; i < 9; ++i) kept.keep(i, files().frame(record(), i));
  EXPECT_LE(kept.bytes(), 3 * memory_of(first));
  EXPECT_NE(kept.find(2), nullptr);
  EXPECT_EQ(kept.find(3), nullptr) << "three frames fit";
  const RecordedFrames frames(files(), record(), kept);
  for (std::size_t i = 0; i < 9; ++i) {
    const Frame read = files().frame(record(), i);
    EXPECT_EQ(frames.parameter(i), read.parameter);
    EXPECT_EQ(frames.frame(i)->require_part("bob").points, read.require_part("bob").points);
    EXPECT_EQ(frames.frame(i)->require_table("state").rows, read.require_table("state").rows);
    EXPECT_EQ(frames.frame(i)->diagnostics, read.diagnostics);
  }
  EXPECT_EQ(frames.frames_read(), 6U);
}

TEST_F(FramesOfARun, ComeInOrderOfParameter) {
  VariantRecord turned = record();
  std::reverse(turned.frames.begin(), turned.frames.end());
  const KeptFrames none(0);
  const RecordedFrames frames(files(), turned, none);
  const std::vector<double> parameters = frames.parameters();
  EXPECT_TRUE(std::is_sorted(parameters.begin(), parameters.end()));
  EXPECT_EQ(frames.parameter(8), 2);
  EXPECT_EQ(frames.frame(8)->parameter, 2);
}

TEST_F(FramesOfARun, ReadOnlyThePartThatIsAskedFor) {
  fs::remove(out() / "frames/default/midpoint/warmth_0004.vti");
  const KeptFrames none(0);
  const RecordedFrames frames(files(), record(), none);
  const std::shared_ptr<const Part> bob = frames.part(4, "bob");
  ASSERT_NE(bob, nullptr);
  EXPECT_EQ(bob->points.rows(), 1);
  EXPECT_EQ(frames.part(4, "nothing"), nullptr);
  EXPECT_EQ(frames.frames_read(), 0U);
  EXPECT_THAT(error_of([&] { (void)frames.frame(4); }), HasSubstr("warmth_0004.vti"));
  EXPECT_EQ(files().frame(record(), 4, {{"bob", "state"}}).parts.size(), 1U);
}

TEST_F(FramesOfARun, HaveTheEventsInTheOrderInWhichTheyWereRecorded) {
  const KeptFrames none(0);
  const RecordedFrames frames(files(), record(), none);
  const RunRecord stored = read_run_file(out() / "run.h5");
  const std::vector<Event>& expected = find_variant(stored.cases.at(0), "midpoint")->events;
  ASSERT_GE(expected.size(), 2U);
  ASSERT_EQ(frames.events().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(frames.events()[i].time_s, expected[i].time_s);
    EXPECT_EQ(frames.events()[i].kind, "crossing");
    EXPECT_EQ(frames.events()[i].numbers, expected[i].numbers);
  }
}

TEST_F(FramesOfARun, HaveTheArtifactsAsTheyWereRecorded) {
  const KeptFrames none(0);
  const RecordedFrames frames(files(), record(), none);
  const fs::path file = out() / "artifacts/default/midpoint/swing.wav";
  const auto swing = frames.artifact("swing.wav");
  ASSERT_TRUE(swing.has_value());
  EXPECT_EQ(sha256({reinterpret_cast<const char*>(swing->data()), swing->size()}),
            sha256_of_file(file));
  EXPECT_EQ(swing->at(0), std::byte{'R'});
  EXPECT_FALSE(frames.artifact("other.wav"));
  std::ofstream(file, std::ios::binary | std::ios::app) << "more";
  EXPECT_THAT(error_of([&] { (void)frames.artifact("swing.wav"); }), HasSubstr(file.string()));
}

TEST(FramesInMemory, HaveTheEventsAndArtifactsTheyWereGiven) {
  const FramesInMemory bare({Frame{}});
  EXPECT_TRUE(bare.events().empty());
  EXPECT_FALSE(bare.artifact("mix.wav"));
  const std::vector<std::byte> bytes{std::byte{1}, std::byte{2}};
  const FramesInMemory given({}, {{0.5, "tear", {0, 0, 0}, 1, 0}}, {{"mix.wav", bytes}});
  EXPECT_EQ(given.events().at(0).kind, "tear");
  EXPECT_EQ(given.artifact("mix.wav"), bytes);
  EXPECT_FALSE(given.artifact("mix"));
}

TEST(ReferenceParts, AreThoseOfAllMetricsThatCompare) {
  EXPECT_EQ(reference_parts(toy::pendulum_topic()), (std::set<std::string>{"bob"}));
  EXPECT_EQ(reference_parts(toy::circle_topic()), std::nullopt) << "does not say: all of them";
}

}  // namespace
}  // namespace geoprior::test
