// Scales of colours, their bar and legend, and names as readers see them.

#include "testbed/view/figure/colors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "testbed/view/figure/legend.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior {
namespace {

using testing::HasSubstr;

Part with_values(const std::string& name, const Eigen::VectorXd& values) {
  Part part = make_box({0, 0, 0}, {1, 1, 1});
  part.arrays.push_back({name, "m", NamedArray::On::points, values});
  return part;
}

TEST(ColorScale, SignedValuesAreSymmetricAboutZeroAndRatiosAboutOne) {
  const Eigen::VectorXd signs = Eigen::VectorXd::LinSpaced(8, -1, 3);
  const Part part = with_values("offset", signs);
  const ColorScale scale = make_color_scale({&part}, "offset");
  EXPECT_TRUE(scale.diverging);
  EXPECT_DOUBLE_EQ(scale.low, -3);
  EXPECT_DOUBLE_EQ(scale.high, 3);
  const Part ratios = with_values("area_ratio", Eigen::VectorXd::LinSpaced(8, 0.5, 1.2));
  const ColorScale about_one = make_color_scale({&ratios}, "area_ratio");
  EXPECT_DOUBLE_EQ(about_one.low, 0.5);
  EXPECT_DOUBLE_EQ(about_one.high, 1.5);
}

// A pattern without stretch is pale, not red by its roundings; lengths may be as small as they are.
TEST(ColorScale, RoundingsOfNumbersWithoutAUnitHaveNoColours) {
  Part part = with_values("stretch", Eigen::VectorXd::LinSpaced(8, -3e-9, 5e-9));
  EXPECT_DOUBLE_EQ(make_color_scale({&part}, "stretch").high, 5e-9);
  part.arrays.back().unit = "1";
  EXPECT_DOUBLE_EQ(make_color_scale({&part}, "stretch").low, -5e-5);
  EXPECT_DOUBLE_EQ(make_color_scale({&part}, "stretch").high, 5e-5);
  part.arrays.back().values.array() += 1e-8;
  EXPECT_NEAR(make_color_scale({&part}, "stretch").high, 1e-4, 1e-7);
}

TEST(ColorScale, OneRangeForAllPartsAndUnknownArrayNamesTheOnesThereAre) {
  const Part a = with_values("height", Eigen::VectorXd::LinSpaced(8, 1, 2));
  const Part b = with_values("height", Eigen::VectorXd::LinSpaced(8, 3, 7));
  const ColorScale scale = make_color_scale({&a, &b}, "height");
  EXPECT_DOUBLE_EQ(scale.low, 1);
  EXPECT_DOUBLE_EQ(scale.high, 7);
  EXPECT_THAT(test::error_of([&] { make_color_scale({&a}, "curvature"); }), HasSubstr("height"));
}

TEST(Names, AreWrittenForReaders) {
  EXPECT_EQ(display_name("dual-quaternion"), "Dual quaternion");
  EXPECT_EQ(with_unit(90, "deg"), "90\u00b0");
  EXPECT_EQ(with_unit(0.25, "s"), "0.25 s");
  EXPECT_EQ(with_unit(3, "1"), "3");
  EXPECT_EQ(display_name("flip-uncorrected"), "FLIP uncorrected");
  EXPECT_EQ(display_name("pictures"), "Pictures") << "no acronym, though it begins like one";
}

TEST(Colors, AValueThatIsNoClassIsNamed) {
  Part part = two_classes();
  part.arrays[0].values(1, 0) = 2;
  EXPECT_THAT(test::error_of([&] {
                make_class_scale({&part}, "kind", {"flat", "cylinder"});
              }),
              HasSubstr("has the value 2"));
  EXPECT_EQ(make_class_scale({}, "kind", {"flat"}).classes.size(), 1u) << "no part need have it";
}

// Steps of ten and more of CIE 1976 lightness, red-green and yellow-blue are seen side by side.
TEST(Colors, OfTwelveClassesAreToldApart) {
  const auto lab = [](const std::array<double, 3>& srgb) {
    std::array<double, 3> linear{};
    for (std::size_t c = 0; c < 3; ++c) linear[c] = std::pow((srgb[c] + 0.055) / 1.055, 2.4);
    const auto [r, g, b] = linear;
    const double x = std::cbrt((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
    const double y = std::cbrt(0.2126 * r + 0.7152 * g + 0.0722 * b);
    const double z = std::cbrt((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
    return Eigen::Vector3d(116 * y - 16, 500 * (x - y), 200 * (y - z));
  };
  const Palette palette = class_palette(13, false);
  EXPECT_EQ(palette[12], palette[0]);
  for (std::size_t i = 0; i < 12; ++i) {
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT((lab(palette[i]) - lab(palette[j])).norm(), 15) << i << ' ' << j;
  }
}

TEST(ScalarBar, TitleStaysInsideANarrowPicture) {
  ColorScale scale;
  scale.array = "curvature_of_the_reference_surface";
  scale.unit = "1/m";
  for (const int width : {360, 540, 900, 2400}) {
    Picture picture(width, 160);
    draw_scalar_bar(picture, scale, 14);
    int left = width, right = 0;
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (picture.at(x, y) == Rgb{255, 255, 255}) continue;
        left = std::min(left, x);
        right = std::max(right, x);
      }
    }
    EXPECT_GE(left, 8) << width;
    EXPECT_LE(right, width - 9) << width;
    EXPECT_GT(right - left, width / 2) << "title and bar are there";
  }
}

TEST(Legend, BreaksIntoLinesThatFitTheFigure) {
  std::vector<LegendEntry> entries;
  for (const char* name : {"Flat", "Cylinder", "Cone", "Rulings", "Singular points", "Handles"}) {
    entries.push_back({name, {0, 0, 0}, LegendEntry::Mark::area});
  }
  EXPECT_EQ(legend_lines(entries, 2400).size(), 1U);
  EXPECT_EQ(legend_height({}, 998), 0);
  const auto lines = legend_lines(entries, 998);  // a figure of one column
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].size() + lines[1].size(), entries.size());
  Picture picture(998, legend_height(entries, 998));
  draw_legend(picture, entries, 0);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < 20; ++x) {
      ASSERT_EQ(picture.at(x, y), (Rgb{255, 255, 255})) << x << ' ' << y;
      ASSERT_EQ(picture.at(997 - x, y), (Rgb{255, 255, 255})) << 997 - x << ' ' << y;
    }
  }
}

TEST(Legend, ExplainsTheClassesAndOverlaysThatSomePanelHas) {
  FigureView view;
  view.color_by = std::make_optional<std::string>("kind");
  view.classes = {"flat", "cone"};
  view.overlays = {"rulings", "singular_points"};
  FigureRow row;
  row.cells.resize(2);
  row.cells[0].part = make_box({0, 0, 0}, {1, 1, 1});  // a baseline without classes
  EXPECT_TRUE(legend_entries({row}, view).empty());
  row.cells[1].part = two_classes();
  Part points;
  points.kind = Part::Kind::points;
  row.cells[1].overlays = {{"singular_points", points}};
  const auto entries = legend_entries({row}, view);
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[1].label, "Cone");
  EXPECT_EQ(entries[2].label, "Singular points");
  EXPECT_EQ(entries[2].mark, LegendEntry::Mark::ball);
  EXPECT_GT(entries[2].color[0], 2 * entries[2].color[2]) << "red, though it is named second";
}

TEST(ColorScale, IdentitiesTakeColoursInTurnAndLeaveTheFirstToNone) {
  Eigen::VectorXd ids = Eigen::VectorXd::Zero(8);
  ids[3] = kIdentityColors + 1;
  const Part part = with_values("track", ids);
  const ColorScale scale = make_identity_scale({&part}, "track", true);
  ASSERT_EQ(scale.palette.size(), kIdentityColors + 2);
  EXPECT_EQ(scale.palette.front(), class_palette(1, true).front());
  EXPECT_EQ(scale.palette[1], scale.palette[kIdentityColors + 1]);
  EXPECT_NE(scale.palette[1], scale.palette[2]);
  EXPECT_NE(scale.palette[1], scale.palette[0]);
  ids[3] = 0.5;
  const Part broken = with_values("track", ids);
  EXPECT_THAT(test::error_of([&] { make_identity_scale({&broken}, "track", true); }),
              HasSubstr("0.5"));
}

}  // namespace
}  // namespace geoprior
