#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// A file that is written under a temporary name beside its target and takes the target's name when
/// it is whole. Without `commit` (an exception) the temporary file is removed; kill -9 can leave
/// one (`is_temporary_file`).
class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  /// Flushes the file to the disk, renames it, flushes the folder.
  /// @throws Error  naming the target and the system's reason (disk full, no permission …)
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// Writes a whole file by PendingFile. Folders are not made.
void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);
void write_file_atomically(const std::filesystem::path& file, std::span<const std::byte> bytes);

/// What ends the name of a file that is not whole; no other file of ours ends so.
inline constexpr std::string_view kTemporarySuffix = ".geoprior-tmp";
/// True for the names that PendingFile uses while a file is not whole.
bool is_temporary_file(const std::filesystem::path& file);

/// The bytes of a file. @throws Error naming it.
std::string read_whole_file(const std::filesystem::path& file);
std::vector<std::byte> bytes_of_file(const std::filesystem::path& file);

/// Makes a folder and its parents, flushed to the disk. @throws Error naming it and the reason.
void make_folders(const std::filesystem::path& folder);

/// Writes all bytes to a file descriptor. @throws Error naming `file` and the reason.
void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& file);

/// Flushes a file or folder to the disk. @throws Error naming it and the reason.
void flush_to_disk(const std::filesystem::path& file_or_folder);

}  // namespace geoprior
