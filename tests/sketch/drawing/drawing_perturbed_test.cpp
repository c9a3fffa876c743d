// Two views of known outlines, drawn in the ways that SVG and the conventions of drawings allow:
// size of the page, scale, layers by label or id, kinds by colour, class or attribute, silhouettes
// in pieces, transforms. What is right is computed from the outlines by the matrices that were
// written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <string>

#include "experiments/sketch/drawing/drawing_file.h"
#include "tests/support/perturbed.h"
#include "tests/support/svg_samples.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::sketch {
namespace {

using Points = std::vector<Eigen::Vector2d>;

class PerturbedDrawing {
 public:
  explicit PerturbedDrawing(int seed) : samples_(seed) {
    make_page();
    const std::string front = view("front", {60, 70});
    const std::string side = view("side", {190, 80});
    std::string text =
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:ink='http://www.inkscape.org/"
        "namespaces/inkscape'" +
        page_ + ">\n<style>.quiet { stroke: none }</style>\n";
    text += samples_.maybe(2) ? front + side : side + front;
    text_ = samples_.file(text + "</svg>\n");
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const DrawingFileOptions& options() const { return options_; }
  /// In metres from the lower left corner of the page.
  [[nodiscard]] Points outline(ViewKind kind) const {
    Points points = kind == ViewKind::front ? outlines_[0] : outlines_[1];
    for (Eigen::Vector2d& p : points) p = to_page_ * p;
    return points;
  }
  [[nodiscard]] Eigen::Vector2d seam_end(ViewKind kind) const {
    return to_page_ * seam_ends_[kind == ViewKind::front ? 0 : 1];
  }

 private:
  void make_page() {
    const std::string unit = samples_.one_of({"mm", "cm", "in", "pt", "pc", "Q", "px", ""});
    const auto width = test::svg_page_size(10 + samples_.below(40), unit);
    const auto height = test::svg_page_size(10 + samples_.below(40), unit);
    const Eigen::Vector2d box(250 + samples_.below(50), 150 + samples_.below(50));
    const Eigen::Vector2d corner(samples_.below(60) - 30, samples_.below(60) - 30);
    const std::string how = samples_.one_of({"", "none", "xMinYMin meet", "xMaxYMax slice"});
    page_ = " viewBox='" + samples_.pair(corner) + " " + samples_.pair(box) + "' width='" +
            width.text + "' height='" + height.text + "'";
    if (!how.empty()) page_ += " preserveAspectRatio='" + how + "'";
    double larger = 1;
    if (samples_.maybe(3)) {
      larger = 10;
      page_ += samples_.one_of({" data-scale='1:10'", " data-scale='10'"});
    }
    Eigen::Vector2d size = larger * Eigen::Vector2d(width.metres, height.metres);
    Eigen::Vector2d scale = size.cwiseQuotient(box);
    if (how.empty() || how.ends_with("meet")) scale.setConstant(scale.minCoeff());
    if (how.ends_with("slice")) scale.setConstant(scale.maxCoeff());
    double align = how.empty() ? 0.5 : how.ends_with("slice") ? 1 : 0;
    if (samples_.maybe(4)) {
      options_.unit_m = samples_.between(1e-3, 1e-2);
      scale.setConstant(*options_.unit_m);
      size = scale.cwiseProduct(box);
      align = 0;
    }
    const Eigen::Vector2d left_over = size - scale.cwiseProduct(box);
    to_page_ = Eigen::Translation2d(0, size.y()) * Eigen::AlignedScaling2d(1, -1) *
               Eigen::Translation2d(align * left_over) * Eigen::AlignedScaling2d(scale) *
               Eigen::Translation2d(-corner);
    options_.tolerance = 1e-6;
    options_.hand.snap = 1e-6;
  }

  static Points pulled_back(const Points& points, const Eigen::Affine2d& map) {
    Points back;
    for (const Eigen::Vector2d& p : points) back.push_back(map.inverse() * p);
    return back;
  }

  std::string kind(const std::string& name, const std::string& colour) {
    switch (samples_.below(4)) {
      case 0:
        return " data-kind='" + name + "'";
      case 1:
        return " class='thin " + name + "'";
      case 2:
        return " stroke='" + colour + "'";
      default:
        return " style='fill:none;stroke:" + colour + ";stroke-width:0.5'";
    }
  }

  /// The closed line, or pieces of it in any order and either way round.
  std::string silhouette(const Points& points) {
    const std::string says = kind("silhouette", samples_.one_of({"#000", "black", "rgb(0,0,0)"}));
    samples_.begin_path();
    if (samples_.maybe(2))
      return "<path" + says + " d=" + samples_.quoted(samples_.path(points)) + "/>\n";
    std::vector<std::string> pieces;
    for (std::size_t i = 0; i < points.size();) {
      Points piece{points[i]};
      for (int n = 1 + samples_.below(3); n > 0 && i < points.size(); --n)
        piece.push_back(points[++i % points.size()]);
      if (samples_.maybe(2)) std::reverse(piece.begin(), piece.end());
      samples_.begin_path();
      pieces.push_back("<path" + says + " d=" + samples_.quoted(samples_.path(piece, false)) +
                       "/>\n");
    }
    std::string text;
    while (!pieces.empty()) {
      const auto at = pieces.begin() + samples_.below(static_cast<int>(pieces.size()));
      text += *at;
      pieces.erase(at);
    }
    return text;
  }

  std::string view(const std::string& name, const Eigen::Vector2d& centre) {
    outlines_.push_back(samples_.star(centre, 40, 6 + samples_.below(8), samples_.maybe(2)));
    Eigen::Affine2d map;
    const std::string transform = samples_.transform(map);
    const Points points = pulled_back(outlines_.back(), map);
    seam_ends_.push_back(centre);
    const std::string layer =
        samples_.one_of({" id='view:" + name + "'", " id='layer-" + name +
                                                        "' ink:groupmode='layer' "
                                                        "ink:label='view:" +
                                                        name + "'"});
    samples_.begin_path();
    const std::string seam =
        "<path" + kind("seam", "#ff0000") +
        " d=" + samples_.quoted(samples_.path({pulled_back({centre}, map)[0], points[0]}, false)) +
        "/>\n";
    const std::string guide = "<line data-kind='none' stroke='#123456' x2='500'/>\n";
    std::string inside = silhouette(points) + seam;
    if (samples_.maybe(2)) inside = guide + inside;
    return "<g" + layer + "><g" + transform + ">\n" + inside + "</g></g>\n";
  }

  test::SvgSamples samples_;
  std::vector<Points> outlines_;
  Points seam_ends_;
  Eigen::Affine2d to_page_ = Eigen::Affine2d::Identity();
  DrawingFileOptions options_;
  std::string page_, text_;
};

double signed_area_of(const Points& points) {
  double twice = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % points.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

double nearest(const Points& points, const Eigen::Vector2d& to) {
  double best = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : points) best = std::min(best, (p - to).norm());
  return best;
}

using LongPerturbedDrawings = test::ScratchFolder;

TEST_F(LongPerturbedDrawings, GiveTheStrokesThatWereDrawn) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    const PerturbedDrawing drawn(seed);
    const auto file = write("drawing.svg", drawn.text());
    DrawingFile read;
    ASSERT_NO_THROW(read = read_drawing(file, drawn.options())) << "seed " << seed << drawn.text();
    for (const ViewKind kind : {ViewKind::front, ViewKind::side}) {
      const View* view = read.drawing.find(kind);
      ASSERT_NE(view, nullptr);
      ASSERT_EQ(view->strokes.size(), 2U) << "seed " << seed << drawn.text();
      const Points expected = drawn.outline(kind), got = view->strokes[0].points;
      const double close = 1e-9 * (1 + expected[0].norm());
      EXPECT_TRUE(view->strokes[0].closed);
      EXPECT_NEAR(signed_area_of(got), std::abs(signed_area_of(expected)), close)
          << "seed " << seed << drawn.text();
      for (const Eigen::Vector2d& p : expected)
        EXPECT_LT(nearest(got, p), close) << "seed " << seed << drawn.text();
      const Stroke& seam = view->strokes[1];
      EXPECT_EQ(seam.kind, StrokeKind::seam);
      EXPECT_LT((seam.points.front() - drawn.seam_end(kind)).norm(), close);
      EXPECT_LT((seam.points.back() - expected[0]).norm(), close);
    }
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace geoprior::sketch
