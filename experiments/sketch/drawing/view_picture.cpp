#include "experiments/sketch/drawing/view_picture.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "testbed/formats/input_file.h"
#include "testbed/formats/svg/viewport.h"
#include "testbed/runner/number_text.h"

namespace geoprior::sketch {
namespace {

/// A big-endian number; 0 when the bytes end before it does.
unsigned big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  if (at > bytes.size() || bytes.size() - at < count) return 0;
  unsigned value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

std::optional<Eigen::Vector2i> of_sides(unsigned width, unsigned height) {
  constexpr unsigned kMostPixels = 1'000'000;
  if (width == 0 || height == 0 || width > kMostPixels || height > kMostPixels) return std::nullopt;
  return Eigen::Vector2i(static_cast<int>(width), static_cast<int>(height));
}

/// SOF0 … SOF15, without DHT, JPG and DAC, which have their numbers among them.
bool is_frame_header(unsigned marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

std::optional<Eigen::Vector2i> jpeg_size(std::string_view bytes) {
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    if (big_endian(bytes, at, 1) != 0xff) return std::nullopt;
    const unsigned marker = big_endian(bytes, at + 1, 1);
    if (marker == 0xff) {  // filling
      ++at;
      continue;
    }
    if (is_frame_header(marker))
      return of_sides(big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2));
    const unsigned segment = big_endian(bytes, at + 2, 2);
    if (segment < 2) return std::nullopt;
    at += 2 + segment;
  }
  return std::nullopt;
}

std::string head_of(const std::filesystem::path& file, const std::string& where) {
  try {
    return head_of_picture(file);
  } catch (const Error& e) {
    throw Error(std::string("the picture cannot be read: ") + e.what(), where,
                "a PNG or JPEG file");
  }
}

}  // namespace

std::string head_of_picture(const std::filesystem::path& file) {
  constexpr std::size_t kHead = 1 << 20;  // cameras put a small picture and a profile there
  std::string head(kHead, '\0');
  std::ifstream in = open_input_file(file);
  in.read(head.data(), static_cast<std::streamsize>(kHead));
  head.resize(in.gcount());
  return head;
}

std::optional<Eigen::Vector2i> picture_size(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.size() >= 24 && bytes.substr(12, 4) == "IHDR")
    return of_sides(big_endian(bytes, 16, 4), big_endian(bytes, 20, 4));
  if (bytes.starts_with("\xff\xd8")) return jpeg_size(bytes);
  return std::nullopt;
}

Picture view_picture(const SvgImage& image, const std::string& where) {
  const auto pixels = picture_size(image.file.empty() ? image.bytes : head_of(image.file, where));
  if (!pixels) throw Error("the picture is neither PNG nor JPEG", where, "a PNG or JPEG file");
  constexpr double kUpright = 1e-9;
  const double width = image.right.x(), height = image.up.y();
  if (!(width > 0 && height > 0) || std::abs(image.right.y()) > kUpright * width ||
      std::abs(image.up.x()) > kUpright * height)
    throw Error("the picture is turned or mirrored", where, "an upright picture");
  if (image.aspect.covers)
    throw Error("the picture is cut off by its box (slice)", where, "meet, none");
  // Upright boxes of SVG have their y down.
  const SvgBox whole{0, 0, static_cast<double>(pixels->x()), static_cast<double>(pixels->y())};
  const Eigen::Affine2d fit = fit_svg_box(whole, {0, 0, width, height}, image.aspect);
  const Eigen::Vector2d upper_left = fit * Eigen::Vector2d::Zero();
  const Eigen::Vector2d lower_right = fit * Eigen::Vector2d(whole.width, whole.height);
  Picture picture;
  picture.file = image.file.string();
  picture.content = image.bytes;
  picture.origin = image.origin + Eigen::Vector2d(upper_left.x(), height - lower_right.y());
  picture.size = lower_right - upper_left;
  return picture;
}

void replace_picture(Drawing& drawing, const std::filesystem::path& file,
                     const Eigen::Vector2d& page) {
  const std::optional<Eigen::Vector2i> pixels = picture_size(head_of_picture(file));
  if (!pixels) throw Error("the photograph is neither PNG nor JPEG", file.string());
  for (View& view : drawing.views) {
    if (view.kind != ViewKind::photo) {
      throw Error("a photograph goes with a drawing of one view, and " + drawing.name +
                      " has view:" + view_name(view.kind),
                  file.string(), "a layer view:photo");
    }
    const bool has_own = view.picture.size != Eigen::Vector2d::Zero();
    const Eigen::Vector2d size = has_own ? view.picture.size : page;
    const std::string place = has_own ? "its picture" : "its page";
    if (!(size.minCoeff() > 0)) {
      throw Error(
          "the drawing says no size of its page, nor has it a picture: where the "
          "photograph lies is not known",
          drawing.name, "width and height of the page");
    }
    constexpr double kAlike = 0.01;
    const double wide = size.x() / size.y(), seen = 1.0 * pixels->x() / pixels->y();
    if (std::abs(wide / seen - 1) > kAlike) {
      throw Error("the photograph has " + std::to_string(pixels->x()) + " x " +
                      std::to_string(pixels->y()) + " pixels, and does not fit the drawing: " +
                      place + " is " + rounded_text(wide) + " times as wide as high",
                  file.string(), "the picture that was traced over");
    }
    view.picture = {file.string(), {}, has_own ? view.picture.origin : Eigen::Vector2d(0, 0), size};
  }
}

}  // namespace geoprior::sketch
