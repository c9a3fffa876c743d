// Sections of surfaces: curves, areas, and what is painted of them.

#include "testbed/view/panel/section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/testbed/fake_run.h"
#include "tests/testbed/view/views.h"

namespace geoprior {
namespace {

Part box_about(double x, double half) {
  return make_box({x - half, -half, 0}, {x + half, half, 1});
}

double enclosed_area(const std::vector<CurveSegment>& segments) {
  double area = 0;
  for (const CurveSegment& s : segments) {
    area += 0.5 * (s.from.x() * s.to.y() - s.from.y() * s.to.x());
  }
  return area;
}

TEST(Section, OfABoxIsItsSquareCounterClockwise) {
  const auto segments = cut(box_about(0, 0.5), front_window());
  EXPECT_NEAR(enclosed_area(segments), 1.0, 1e-12);  // round-off of a few products
  EXPECT_EQ(winding_number(segments, {0.1, 0.2}), 1);
  EXPECT_EQ(winding_number(segments, {0.7, 0.2}), 0);
  EXPECT_EQ(winding_number(segments, {0.1, 0.8}), 0);
}

TEST(Section, CountsOverlapTwiceAndInsideOutNegative) {
  const auto overlapping = cut(join(box_about(0, 0.5), box_about(0.6, 0.5)), front_window());
  EXPECT_EQ(winding_number(overlapping, {0.3, 0.0}), 2);
  EXPECT_EQ(winding_number(overlapping, {-0.3, 0.0}), 1);
  EXPECT_EQ(winding_number(overlapping, {0.9, 0.0}), 1);
  Part inside_out = box_about(0, 0.5);
  inside_out.triangles.col(1).swap(inside_out.triangles.col(2));
  EXPECT_EQ(winding_number(cut(inside_out, front_window()), {0, 0}), -1);
}

TEST(Section, PlaneThroughVerticesGivesAClosedCurve) {
  ViewWindow window = front_window();
  window.center.z() = 1;  // the top face lies in the plane and counts as in front of it
  EXPECT_NEAR(enclosed_area(cut(box_about(0, 0.5), window)), 1.0, 1e-12);
}

TEST(Section, PaintsOverlapRedOnItsTrueArea) {
  const Part part = join(box_about(0, 0.5), box_about(0.6, 0.5));
  constexpr int kSize = 400;
  const Picture picture = draw_section(cut(part, front_window()), front_window(), kSize, kSize);
  int red = 0;
  for (const Rgb& p : picture.pixels) red += p[0] > 180 && p[1] < 120 ? 1 : 0;
  // The overlap is 0.4 m by 1 m of 16 m^2; its border, 1.5 px thick, takes at most a pixel a side.
  const double pixels_per_metre = kSize / 4.0;
  EXPECT_NEAR(red, 0.4 * pixels_per_metre * pixels_per_metre, 2.8 * pixels_per_metre);
  EXPECT_EQ(picture.at(2, 2), (Rgb{255, 255, 255}));
}

TEST(Section, OpenSurfaceIsNotFilled) {
  Part open = box_about(0, 0.5);
  open.triangles.conservativeResize(2, 3);  // one side
  const Picture picture = draw_section(cut(open, front_window()), front_window(), 100, 100);
  EXPECT_EQ(picture.at(90, 50), (Rgb{255, 255, 255}));
  EXPECT_EQ(picture.at(50, 50), (Rgb{255, 255, 255}));
}

}  // namespace
}  // namespace geoprior
