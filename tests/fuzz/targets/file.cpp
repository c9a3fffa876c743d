#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "experiments/details/scene/position_file.h"
#include "experiments/fluid/scene/exr_maps.h"
#include "experiments/fluid/scene/feature_files.h"
#include "experiments/paper/scene/svg_pattern.h"
#include "experiments/sketch/drawing/drawing_file.h"
#include "testbed/formats/svg/document.h"
#include "testbed/formats/wav_file.h"
#include "testbed/runner/journal/run_file.h"
#include "tests/fuzz/allow_error.h"
#include "tests/fuzz/scratch_file.h"
#include "tests/fuzz/targets.h"
#include "tests/testbed/formats/octahedron.h"

namespace geoprior::test {
namespace {

using Reader = std::function<void(const std::filesystem::path&)>;

void read_as_file(const std::uint8_t* data, std::size_t size, const char* extension,
                  const Reader& read) {
  const ScratchFile file(extension, text_of(data, size));
  allow_error([&] { read(file.path()); });
}

}  // namespace

void fuzz_points(const std::uint8_t* data, std::size_t size) {
  static const TriMesh surface = octahedron();
  read_as_file(data, size, ".csv", [](const std::filesystem::path& file) {
    constexpr double kAnywhere = 1e300;
    std::vector<std::string> warnings;
    details::details_of_file(file, surface, kAnywhere, warnings);
  });
}

void fuzz_svg(const std::uint8_t* data, std::size_t size) {
  read_as_file(data, size, ".svg", [](const std::filesystem::path& file) {
    paper::SvgPatternOptions only_path;
    std::vector<std::string> notes;
    allow_error([&] { paper::read_svg_pattern(file, only_path, notes); });
    paper::SvgPatternOptions named;
    named.path = "a";
    named.unit = paper::SvgScale::page;
    paper::read_svg_pattern(file, named, notes);
  });
}

void fuzz_sketch(const std::uint8_t* data, std::size_t size) {
  read_as_file(data, size, ".svg", [](const std::filesystem::path& file) {
    allow_error([&] { read_svg_document(file, {}); });
    sketch::read_drawing(file, {});
  });
}

void fuzz_exr(const std::uint8_t* data, std::size_t size) {
  read_as_file(data, size, ".exr",
               [](const std::filesystem::path& file) { fluid::read_exr_maps({file}); });
}

void fuzz_wav(const std::uint8_t* data, std::size_t size) {
  read_as_file(data, size, ".wav", [](const std::filesystem::path& file) {
    std::vector<std::string> notes;
    read_wav(file, notes);
  });
}

void fuzz_run_file(const std::uint8_t* data, std::size_t size) {
  read_as_file(data, size, ".h5", read_run_file);
}

void fuzz_feature_library(const std::uint8_t* data, std::size_t size) {
  read_as_file(data, size, ".h5", fluid::read_feature_library);
}

}  // namespace geoprior::test
