#include "experiments/fluid/scene/exr_maps.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "core/error.h"
#include "core/limits.h"
#include "experiments/fluid/scene/feature_files.h"
#include "testbed/formats/input_file.h"
#include "testbed/images/image_codec.h"

namespace geoprior::fluid {
namespace {

constexpr std::array<const char*, 4> kChannels{"R", "G", "B", "A"};
constexpr const char* kPrefix = "geoprior:";
/// OpenImageIO writes the time of day unless it is given one: equal maps must be equal bytes.
constexpr const char* kNoDate = "1970:01:01 00:00:00";

/// Numbers as texts, because a header's floats would lose digits.
std::string text_of(std::span<const double> numbers) {
  std::string text;
  std::array<char, 32> one{};
  for (const double x : numbers) {
    std::snprintf(one.data(), one.size(), "%.17g", x);
    text += (text.empty() ? "" : " ") + std::string(one.data());
  }
  return text;
}

ImageHeader header_of(const Feature& feature, std::size_t frame) {
  ImageHeader header{feature.resolution, feature.resolution, {}, {}};
  header.channels.assign(kChannels.begin(), kChannels.end());
  header.entries = {{"compression", "zip"}, {"DateTime", kNoDate}};
  const auto put = [&](const char* name, const std::string& text) {
    header.entries.emplace_back(std::string(kPrefix) + name, text);
  };
  const auto put_one = [&](const char* name, double x) { put(name, text_of(std::span(&x, 1))); };
  put_one("id", feature.id);
  put_one("cell", feature.cell);
  put_one("extent", feature.extent);
  put_one("time", feature.times[frame]);
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> placement = feature.placement[frame].matrix();
  put("placement", text_of(std::span(placement.data(), 16)));
  if (!feature.area.empty()) put_one("area", feature.area[frame]);
  if (!feature.volume.empty()) put_one("volume", feature.volume[frame]);
  put("name", feature.name);
  return header;
}

/// Row of the map that a row of the picture holds.
int map_row(int picture_row, int n) { return n - 1 - picture_row; }

std::vector<float> pixels_of(const MapFrame& map, int n) {
  std::vector<float> pixels;
  pixels.reserve(static_cast<std::size_t>(n) * n * 4);
  for (int row = 0; row < n; ++row) {
    for (int i = 0; i < n; ++i) {
      const Eigen::Index texel = static_cast<Eigen::Index>(map_row(row, n)) * n + i;
      for (int c = 0; c < 3; ++c) pixels.push_back(map.displacement(texel, c));
      pixels.push_back(map.alpha(texel));
    }
  }
  return pixels;
}

std::vector<std::byte> encode(const ImageHeader& header, const std::vector<float>& pixels) {
  std::string error;
  auto bytes = image_codec().encode("exr", header, pixels.data(), error);
  if (!bytes) throw Error("a map could not be encoded: " + error);
  return std::move(*bytes);
}

/// One picture on its way into a feature.
class Picture {
 public:
  explicit Picture(const std::filesystem::path& file) : name_(file.string()) {
    require_regular_file(file);
    std::string error;
    input_ = image_codec().open(name_, error);
    if (!input_) throw Error("is no readable picture: " + error, name_);
    if (input_->width() != input_->height()) throw Error("is not square", name_);
    for (const char* channel : kChannels) {
      if (input_->channel(channel) < 0) {
        throw Error("has no channel " + std::string(channel), name_, "R, G, B, A");
      }
    }
  }

  [[nodiscard]] int size() const { return input_->width(); }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string text(const char* key) const {
    return input_->text(std::string(kPrefix) + key);
  }
  [[nodiscard]] bool has(const char* key) const { return !text(key).empty(); }

  template <std::size_t count>
  [[nodiscard]] std::array<double, count> numbers(const char* key) const {
    std::array<double, count> out{};
    std::istringstream in(text(key));
    in.imbue(std::locale::classic());
    for (double& x : out) {
      if (!(in >> x)) {
        throw Error("has no entry " + std::string(kPrefix) + key, name_,
                    std::to_string(count) + " numbers as text");
      }
    }
    return out;
  }
  [[nodiscard]] double number(const char* key) const { return numbers<1>(key)[0]; }

  [[nodiscard]] int whole_number(const char* key) const {
    const double x = number(key);
    if (x >= 0 && x == std::floor(x) && x <= std::numeric_limits<int>::max()) {
      return static_cast<int>(x);
    }
    throw Error(std::string(kPrefix) + key + " is " + text(key), name_, "a whole number");
  }

  [[nodiscard]] MapFrame map() {
    const int n = size(), channels = input_->channels();
    const std::size_t width = channels;
    require_justified(static_cast<double>(n) * n * channels * sizeof(float));
    std::vector<float> pixels(static_cast<std::size_t>(n) * n * width);
    if (!input_->read(pixels.data())) {
      throw Error("cannot be read: " + input_->error(), name_);
    }
    MapFrame map;
    const Eigen::Index texels = static_cast<Eigen::Index>(n) * n;
    map.displacement.resize(texels, 3);
    map.alpha.resize(texels);
    for (int c = 0; c < 4; ++c) {
      const std::size_t at = input_->channel(kChannels[c]);
      for (Eigen::Index p = 0; p < texels; ++p) {
        const Eigen::Index row = map_row(static_cast<int>(p / n), n);
        const float value = pixels[p * width + at];
        (c < 3 ? map.displacement(row * n + p % n, c) : map.alpha(row * n + p % n)) = value;
      }
    }
    return map;
  }

 private:
  /// Pixels that no compression has in so small a file are not allocated.
  void require_justified(double bytes) const {
    constexpr double kMostCompression = 2000;  // deflate reaches about 1000
    const auto file = static_cast<double>(std::filesystem::file_size(name_));
    if (bytes > kMostCompression * file) {
      throw Error("says that it has " + bytes_text(bytes) + " of pixels in " + bytes_text(file),
                  name_, "a whole picture");
    }
    require_memory(bytes, size(), "texels along an edge", name_);
  }

  std::string name_;
  std::unique_ptr<ImageInput> input_;
};

void add_frame(Feature& feature, Picture& picture) {
  if (feature.times.empty()) {
    feature.id = picture.whole_number("id");
    feature.name = picture.text("name");
    feature.cell = picture.number("cell");
    feature.extent = picture.number("extent");
    feature.resolution = picture.size();
  } else if (picture.size() != feature.resolution) {
    throw Error("is " + std::to_string(picture.size()) + " texels wide", picture.name(),
                std::to_string(feature.resolution) + ", as the first");
  }
  const auto placement = picture.numbers<16>("placement");
  feature.times.push_back(picture.number("time"));
  feature.placement.emplace_back();
  feature.placement.back().matrix() =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(placement.data());
  if (picture.has("area")) feature.area.push_back(picture.number("area"));
  if (picture.has("volume")) feature.volume.push_back(picture.number("volume"));
  feature.maps.push_back(picture.map());
}

}  // namespace

std::vector<Artifact> exr_maps(const Feature& feature, const std::string& stem) {
  if (feature.kind != RegionKind::differential) {
    throw Error("is isolated: it has meshes, no maps", "feature " + std::to_string(feature.id),
                "differential features");
  }
  require_valid(feature, "pictures of maps");
  std::vector<Artifact> pictures;
  for (std::size_t i = 0; i < feature.maps.size(); ++i) {
    std::array<char, 16> number{};
    std::snprintf(number.data(), number.size(), "_%04d.exr", static_cast<int>(i));
    pictures.push_back(
        {stem + number.data(),
         encode(header_of(feature, i), pixels_of(feature.maps[i], feature.resolution))});
  }
  return pictures;
}

Feature read_exr_maps(const std::vector<std::filesystem::path>& files) {
  if (files.empty()) throw Error("there are no pictures to read", "maps", "one or more");
  Feature feature;
  for (const std::filesystem::path& file : files) {
    Picture picture(file);
    add_frame(feature, picture);
  }
  require_valid(feature, files.front().string());
  return feature;
}

}  // namespace geoprior::fluid
