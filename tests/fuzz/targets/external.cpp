#include <stdexcept>
#include <string>

#include "testbed/external/frame_layout.h"
#include "testbed/formats/mesh/ply_reader.h"
#include "tests/fuzz/allow_error.h"
#include "tests/fuzz/sample_layouts.h"
#include "tests/fuzz/scratch_file.h"
#include "tests/fuzz/targets.h"

namespace geoprior::test {
namespace {

/// What readers promise of a part, which metrics and pictures take for granted.
void require_sound(const Part& part) {
  const auto is_vertex = [&](int v) { return v >= 0 && v < part.points.rows(); };
  bool sound = part.triangles.unaryExpr([&](int v) { return is_vertex(v) ? 1 : 0; }).all();
  for (const std::vector<int>& line : part.lines) {
    for (int v : line) sound = sound && is_vertex(v);
  }
  for (const NamedArray& array : part.arrays) {
    sound = sound && array.values.rows() == part.count(array.on);
  }
  if (!sound) throw std::logic_error("a part was read that has no such vertex or rows");
}

/// Reads three frames of a sheet, one file of which has these bytes.
void read_layout_with(const std::string& mutated, const std::uint8_t* data, std::size_t size) {
  Files layout = sheet_layout();
  layout.at(mutated) = text_of(data, size);
  const ScratchHome home(layout);
  allow_error([&] {
    ExternalOptions options;
    options.frames = ".";
    const ExternalFrames found =
        find_external_frames(options, home.path(), "surface", ProcessScene());
    for (const ExternalFrames::Entry& entry : found.frames) {
      for (const auto& [name, part] : read_external_frame(entry).parts) require_sound(part);
    }
  });
}

}  // namespace

void fuzz_frame_list(const std::uint8_t* data, std::size_t size) {
  read_layout_with("frames.csv", data, size);
}

void fuzz_diagnostics(const std::uint8_t* data, std::size_t size) {
  read_layout_with("diagnostics.csv", data, size);
}

void fuzz_events(const std::uint8_t* data, std::size_t size) {
  read_layout_with("events.csv", data, size);
}

void fuzz_ply_part(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { require_sound(parse_ply_part(text_of(data, size), "fuzz")); });
}

void fuzz_correspondence(const std::uint8_t* data, std::size_t size) {
  const ScratchFile file(".csv", text_of(data, size));
  allow_error([&] { read_correspondence(file.path()); });
}

}  // namespace geoprior::test
