#include "testbed/runner/journal/frame_files.h"

#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/runner/journal/frame_table.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/opened_run.h"

namespace geoprior {

namespace fs = std::filesystem;

std::string stem_of_part(const std::string& part, std::size_t frame) {
  char number[24];
  std::snprintf(number, sizeof number, "_%04zu", frame);
  return part + number;
}

std::string part_of_file(const fs::path& file) {
  constexpr std::size_t kNumberWidth = 5;  // "_0000", and more digits past 9999
  const std::string stem = file.stem().string();
  const std::size_t at = stem.rfind('_');
  if (at == std::string::npos || stem.size() - at < kNumberWidth) {
    throw Error("is no file of a frame", file.string());
  }
  return stem.substr(0, at);
}

std::vector<std::byte> FrameFiles::bytes(const StoredFile& stored) const {
  const fs::path file = path_below(folder_, stored.name);
  const std::string bytes = read_whole_file(file);
  if (sha256(bytes) != stored.sha256) {
    throw Error("is damaged: its checksum is not the one in the journal", file.string());
  }
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  return {begin, begin + bytes.size()};
}

std::optional<std::vector<std::byte>> FrameFiles::artifact(const VariantRecord& variant,
                                                           const std::string& name) const {
  for (const StoredFile& file : variant.artifacts) {
    if (fs::path(file.name).filename() == name) return bytes(file);
  }
  return std::nullopt;
}

Frame FrameFiles::frame(const VariantRecord& variant, std::size_t index,
                        const std::optional<std::set<std::string>>& parts) const {
  const FrameRecord& record = variant.frames.at(index);
  Frame frame;
  frame.parameter = record.parameter;
  for (const StoredFile& file : record.files) {
    const fs::path path = path_below(folder_, file.name);
    const std::string name = part_of_file(path);
    if (leaves_out(name) || (parts && !parts->contains(name))) continue;
    require_recorded(path, file.sha256);
    if (path.extension() == ".csv") {
      frame.tables[name] = table_from_csv(read_whole_file(path), path.string());
    } else {
      frame.parts[name] = read_vtk_part(path);
    }
  }
  for (const auto& [name, column] : variant.diagnostics) {
    if (index < column.values.size() && !std::isnan(column.values[index])) {
      frame.diagnostics[name] = column.values[index];
    }
  }
  return frame;
}

}  // namespace geoprior
