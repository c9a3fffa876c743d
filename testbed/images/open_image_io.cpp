// The module of images: all that is linked to OpenImageIO. image_module.cpp opens it.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstring>

#include "testbed/images/image_codec.h"

namespace geoprior {
namespace {

namespace oiio = OIIO;

class OpenedImage : public ImageInput {
 public:
  OpenedImage(std::unique_ptr<oiio::Filesystem::IOMemReader> memory,
              std::unique_ptr<oiio::ImageInput> input)
      : memory_(std::move(memory)), input_(std::move(input)) {}

  [[nodiscard]] int width() const override { return input_->spec().width; }
  [[nodiscard]] int height() const override { return input_->spec().height; }
  [[nodiscard]] int channels() const override { return input_->spec().nchannels; }
  [[nodiscard]] int channel(const std::string& name) const override {
    return input_->spec().channelindex(name);
  }
  [[nodiscard]] std::string text(const std::string& key) const override {
    return input_->spec().get_string_attribute(key);
  }
  bool read(float* values) override { return read(oiio::TypeDesc::FLOAT, values); }
  bool read(std::uint8_t* values) override { return read(oiio::TypeDesc::UINT8, values); }
  [[nodiscard]] std::string error() const override { return input_->geterror(); }

 private:
  bool read(oiio::TypeDesc type, void* values) {
    return input_->read_image(0, 0, 0, channels(), type, values);
  }

  std::unique_ptr<oiio::Filesystem::IOMemReader> memory_;  // outlives what reads it
  std::unique_ptr<oiio::ImageInput> input_;
};

oiio::ImageSpec spec_of(const ImageHeader& header, oiio::TypeDesc type) {
  oiio::ImageSpec spec(header.width, header.height, static_cast<int>(header.channels.size()), type);
  spec.channelnames = header.channels;
  spec.alpha_channel = spec.channelindex("A");
  for (const auto& [key, value] : header.entries) {
    std::visit([&, &name = key](const auto& x) { spec.attribute(name, x); }, value);
  }
  return spec;
}

class OpenImageIo : public ImageCodec {
 public:
  [[nodiscard]] std::unique_ptr<ImageInput> open(const std::string& file,
                                                 std::string& error) const override {
    return opened(nullptr, oiio::ImageInput::open(file), error);
  }
  [[nodiscard]] std::unique_ptr<ImageInput> open(std::string_view bytes, const std::string& format,
                                                 std::string& error) const override {
    auto memory = std::make_unique<oiio::Filesystem::IOMemReader>(const_cast<char*>(bytes.data()),
                                                                  bytes.size());
    auto input = oiio::ImageInput::open("picture." + format, nullptr, memory.get());
    return opened(std::move(memory), std::move(input), error);
  }
  [[nodiscard]] std::optional<std::vector<std::byte>> encode(const std::string& format,
                                                             const ImageHeader& header,
                                                             const float* values,
                                                             std::string& error) const override {
    return encoded(format, spec_of(header, oiio::TypeDesc::FLOAT), values, error);
  }
  [[nodiscard]] std::optional<std::vector<std::byte>> encode(const std::string& format,
                                                             const ImageHeader& header,
                                                             const std::uint8_t* values,
                                                             std::string& error) const override {
    return encoded(format, spec_of(header, oiio::TypeDesc::UINT8), values, error);
  }

 private:
  static std::unique_ptr<ImageInput> opened(std::unique_ptr<oiio::Filesystem::IOMemReader> memory,
                                            std::unique_ptr<oiio::ImageInput> input,
                                            std::string& error) {
    if (input) return std::make_unique<OpenedImage>(std::move(memory), std::move(input));
    error = oiio::geterror();
    return nullptr;
  }

  static std::optional<std::vector<std::byte>> encoded(const std::string& format,
                                                       const oiio::ImageSpec& spec,
                                                       const void* values, std::string& error) {
    std::vector<unsigned char> bytes;
    oiio::Filesystem::IOVecOutput memory(bytes);
    const auto output = oiio::ImageOutput::create(format, &memory);
    if (!output) {
      error = "OpenImageIO cannot write " + format + ": " + oiio::geterror();
      return std::nullopt;
    }
    if (!output->open("picture." + format, spec) || !output->write_image(spec.format, values) ||
        !output->close()) {
      error = output->geterror();
      return std::nullopt;
    }
    std::vector<std::byte> out(bytes.size());
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
};

}  // namespace
}  // namespace geoprior

/// What the module is opened for.
extern "C" const geoprior::ImageCodec* geoprior_image_codec() {
  static const geoprior::OpenImageIo codec;
  return &codec;
}
