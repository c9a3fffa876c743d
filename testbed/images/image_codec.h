#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace geoprior {

/// A picture that was opened for reading.
class ImageInput {
 public:
  virtual ~ImageInput() = default;

  [[nodiscard]] virtual int width() const = 0;
  [[nodiscard]] virtual int height() const = 0;
  [[nodiscard]] virtual int channels() const = 0;
  /// Of the channel of that name, or -1.
  [[nodiscard]] virtual int channel(const std::string& name) const = 0;
  /// Entry of the header, or nothing.
  [[nodiscard]] virtual std::string text(const std::string& key) const = 0;
  /// All channels of all pixels, row by row from the top, into width x height x channels values;
  /// bytes are 0 to 255 for 0 to 1.
  /// @return  false where the file is damaged: `error` says how
  virtual bool read(float* values) = 0;
  virtual bool read(std::uint8_t* values) = 0;
  [[nodiscard]] virtual std::string error() const = 0;
};

/// What is written beside the pixels.
struct ImageHeader {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;  ///< their names
  std::vector<std::pair<std::string, std::variant<int, float, std::string>>> entries;
};

/// Pictures in and out, in the formats that OpenImageIO knows. What it refuses it explains in
/// `error`, and returns nothing.
class ImageCodec {
 public:
  virtual ~ImageCodec() = default;

  [[nodiscard]] virtual std::unique_ptr<ImageInput> open(const std::string& file,
                                                         std::string& error) const = 0;
  /// @param bytes   must outlive what is returned
  /// @param format  "png", "jpg" …
  [[nodiscard]] virtual std::unique_ptr<ImageInput> open(std::string_view bytes,
                                                         const std::string& format,
                                                         std::string& error) const = 0;
  /// The same values give the same bytes.
  [[nodiscard]] virtual std::optional<std::vector<std::byte>> encode(const std::string& format,
                                                                     const ImageHeader& header,
                                                                     const float* values,
                                                                     std::string& error) const = 0;
  [[nodiscard]] virtual std::optional<std::vector<std::byte>> encode(const std::string& format,
                                                                     const ImageHeader& header,
                                                                     const std::uint8_t* values,
                                                                     std::string& error) const = 0;
};

/// The codec, from the module of images, which is opened at the first call: OpenImageIO brings
/// 262 shared objects, 0.2 s of processor time and 120 MB, which who needs no picture does not pay.
///
/// The module is the file `geoprior_images.so` in the folder of the running program, or in
/// ../lib/geoprior of it. It stays open.
/// @throws Error  naming that file: missing, cut off, or no module of images; a later call tries
///                again
const ImageCodec& image_codec();

}  // namespace geoprior
