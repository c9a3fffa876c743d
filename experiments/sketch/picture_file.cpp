#include "experiments/sketch/picture_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "core/error.h"
#include "testbed/formats/input_file.h"

namespace geoprior::sketch {
namespace {

namespace oiio = OIIO;

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

PixelImage decoded(oiio::ImageInput& input, const std::string& where) {
  const oiio::ImageSpec& spec = input.spec();
  if (static_cast<long long>(spec.width) * spec.height > kMostPicturePixels) {
    throw Error("the picture has " + std::to_string(spec.width) + " x " +
                    std::to_string(spec.height) + " pixels",
                where, "at most " + std::to_string(kMostPicturePixels));
  }
  const int channels = spec.nchannels;
  const auto count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  std::vector<std::uint8_t> values(count * static_cast<std::size_t>(channels));
  if (channels < 1 || !input.read_image(0, 0, 0, channels, oiio::TypeDesc::UINT8, values.data()))
    throw Error("the picture cannot be read: " + input.geterror(), where, "a PNG or JPEG file");
  PixelImage image{spec.width, spec.height, {}};
  image.pixels.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    image.pixels.push_back(
        over_white(values.data() + i * static_cast<std::size_t>(channels), channels));
  return image;
}

}  // namespace

PixelImage read_picture(const Picture& picture) {
  const std::string where = picture.file.empty() ? "the drawing's picture" : picture.file;
  if (picture.file.empty() && picture.content.empty())
    throw Error("has no picture to take colours from", "view:photo", "an image in its layer");
  std::unique_ptr<oiio::Filesystem::IOMemReader> memory;
  std::unique_ptr<oiio::ImageInput> input;
  if (picture.file.empty()) {
    memory = std::make_unique<oiio::Filesystem::IOMemReader>(
        const_cast<char*>(picture.content.data()), picture.content.size());
    const bool png = picture.content.starts_with("\x89PNG");
    input = oiio::ImageInput::open(png ? "picture.png" : "picture.jpg", nullptr, memory.get());
  } else {
    require_regular_file(picture.file);
    input = oiio::ImageInput::open(picture.file);
  }
  if (!input)
    throw Error("the picture cannot be read: " + oiio::geterror(), where, "a PNG or JPEG file");
  return decoded(*input, where);
}

std::string png_bytes(const PixelImage& image, double dots_per_metre) {
  oiio::ImageSpec spec(image.width, image.height, 3, oiio::TypeDesc::UINT8);
  spec.attribute("png:compressionLevel", 9);
  if (dots_per_metre > 0) {
    spec.attribute("ResolutionUnit", "m");
    spec.attribute("XResolution", static_cast<float>(dots_per_metre));
    spec.attribute("YResolution", static_cast<float>(dots_per_metre));
  }
  std::vector<unsigned char> bytes;
  oiio::Filesystem::IOVecOutput memory(bytes);
  const auto output = oiio::ImageOutput::create("png", &memory);
  if (!output) throw Error("OpenImageIO cannot write PNG: " + oiio::geterror());
  if (!output->open("picture.png", spec) ||
      !output->write_image(oiio::TypeDesc::UINT8, image.pixels.data()) || !output->close())
    throw Error("a picture could not be encoded: " + output->geterror());
  return {bytes.begin(), bytes.end()};
}

}  // namespace geoprior::sketch
