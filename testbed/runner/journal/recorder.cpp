#include "testbed/runner/journal/recorder.h"

#include <array>
#include <cmath>
#include <system_error>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/formats/system_reason.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/runner/journal/event_table.h"
#include "testbed/runner/journal/frame_table.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/names.h"
#include "testbed/runner/number_text.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

constexpr const char* kCheckpoints = "checkpoints";
constexpr std::array<const char*, 2> kStates{"a.state", "b.state"};

fs::path folder_of(const char* room, const journal::Place& place) {
  return fs::path(room) / place.case_name / place.variant;
}

/// Of the frames and artifacts, relative to the run folder.
std::set<std::string> files_of(const VariantRecord& record) {
  std::set<std::string> names;
  for (const FrameRecord& frame : record.frames) {
    for (const StoredFile& file : frame.files) names.insert(file.name);
  }
  for (const StoredFile& file : record.artifacts) names.insert(file.name);
  return names;
}

void remove_if_empty(const fs::path& folder) {
  std::error_code stays;
  fs::remove(folder, stays);
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

Recorder::Recorder(fs::path folder, Journal& journal, RunState& state,
                   std::set<std::string> looked_at)
    : folder_(std::move(folder)),
      files_(folder_, std::move(looked_at)),
      journal_(journal),
      state_(state) {}

void Recorder::add(const journal::Line& line, bool flush) {
  journal_.append(line, flush);
  state_.apply(line);
}

StoredFile Recorder::write(const fs::path& relative, std::string_view bytes) {
  const fs::path file = path_below(folder_, relative);
  make_folders(file.parent_path());
  write_file_atomically(file, bytes);
  return {relative.string(), sha256(bytes)};
}

std::vector<StoredFile> Recorder::write_frame(const journal::Place& place, std::size_t index,
                                              const Frame& frame) {
  const fs::path relative = folder_of("frames", place);
  std::vector<StoredFile> files;
  for (const auto& [name, part] : frame.parts) {
    require_name(name, "a part", "frame " + std::to_string(index));
    const auto compression = files_.leaves_out(name) ? Compression::light : Compression::usual;
    files.push_back(write(relative / (stem_of_part(name, index) + part_extension(part)),
                          part_to_vtk_xml(part, frame.parameter, compression)));
  }
  for (const auto& [name, table] : frame.tables) {
    require_name(name, "a table", "frame " + std::to_string(index));
    files.push_back(write(relative / (stem_of_part(name, index) + ".csv"), table_to_csv(table)));
  }
  return files;
}

void Recorder::discard(const std::vector<StoredFile>& files) {
  for (const StoredFile& file : files) remove(file.name);
}

void Recorder::write_event(const journal::Place& place, const Event& event) {
  require_event_numbers(event, "variant '" + place.variant + "', event " +
                                   std::to_string(state_.variant_of(place).record.events.size()));
  add(journal::EventLine{place, event}, false);
}

void Recorder::write_artifact(const journal::Place& place, const Artifact& artifact) {
  require_name(artifact.name, "an artifact", "");
  const fs::path relative = folder_of("artifacts", place) / artifact.name;
  for (const StoredFile& file : state_.variant_of(place).record.artifacts) {
    if (file.name == relative) throw Error("is written twice", "artifact '" + artifact.name + "'");
  }
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
  const bool first = before && before->file.name.ends_with(kStates[0]);
  const fs::path relative = folder_of(kCheckpoints, place) / kStates[first ? 1 : 0];
  line.file = write(relative, {reinterpret_cast<const char*>(state.data()), state.size()});
  add(line);
  if (before) remove(before->file.name);
}

State Recorder::read_checkpoint(const journal::CheckpointLine& checkpoint) const {
  return files_.bytes(checkpoint.file);
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
          {frame.parameter, name.lexically_relative(folder).string(), part_of_file(name)});
    }
  }
  write(folder / (place.variant + ".pvd"), pvd_text(entries));
}

std::optional<State> Recorder::prepare_resume(const journal::Place& place, bool is_process) {
  const VariantState& variant = state_.variant_of(place);
  const std::optional<journal::CheckpointLine> checkpoint = variant.checkpoint;
  const VariantRecord& record = variant.record;
  const std::array<fs::path, 3> folders{folder_of("frames", place), folder_of("artifacts", place),
                                        folder_of(kCheckpoints, place)};
  // Every link is found before the first file goes.
  for (const fs::path& folder : folders) (void)path_below(folder_, folder);
  for (const fs::path& folder : folders) remove_temporary_files(folder);
  if (is_process) {
    const journal::ResumeLine keep{place, checkpoint ? checkpoint->frames : 0,
                                   checkpoint ? checkpoint->events : 0,
                                   checkpoint ? checkpoint->artifacts : 0};
    // A line for every resumption from a checkpoint, whether or not it drops anything: the time of
    // the next frame includes reading the state, and this is what tells.
    if (checkpoint || keep.frames != record.frames.size() || keep.events != record.events.size() ||
        keep.artifacts != record.artifacts.size()) {
      drop(keep);
    }
  }
  if (!checkpoint) return std::nullopt;
  return read_checkpoint(*checkpoint);
}

void Recorder::drop(const journal::ResumeLine& keep) {
  const std::set<std::string> before = files_of(state_.variant_of(keep.place).record);
  add(keep);
  const std::set<std::string> after = files_of(state_.variant_of(keep.place).record);
  for (const std::string& name : before) {
    if (!after.contains(name)) remove(name);
  }
}

void Recorder::remove(const fs::path& relative) {
  const fs::path file = path_below(folder_, relative);
  std::error_code code;
  fs::remove(file, code);
  if (code) throw Error("cannot be removed: " + system_reason(code.value()), file.string());
}

void Recorder::remove_temporary_files(const fs::path& relative) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(path_below(folder_, relative), none)) {
    const fs::path name = entry.path().filename();
    if (is_temporary_file(name) && fs::is_regular_file(entry.symlink_status(none))) {
      remove(relative / name);
    }
  }
}

void Recorder::remove_checkpoints() {
  for (const CaseState& one : state_.cases()) {
    for (const VariantState& variant : one.variants) {
      const journal::Place place{one.record.name, variant.record.name};
      const fs::path folder = folder_of(kCheckpoints, place);
      remove_temporary_files(folder);
      for (const char* name : kStates) remove(folder / name);
      remove_if_empty(path_below(folder_, folder));
    }
    remove_if_empty(path_below(folder_, fs::path(kCheckpoints) / one.record.name));
  }
  remove_if_empty(path_below(folder_, kCheckpoints));
}

}  // namespace geoprior
