// The photograph on the pattern.

#include "solvers/sketch/photo/bake_texture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "experiments/sketch/drawing/picture_file.h"
#include "experiments/sketch/fabrication/textured_files.h"
#include "experiments/sketch/truth/known_view.h"
#include "models/sketch/pattern/make_pattern.h"
#include "solvers/sketch/one_view_process.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;

/// A reconstruction laid flat.
struct FlatObject {
  View view;
  OneViewResult result;
  Pattern pattern;
};

FlatObject flat_object(View view, double snap) {
  FlatObject object;
  OneViewOptions options;
  options.curves.snap = snap;
  object.view = std::move(view);
  object.result = reconstruct_one_view(object.view, options);
  const TexturedSurface& surface = object.result.surface;
  object.pattern = make_pattern(surface.mesh, patch_seams(surface)).pattern;
  return object;
}

FlatObject flat_bag() {
  const KnownObject bag = known_object(KnownShape::bag);
  View view = known_view(bag).view;
  view.picture.size = known_placement(bag).page;
  return flat_object(std::move(view), 0.008);
}

FlatObject flat_tent() {
  SyntheticViewOptions drawn;
  drawn.shape = SyntheticShape::tent;
  View view = synthetic_view(drawn).view;
  view.picture.origin = {-3, -2};
  view.picture.size = {6, 5};
  return flat_object(std::move(view), 0.02);
}

PixelImage uniform_image(int width, int height, const PixelColour& colour) {
  return {width, height, std::vector<PixelColour>(width * height, colour)};
}

/// Red grows with x and green with y, from 0 to 255 over the picture.
PixelImage ramp(int width, int height) {
  PixelImage image = uniform_image(width, height, {0, 0, 0});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y)[0] = static_cast<std::uint8_t>(std::lround(255 * (x + 0.5) / width));
      image.at(x, y)[1] = static_cast<std::uint8_t>(std::lround(255 * (1 - (y + 0.5) / height)));
    }
  }
  return image;
}

const PixelColour& pixel_at(const BakedPattern& baked, const Eigen::Vector2d& place) {
  const Eigen::Vector2d at = baked.grid.pixels_at(place);
  return baked.image.at(static_cast<int>(std::lround(at.x())),
                        static_cast<int>(std::lround(at.y())));
}

/// A square of side 1 at depth 2 before one of side 4 at depth 1, seen by 8 x 8 pixels.
TEST(NearestTriangles, TheNearerOneIsSeen) {
  TriMesh mesh;
  mesh.V.resize(8, 3);
  mesh.V << 0, 0, 1, 4, 0, 1, 4, 4, 1, 0, 4, 1, 1, 1, 2, 2, 1, 2, 2, 2, 2, 1, 2, 2;
  mesh.F.resize(4, 3);
  mesh.F << 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7;
  const NearestTriangles seen = nearest_triangles(mesh, {{0, 0}, 0.5, 8, 8});
  int near = 0;
  for (std::size_t i = 0; i < seen.triangle.size(); ++i) {
    EXPECT_TRUE(seen.covered(i)) << "no cracks";
    near += seen.depth[i] == 2 ? 1 : 0;
    EXPECT_NEAR(seen.weights[i].sum(), 1, 1e-12);
  }
  EXPECT_EQ(near, 4) << "pixels of half a metre in a square metre";
  // Columns 2 and 3, rows 4 and 5 from above: x and y from 1 to 2.
  EXPECT_EQ(seen.depth[4 * 8 + 2], 2);
  EXPECT_EQ(seen.depth[3 * 8 + 2], 1);
}

TEST(BakePattern, OneColourStaysAndIsBledBeyondTheBorder) {
  const FlatObject bag = flat_bag();
  const PixelColour red{200, 10, 30};
  BakeOptions options;
  options.most_side = 300;
  options.bleed = 0;
  const BakedPattern tight =
      bake_pattern(bag.view, uniform_image(90, 90, red), bag.result, bag.pattern, options);
  options.bleed = 3;
  const BakedPattern wide =
      bake_pattern(bag.view, uniform_image(90, 90, red), bag.result, bag.pattern, options);
  const auto count = [&](const BakedPattern& baked) {
    std::size_t reds = 0;
    for (const PixelColour& c : baked.image.pixels) {
      EXPECT_TRUE(c == red || c == (PixelColour{255, 255, 255}));
      reds += c == red ? 1 : 0;
    }
    return reds;
  };
  double area = 0;
  for (const PatternPiece& piece : bag.pattern.pieces) {
    Eigen::MatrixX3d V = Eigen::MatrixX3d::Zero(piece.points.rows(), 3);
    V.leftCols<2>() = piece.points;
    area += triangle_areas(V, piece.triangles).sum();
  }
  const double pixel = tight.grid.pixel * tight.grid.pixel;
  EXPECT_NEAR(static_cast<double>(count(tight)) * pixel, area, 0.01 * area);
  EXPECT_GT(count(wide), count(tight) + 1000) << "three pixels along all borders";
}

// The flap hides part of the front on both sides of the mirror plane; the left gusset is the mirror
// image of the right one; nobody sees the back.
TEST(BakePattern, CountsWhatIsSeenMirroredAndUnseen) {
  const FlatObject bag = flat_bag();
  BakeOptions options;
  options.most_side = 400;
  const BakedPattern baked =
      bake_pattern(bag.view, uniform_image(90, 90, {1, 2, 3}), bag.result, bag.pattern, options);
  EXPECT_NEAR(baked.seen + baked.mirrored + baked.continued + baked.flat, 1, 1e-12);
  EXPECT_GT(baked.seen + baked.continued, 0.3);
  EXPECT_GT(baked.continued, 0);
  EXPECT_GT(baked.flat, 0.3) << "the back alone is a quarter of the pattern";
}

// A tent is convex: every side that is turned to the eye is seen, at the place where it is drawn.
TEST(BakePattern, SeenSidesHaveTheColourOfTheirImage) {
  FlatObject tent = flat_tent();
  tent.result.disagreement = 0;
  const TexturedSurface& surface = tent.result.surface;
  BakeOptions options;
  options.most_side = 800;
  const BakedPattern baked =
      bake_pattern(tent.view, ramp(600, 500), tent.result, tent.pattern, options);
  const Eigen::MatrixX3d normals = triangle_normals(surface.mesh);
  int compared = 0;
  for (const PatternPiece& piece : tent.pattern.pieces) {
    for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
      const int on_surface = piece.surface_triangle[t];
      if (surface.mirror_image[on_surface]) continue;
      if (normals(on_surface, 2) < 0.3) continue;
      Eigen::Vector2d place(0, 0), texture(0, 0);
      for (int k = 0; k < 3; ++k) {
        place += piece.points.row(piece.triangles(t, k)).transpose() / 3;
        texture += surface.texture.row(surface.mesh.F(on_surface, k)).transpose() / 3;
      }
      const PixelColour& colour = pixel_at(baked, place);
      EXPECT_NEAR(colour[0], 255 * texture.x(), 3);
      EXPECT_NEAR(colour[1], 255 * texture.y(), 3);
      ++compared;
    }
  }
  EXPECT_GT(compared, 20);
}

// Triangle t of the kept half and t + n / 2 are mirror images.
TEST(BakePattern, IsSymmetric) {
  const FlatObject tent = flat_tent();
  BakeOptions options;
  options.most_side = 800;
  const BakedPattern baked =
      bake_pattern(tent.view, ramp(600, 500), tent.result, tent.pattern, options);
  const std::size_t n = tent.result.surface.mesh.F.rows();
  std::vector<Eigen::Vector2d> place(n);
  for (const PatternPiece& piece : tent.pattern.pieces) {
    for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
      Eigen::Vector2d middle(0, 0);
      for (int k = 0; k < 3; ++k) middle += piece.points.row(piece.triangles(t, k)).transpose() / 3;
      place[piece.surface_triangle[t]] = middle;
    }
  }
  for (std::size_t t = 0; t < n / 2; ++t) {
    const PixelColour &a = pixel_at(baked, place[t]), &b = pixel_at(baked, place[n / 2 + t]);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(std::abs(int{a[c]} - int{b[c]}), 4);
  }
}

/// A red square in the middle of a green photograph, as large as the drawn object's outline.
PixelImage photo_of_bag(const FlatObject& bag, int pixels, const Eigen::Vector2i& shift) {
  const PixelGrid grid{bag.view.picture.origin, bag.view.picture.size.x() / pixels, pixels, pixels};
  const NearestTriangles seen = nearest_triangles(bag.result.surface.mesh, grid);
  PixelImage photo = uniform_image(pixels, pixels, {40, 160, 90});
  for (int y = 0; y < pixels; ++y) {
    for (int x = 0; x < pixels; ++x) {
      const int i = x - shift.x(), j = y - shift.y();
      if (i >= 0 && j >= 0 && i < pixels && j < pixels && seen.covered(j * pixels + i))
        photo.at(x, y) = {200, 60, 50};
    }
  }
  return photo;
}

/// Share of the texels beside borders that are not the object's red.
/// @param options  of a texture of 500 pixels unless they say its resolution
double foreign_share(const FlatObject& bag, const PixelImage& photo, double disagreement,
                     BakeOptions options = {}) {
  options.most_side = 500;
  OneViewResult result = bag.result;
  result.disagreement = disagreement;
  const BakedPattern baked = bake_pattern(bag.view, photo, result, bag.pattern, options);
  const Part texels = border_texels(baked.image, baked.grid, bag.pattern);
  const auto& colour = texels.require_array("colour", NamedArray::On::points, 3).values;
  EXPECT_GT(colour.rows(), 1000);
  double foreign = 0;
  for (Eigen::Index i = 0; i < colour.rows(); ++i)
    foreign += (colour.row(i) - Eigen::RowVector3d(200, 60, 50)).norm() > 8 ? 1 : 0;
  return foreign / static_cast<double>(colour.rows());
}

// Drawing and photograph differ by two pixels, whichever way: no background on the panels, where
// colours read at the line itself have it. Seven are more than two allow for.
TEST(BakePattern, BackgroundDoesNotBleedOverPanelsOfADrawingThatIsTwoPixelsOff) {
  const FlatObject bag = flat_bag();
  for (const Eigen::Vector2i& shift :
       {Eigen::Vector2i(2, 0), Eigen::Vector2i(0, -2), Eigen::Vector2i(-1, 1)}) {
    const PixelImage photo = photo_of_bag(bag, 240, shift);
    EXPECT_EQ(foreign_share(bag, photo, 2), 0);
    EXPECT_GT(foreign_share(bag, photo, 0), 0.01);
  }
  EXPECT_GT(foreign_share(bag, photo_of_bag(bag, 240, {7, 0}), 2), 0.02);
}

// A pattern that is several times as fine as the photograph is no other.
TEST(BakePattern, BackgroundDoesNotBleedOverAFinePattern) {
  const FlatObject bag = flat_bag();
  BakeOptions fine;
  fine.dpi = 50;
  const PixelImage photo = photo_of_bag(bag, 240, {0, -2});
  EXPECT_EQ(foreign_share(bag, photo, 2, fine), 0);
  EXPECT_GT(foreign_share(bag, photo, 0, fine), 0.01);
}

// Two pixels from the border of a rectangle of 40 x 20 pixels lies all but one of 36 x 16.
TEST(TexturedFiles, TexelsBesideABorderAreCounted) {
  Pattern pattern;
  PatternPiece piece;
  piece.points.resize(4, 2);
  piece.points << 5, 5, 45, 5, 45, 25, 5, 25;
  piece.triangles.resize(2, 3);
  piece.triangles << 0, 1, 2, 0, 2, 3;
  pattern.pieces.push_back(piece);
  const PixelGrid grid{{0, 0}, 1, 50, 30};
  const Part texels = border_texels(uniform_image(50, 30, {1, 2, 3}), grid, pattern);
  EXPECT_EQ(texels.points.rows(), 40 * 20 - 36 * 16);
  EXPECT_EQ(texels.require_array("colour", NamedArray::On::points, 3).values(7, 2), 3);
}

TEST(BakePattern, TooFineAPictureIsRefused) {
  const FlatObject tent = flat_tent();
  BakeOptions options;
  options.dpi = 1200;
  EXPECT_THAT(test::error_of([&] {
                bake_pattern(tent.view, ramp(60, 50), tent.result, tent.pattern, options);
              }),
              HasSubstr("textures.dpi"));
}

// PNG, 11.3.5.3: pixels per metre are four bytes each after the name of the chunk.
TEST(PictureFile, PngSaysItsScaleAndIsReadBackAsItWas) {
  const PixelImage image = ramp(40, 30);
  const std::string bytes = png_bytes(image, 4000);
  const std::size_t at = bytes.find("pHYs");
  ASSERT_NE(at, std::string::npos);
  unsigned per_metre = 0;
  for (std::size_t k = 4; k < 8; ++k)
    per_metre = per_metre << 8 | static_cast<unsigned char>(bytes[at + k]);
  EXPECT_NEAR(per_metre, 4000, 1);
  Picture embedded;
  embedded.content = bytes;
  EXPECT_EQ(read_picture(embedded).pixels, image.pixels);
}

using BrokenPictures = test::ScratchFolder;
TEST_F(BrokenPictures, AreNamed) {
  Picture picture;
  EXPECT_THAT(test::error_of([&] { read_picture(picture); }), HasSubstr("no picture"));
  picture.file = (folder() / "gone.png").string();
  EXPECT_THAT(test::error_of([&] { read_picture(picture); }), HasSubstr("gone.png"));
  picture.file = write("broken.png", "\x89PNG\r\n\x1a\n and no more").string();
  EXPECT_THAT(test::error_of([&] { read_picture(picture); }), HasSubstr("broken.png"));
  const std::string whole = png_bytes(ramp(200, 200));
  picture.file = write("half.png", whole.substr(0, whole.size() / 2)).string();
  EXPECT_THAT(test::error_of([&] { read_picture(picture); }), HasSubstr("half.png"));
}

// Every face of the OBJ has texture coordinates inside the picture, and the files name each other.
TEST(TexturedFiles, ModelRefersToItsTexture) {
  FlatObject bag = flat_bag();
  bag.view.picture.content = png_bytes(ramp(90, 90));
  TexturedFileOptions options;
  options.bake.most_side = 200;
  const TexturedFiles made =
      textured_files(bag.view, read_picture(bag.view.picture), bag.result, bag.pattern, options);
  std::map<std::string, std::string> file;
  for (const FabricationFile& one : made.files) file[one.name] = one.bytes;
  EXPECT_THAT(file.at("model.obj"), HasSubstr("mtllib model.mtl"));
  EXPECT_THAT(file.at("model.mtl"), HasSubstr("map_Kd texture.png"));
  EXPECT_THAT(file.at("textured-pattern.svg"), HasSubstr("href=\"texture.png\""));
  std::istringstream lines(file.at("model.obj"));
  int vertices = 0, coordinates = 0, faces = 0;
  for (std::string line; std::getline(lines, line);) {
    vertices += line.starts_with("v ") ? 1 : 0;
    faces += line.starts_with("f ") ? 1 : 0;
    if (!line.starts_with("vt ")) continue;
    ++coordinates;
    double u = -1, v = -1;
    std::istringstream(line.substr(3)) >> u >> v;
    EXPECT_TRUE(u > 0 && u < 1 && v > 0 && v < 1) << line;
  }
  EXPECT_EQ(vertices, bag.result.surface.mesh.V.rows());
  EXPECT_EQ(faces, bag.result.surface.mesh.F.rows());
  EXPECT_GE(coordinates, vertices);
}

}  // namespace
}  // namespace geoprior::sketch
