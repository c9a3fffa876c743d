#include "experiments/sketch/drawing/picture_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/formats/input_file.h"
#include "testbed/images/image_codec.h"

namespace geoprior::sketch {
namespace {

/// Of what is told of the file's contents, in the order of channels: grey, grey and alpha, colour,
/// colour and alpha.
PixelColour over_white(const std::uint8_t* value, int channels) {
  const bool grey = channels < 3;
  const int alpha = channels == 2 ? value[1] : channels > 3 ? value[3] : 255;
  PixelColour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const int shown = value[grey ? 0 : c];
    colour[c] = static_cast<std::uint8_t>((shown * alpha + 255 * (255 - alpha) + 127) / 255);
  }
  return colour;
}

PixelImage decoded(ImageInput& input, const std::string& where) {
  const int width = input.width(), height = input.height(), channels = input.channels();
  require_picture_size({width, height}, channels, where);
  const auto count = static_cast<std::size_t>(width) * height;
  std::vector<std::uint8_t> values(count * channels);
  if (channels < 1 || !input.read(values.data()))
    throw Error("the picture cannot be read: " + input.error(), where, "a PNG or JPEG file");
  PixelImage image{width, height, {}};
  image.pixels.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    image.pixels.push_back(over_white(values.data() + i * channels, channels));
  return image;
}

}  // namespace

void require_picture_size(const Eigen::Vector2i& size, int channels, const std::string& where) {
  constexpr int kOurs = 3;
  const double bytes = static_cast<double>(size.x()) * size.y() * (channels + kOurs);
  if (bytes <= kMostPictureBytes) return;
  throw Error("the picture has " + std::to_string(size.x()) + " x " + std::to_string(size.y()) +
                  " pixels, " + bytes_text(bytes) + " in memory",
              where, "at most " + bytes_text(kMostPictureBytes) + ": make it smaller");
}

PixelImage read_picture(const Picture& picture) {
  const std::string where = picture.file.empty() ? "the drawing's picture" : picture.file;
  if (picture.file.empty() && picture.content.empty())
    throw Error("has no picture to take colours from", "view:photo", "an image in its layer");
  std::unique_ptr<ImageInput> input;
  std::string error;
  if (picture.file.empty()) {
    const bool png = picture.content.starts_with("\x89PNG");
    input = image_codec().open(picture.content, png ? "png" : "jpg", error);
  } else {
    require_regular_file(picture.file);
    input = image_codec().open(picture.file, error);
  }
  if (!input) throw Error("the picture cannot be read: " + error, where, "a PNG or JPEG file");
  return decoded(*input, where);
}

std::string png_bytes(const PixelImage& image, double dots_per_metre) {
  ImageHeader header{image.width, image.height, {"R", "G", "B"}, {{"png:compressionLevel", 9}}};
  if (dots_per_metre > 0) {
    const auto resolution = static_cast<float>(dots_per_metre);
    header.entries.emplace_back("ResolutionUnit", "m");
    header.entries.emplace_back("XResolution", resolution);
    header.entries.emplace_back("YResolution", resolution);
  }
  std::string error;
  const auto* const values = reinterpret_cast<const std::uint8_t*>(image.pixels.data());
  const auto bytes = image_codec().encode("png", header, values, error);
  if (!bytes) throw Error("a picture could not be encoded: " + error);
  return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

}  // namespace geoprior::sketch
