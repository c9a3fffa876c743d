#include "testbed/runner/recorder.h"

#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/vtk_files.h"
#include "testbed/runner/frame_table.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/sha256.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kNumberWidth = 5;  // "_0000", and more digits past 9999

void require_file_name(const std::string& name, const char* what) {
  const bool fine = !name.empty() && name.front() != '.' &&
                    name.find_first_not_of(
                        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                        "0123456789_-.+=") == std::string::npos;
  if (!fine) {
    throw Error(std::string("the name of ") + what + " is no file name: '" + name + "'", "",
                "letters, digits and _ - . + =");
  }
}

std::string numbered(const std::string& name, std::size_t index) {
  char number[24];
  std::snprintf(number, sizeof number, "_%04zu", index);
  return name + number;
}

/// "surface" of "surface_0012.vtp".
std::string without_number(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t at = stem.rfind('_');
  if (at == std::string::npos || stem.size() - at < kNumberWidth) {
    throw Error("is no file of a frame", file.string());
  }
  return stem.substr(0, at);
}

fs::path folder_of(const char* room, const journal::Place& place) {
  return fs::path(room) / place.case_name / place.variant;
}

}  // namespace

void require_finite(const Frame& frame, std::size_t index, const std::string& method) {
  const std::string where = "method '" + method + "', frame " + std::to_string(index);
  if (!std::isfinite(frame.parameter)) throw Error("the parameter is not finite", where);
  for (const auto& [name, part] : frame.parts) {
    if (part.points.allFinite()) continue;
    for (Eigen::Index i = 0; i < part.points.rows(); ++i) {
      if (part.points.row(i).allFinite()) continue;
      throw Error("a position is not finite", where + " (parameter " +
                                                  number_text(frame.parameter) + "), part '" +
                                                  name + "', point " + std::to_string(i));
    }
  }
}

Recorder::Recorder(fs::path folder, Journal& journal, RunState& state)
    : folder_(std::move(folder)), journal_(journal), state_(state) {}

void Recorder::add(const journal::Line& line, bool flush) {
  journal_.append(line, flush);
  state_.apply(line);
}

StoredFile Recorder::write(const fs::path& relative, std::string_view bytes) {
  write_file_atomically(folder_ / relative, bytes);
  return {relative.string(), sha256(bytes)};
}

std::vector<StoredFile> Recorder::write_frame(const journal::Place& place, std::size_t index,
                                              const Frame& frame) {
  const fs::path relative = folder_of("frames", place);
  make_folders(folder_ / relative);
  std::vector<StoredFile> files;
  for (const auto& [name, part] : frame.parts) {
    require_file_name(name, "a part");
    files.push_back(write(relative / (numbered(name, index) + part_extension(part)),
                          part_to_vtk_xml(part, frame.parameter)));
  }
  for (const auto& [name, table] : frame.tables) {
    require_file_name(name, "a table");
    files.push_back(write(relative / (numbered(name, index) + ".csv"), table_to_csv(table)));
  }
  return files;
}

void Recorder::write_artifact(const journal::Place& place, const Artifact& artifact) {
  require_file_name(artifact.name, "an artifact");
  const fs::path relative = folder_of("artifacts", place) / artifact.name;
  for (const StoredFile& file : state_.variant_of(place).record.artifacts) {
    if (file.name == relative) throw Error("is written twice", "artifact '" + artifact.name + "'");
  }
  make_folders((folder_ / relative).parent_path());
  const std::string_view bytes(reinterpret_cast<const char*>(artifact.bytes.data()),
                               artifact.bytes.size());
  add(journal::ArtifactLine{place, write(relative, bytes)});
}

void Recorder::write_checkpoint(const journal::Place& place, const State& state,
                                const journal::Numbers& seconds) {
  const VariantState& variant = state_.variant_of(place);
  const std::optional<journal::CheckpointLine> before = variant.checkpoint;
  const VariantRecord& record = variant.record;
  journal::CheckpointLine line{
      place, {}, record.frames.size(), record.events.size(), record.artifacts.size(), seconds,
  };
  // Two names in turn: the last checkpoint stays whole until its successor is logged.
  const bool first = before && before->file.name.ends_with("a.state");
  const fs::path relative = folder_of("checkpoints", place) / (first ? "b.state" : "a.state");
  make_folders((folder_ / relative).parent_path());
  line.file = write(relative, {reinterpret_cast<const char*>(state.data()), state.size()});
  add(line);
  if (before) fs::remove(folder_ / before->file.name);
}

State Recorder::read_checkpoint(const journal::CheckpointLine& checkpoint) const {
  const fs::path file = folder_ / checkpoint.file.name;
  const std::string bytes = read_whole_file(file);
  if (sha256(bytes) != checkpoint.file.sha256) {
    throw Error("is damaged: its checksum is not the one in the journal", file.string());
  }
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  return {begin, begin + bytes.size()};
}

void Recorder::write_collection(const journal::Place& place) {
  const VariantRecord& record = state_.variant_of(place).record;
  const fs::path folder = fs::path("frames") / place.case_name;
  std::vector<PvdEntry> entries;
  for (const FrameRecord& frame : record.frames) {
    for (const StoredFile& file : frame.files) {
      const fs::path name(file.name);
      if (name.extension() == ".csv") continue;
      entries.push_back(
          {frame.parameter, name.lexically_relative(folder).string(), without_number(name)});
    }
  }
  make_folders(folder_ / folder);
  write_file_atomically(folder_ / folder / (place.variant + ".pvd"), pvd_text(entries));
}

std::optional<State> Recorder::prepare_resume(const journal::Place& place, bool is_process) {
  const VariantState& variant = state_.variant_of(place);
  const std::optional<journal::CheckpointLine> checkpoint = variant.checkpoint;
  const VariantRecord& record = variant.record;
  if (is_process) {
    const journal::ResumeLine keep{place, checkpoint ? checkpoint->frames : 0,
                                   checkpoint ? checkpoint->events : 0,
                                   checkpoint ? checkpoint->artifacts : 0};
    // A line for every resumption from a checkpoint, whether or not it drops anything: the time of
    // the next frame includes reading the state, and this is what tells.
    if (checkpoint || keep.frames != record.frames.size() || keep.events != record.events.size() ||
        keep.artifacts != record.artifacts.size()) {
      add(keep);
    }
  }
  std::set<std::string> keep;
  for (const FrameRecord& frame : record.frames) {
    for (const StoredFile& file : frame.files) keep.insert(file.name);
  }
  for (const StoredFile& file : record.artifacts) keep.insert(file.name);
  if (checkpoint) keep.insert(checkpoint->file.name);
  for (const char* room : {"frames", "artifacts", "checkpoints"}) {
    remove_unlisted(folder_, folder_of(room, place), keep);
  }
  if (!checkpoint) return std::nullopt;
  return read_checkpoint(*checkpoint);
}

Frame Recorder::read_frame(const VariantRecord& variant, std::size_t index,
                           const std::optional<std::set<std::string>>& parts) const {
  const FrameRecord& record = variant.frames.at(index);
  Frame frame;
  frame.parameter = record.parameter;
  for (const StoredFile& file : record.files) {
    const fs::path path = folder_ / file.name;
    const std::string name = without_number(path);
    if (parts && !parts->contains(name)) continue;
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
