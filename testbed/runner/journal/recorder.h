#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/method.h"
#include "testbed/runner/journal/frame_files.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/run_state.h"

namespace geoprior {

/// Writes what a run makes into its folder, each file whole and then logged. A program killed at
/// any moment leaves a folder that holds exactly what its journal says, and perhaps one frame in
/// flight that the next program overwrites. No path leads through a symbolic link below the folder.
class Recorder {
 public:
  /// @param looked_at  parts of frames that are written and not read back
  Recorder(std::filesystem::path folder, Journal& journal, RunState& state,
           std::set<std::string> looked_at = {});

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// Logs a line and applies it to the state.
  void add(const journal::Line& line, bool flush = true);

  /// Writes the parts and tables of a frame: frames/<case>/<variant>/<part>_0000.vtp …
  /// @throws Error  for a name that is no file name, or a file that cannot be written
  std::vector<StoredFile> write_frame(const journal::Place& place, std::size_t index,
                                      const Frame& frame);
  /// Removes files of a frame that is not logged.
  void discard(const std::vector<StoredFile>& files);
  /// Logs an event; the next line that is flushed takes it to the disk.
  /// @throws Error  as require_event_numbers
  void write_event(const journal::Place& place, const Event& event);
  /// @throws Error  when the variant has an artifact of that name
  void write_artifact(const journal::Place& place, const Artifact& artifact);
  /// The state replaces the one before it; `seconds` are those of the run so far.
  void write_checkpoint(const journal::Place& place, const State& state,
                        const journal::Numbers& seconds);
  [[nodiscard]] State read_checkpoint(const journal::CheckpointLine& checkpoint) const;
  /// frames/<case>/<variant>.pvd
  void write_collection(const journal::Place& place);

  /// Drops what cannot be continued: frames and artifacts of the journal past the point to go on
  /// from, and temporary files. No other file is removed. Returns the state to go on from.
  std::optional<State> prepare_resume(const journal::Place& place, bool is_process);
  /// Of a run that is complete; folders that hold something else stay.
  void remove_checkpoints();

  /// Reads back what was recorded.
  [[nodiscard]] const FrameFiles& files() const { return files_; }

 private:
  StoredFile write(const std::filesystem::path& relative, std::string_view bytes);
  void drop(const journal::ResumeLine& keep);
  void remove(const std::filesystem::path& relative);
  void remove_temporary_files(const std::filesystem::path& relative);

  std::filesystem::path folder_;
  FrameFiles files_;
  Journal& journal_;
  RunState& state_;
};

/// @throws Error  naming method, frame, part and point when a position is NaN or infinite
void require_finite(const Frame& frame, std::size_t index, const std::string& method);

}  // namespace geoprior
