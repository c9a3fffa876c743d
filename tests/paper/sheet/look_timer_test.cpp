#include "solvers/paper/meshing/look_timer.h"

#include <gtest/gtest.h>

#include <vector>

namespace geoprior::paper {
namespace {

/// Frames up to the next look.
int frames_to_next(LookTimer& timer) {
  int frames = 0;
  do {
    timer.pass_frame();
    ++frames;
  } while (!timer.is_due());
  return frames;
}

TEST(LookTimer, WaitsTwiceAsLongAfterEveryLookInVainUpToEightTimes) {
  LookTimer timer(5);
  std::vector<int> waits;
  for (int look = 0; look < 6; ++look) {
    waits.push_back(frames_to_next(timer));
    timer.looked();
    timer.in_vain();
    EXPECT_FALSE(timer.may_be_early());
  }
  EXPECT_EQ(waits, (std::vector<int>{5, 10, 20, 40, 40, 40}));
}

TEST(LookTimer, WaitsNoLongerThanEverAfterALookThatMendedSomething) {
  LookTimer timer(3);
  frames_to_next(timer);
  timer.looked();
  timer.in_vain();
  EXPECT_EQ(frames_to_next(timer), 6);
  EXPECT_EQ(timer.since(), 6);
  timer.looked();
  EXPECT_TRUE(timer.may_be_early());
  EXPECT_EQ(frames_to_next(timer), 3);
}

TEST(LookTimer, GoesOnFromWhatItSaved) {
  LookTimer timer(2);
  frames_to_next(timer);
  timer.looked();
  timer.in_vain();
  timer.pass_frame();
  StateWriter out;
  timer.save(out);
  LookTimer other(2);
  const State bytes = out.take();
  StateReader in(bytes);
  other.load(in);
  EXPECT_EQ(frames_to_next(other), frames_to_next(timer));
}

}  // namespace
}  // namespace geoprior::paper
