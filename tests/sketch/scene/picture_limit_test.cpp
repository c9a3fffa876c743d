// A small file may be a large picture: it is refused by its head, before anything is decoded.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "experiments/sketch/drawing/picture_file.h"
#include "experiments/sketch/scene/scene.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::sketch {
namespace {

using geoprior::test::expect_error;

class LargePicture : public geoprior::test::ScratchFolder {
 protected:
  /// The head of a PNG file of so many pixels, in colour, and a drawing that shows it.
  [[nodiscard]] SketchSceneOptions scene_of(unsigned side) const {
    std::string head = "\x89PNG\r\n\x1a\n";
    head += std::string("\0\0\0\rIHDR", 8);
    for (int k = 0; k < 2; ++k) {
      for (int shift = 24; shift >= 0; shift -= 8) head += static_cast<char>(side >> shift & 0xff);
    }
    write("large.png", head + std::string("\x08\x02\0\0\0", 5));
    SketchSceneOptions options;
    options.drawing =
        write("photo.svg",
              "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='0 0 "
              "100 100'><g id='view:photo'><image href='large.png' width='100' height='100'/>"
              "<path class='border' d='M10 10H90V90H10Z'/></g></svg>")
            .string();
    options.textures = TexturedFileOptions{};
    return options;
  }
};

TEST_F(LargePicture, IsRefusedWhenTheSceneIsLoaded) {
  expect_error([&] { load_sketch_scene(scene_of(10000), folder(), 1); },
               {"large.png", "10000 x 10000 pixels", "600.0 MB in memory", "at most 500.0 MB"});
  EXPECT_NO_THROW(load_sketch_scene(scene_of(7000), folder(), 1));
}

TEST_F(LargePicture, IsNoneWhereNobodyAsksForItsColours) {
  SketchSceneOptions options = scene_of(10000);
  options.textures.reset();
  EXPECT_NO_THROW(load_sketch_scene(options, folder(), 1));
}

// 61 million pixels in colour; with a channel of transparency beside them fewer.
TEST(PictureSize, IsLimitedInBytes) {
  EXPECT_NO_THROW(require_picture_size({9504, 6336}, 3, "camera.jpg"));
  expect_error([] { require_picture_size({8500, 8500}, 4, "logo.png"); }, {"logo.png", "505.8 MB"});
  EXPECT_NO_THROW(require_picture_size({8500, 8500}, 3, "logo.png"));
}

}  // namespace
}  // namespace geoprior::sketch
