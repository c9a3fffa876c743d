// What is refused before any work, whatever the numbers multiply to.

#include "core/limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "core/geometry/procedural.h"

namespace geoprior {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Action>
std::string refusal_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A limit of memory that the test gives, whatever the machine has.
class Limits : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("GEOPRIOR_MEMORY_GB", "2", 1); }
  void TearDown() override { ::unsetenv("GEOPRIOR_MEMORY_GB"); }
};

TEST_F(Limits, MemoryIsWhatTheEnvironmentOrTheMachineHas) {
  EXPECT_EQ(memory_limit(), 2e9);
  ::unsetenv("GEOPRIOR_MEMORY_GB");
  EXPECT_GT(memory_limit(), 1e8);
  EXPECT_LT(memory_limit(), 1e15);
  for (const char* wrong : {"much", "-1", "0", "nan", "inf", "4 GB"}) {
    ::setenv("GEOPRIOR_MEMORY_GB", wrong, 1);
    EXPECT_THAT(refusal_of([] { (void)memory_limit(); }), HasSubstr("GEOPRIOR_MEMORY_GB"));
  }
}

TEST_F(Limits, NumbersAreReadable) {
  EXPECT_EQ(bytes_text(640), "640 B");
  EXPECT_EQ(bytes_text(12.5e9), "12.5 GB");
  EXPECT_EQ(count_text(2000900002), "2000900002");
  EXPECT_EQ(count_text(2e18), "2e+18");
}

TEST_F(Limits, WhatFitsIsLetPass) {
  EXPECT_NO_THROW(require_count(10, "cases", 10, "sweep"));
  EXPECT_NO_THROW(require_frames(1, 0.04, "scene.duration"));
  EXPECT_NO_THROW(require_vertices(1e6, "scene"));
}

TEST_F(Limits, WhatDoesNotFitIsNamedWithItsNumbers) {
  EXPECT_EQ(refusal_of([] { require_count(11, "cases", 10, "sweep"); }),
            "sweep: asks for 11 cases (allowed: at most 10)");
  EXPECT_THAT(refusal_of([] { require_memory(4e9, 4e6, "vertices", "scene"); }),
              AllOf(HasSubstr("scene: asks for 4000000 vertices, about 4.0 GB of memory"),
                    HasSubstr("at most 2.0 GB"), HasSubstr("GEOPRIOR_MEMORY_GB")));
  EXPECT_THAT(refusal_of([] { require_frames(1e6, 1e-9, "scene.duration"); }),
              HasSubstr("asks for 1e+15 frames of 1e-09 s"));
  EXPECT_THAT(refusal_of([] { require_frames(1e12, 0.04, "scene.duration"); }),
              HasSubstr("scene.duration: asks for 25000000000001 frames"));
}

TEST_F(Limits, NoNumberIsMoreThanAny) {
  EXPECT_NE(refusal_of([] { require_count(NAN, "cases", 10, ""); }), "no error");
  EXPECT_NE(refusal_of([] { require_frames(kInfinity, kInfinity, ""); }), "no error");
  EXPECT_NE(refusal_of([] { require_frames(1, 0, ""); }), "no error");
  EXPECT_NE(refusal_of([] { require_vertices(kInfinity, ""); }), "no error");
}

// 100000 segments times 20001 rings do not fit into 32 bits, nor into the machine.
TEST_F(Limits, CylinderOfAllItsRangesIsRefused) {
  CylinderOptions options;
  options.segments = 100000;
  options.rings_per_half = 10000;
  const auto refusal = [&] { return refusal_of([&] { (void)two_bone_cylinder(options); }); };
  EXPECT_THAT(refusal(), AllOf(HasSubstr("scene.cylinder.segments: asks for"),
                               HasSubstr("vertices, about"), HasSubstr("TB of memory")));
  options.segments = 3;
  options.rings_per_half = 1;
  options.cap_height = 1e300;
  EXPECT_THAT(refusal(), HasSubstr("scene.cylinder.segments: asks for"));
}

TEST_F(Limits, LongFingerIsRefused) {
  FingerOptions options;
  options.phalanx_length = {1e9, 1, 1};
  options.ring_spacing = 0.01;
  EXPECT_THAT(refusal_of([&] { (void)capsule_finger(options); }),
              HasSubstr("scene.finger.segments: asks for"));
}

}  // namespace
}  // namespace geoprior
