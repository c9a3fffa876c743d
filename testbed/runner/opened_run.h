#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// What becomes of a file whose checksum is not the recorded one.
enum class Unverified {
  refused,
  used  ///< and told on stderr, one line a file (`--force`)
};

/// Throws Error naming the file unless its bytes have this SHA-256.
void require_recorded(const std::filesystem::path& file, const std::string& sha256);

/// SHA-256 of the run.h5 that finished the run, by the last line of its journal; absent when the
/// run is unfinished, or has no journal, or that of an earlier version.
std::optional<std::string> recorded_result(const std::filesystem::path& run_folder);

/// Hash of the specification that the journal of a run begins with; absent without one.
std::optional<std::string> recorded_hash(const std::filesystem::path& run_folder);

/// A finished run that is read: run.h5 is what the journal says, and the files are what run.h5
/// says.
class OpenedRun {
 public:
  /// @throws Error  naming the file that is missing, damaged or another than the recorded one
  explicit OpenedRun(std::filesystem::path folder, Unverified unverified = Unverified::refused);

  /// A run whose record is at hand.
  OpenedRun(std::filesystem::path folder, RunRecord record);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const RunRecord& record() const { return record_; }
  [[nodiscard]] Unverified unverified() const { return unverified_; }
  /// A recorded part of a frame. Of a run that need not be what was recorded it is read as a
  /// stranger's.
  /// @throws Error  when it is missing, unreadable, or not what was recorded
  [[nodiscard]] Part part(const StoredFile& stored) const;
  /// Path of a recorded file.
  /// @throws Error  when it is missing, or not what was recorded
  [[nodiscard]] std::filesystem::path file(const StoredFile& stored) const;

 private:
  void verify(const std::filesystem::path& file, const std::string& sha256) const;
  void require_result() const;

  std::filesystem::path folder_;
  Unverified unverified_ = Unverified::refused;
  RunRecord record_;
};

/// Verifies every frame and artifact of a run.
/// @throws Error  naming the first that is missing, or not what was recorded
void require_recorded_files(const OpenedRun& run);
/// … of one variant's frames.
void require_recorded_frames(const OpenedRun& run, const VariantRecord& variant);

}  // namespace geoprior
