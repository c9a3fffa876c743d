#include "testbed/formats/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <new>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/formats/input_file.h"
#include "testbed/formats/system_reason.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

class Descriptor {
 public:
  Descriptor(const fs::path& file, int flags, mode_t mode = 0, const char* done = "opened")
      : value_(::open(file.c_str(), flags | O_CLOEXEC, mode)) {
    if (value_ >= 0) return;
    throw Error(std::string("cannot be ") + done + ": " + system_reason(errno), file.string());
  }
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int get() const { return value_; }
  /// Network file systems report a failed write only here.
  void close(const fs::path& file) {
    if (::close(std::exchange(value_, -1)) != 0) {
      throw Error("cannot be written: " + system_reason(errno), file.string());
    }
  }

 private:
  int value_;
};

/// Bytes that the file has by its size; 0 for what has none (a pipe, files of /proc).
std::size_t file_bytes(const Descriptor& descriptor, const fs::path& file) {
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) {
    throw Error("cannot be read: " + system_reason(errno), file.string());
  }
  return S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
}

/// Up to `size` bytes; fewer at the end of the file only.
std::size_t read_up_to(const Descriptor& descriptor, char* to, std::size_t size,
                       const fs::path& file) {
  std::size_t have = 0;
  while (have < size) {
    const ssize_t more = ::read(descriptor.get(), to + have, size - have);
    if (more == 0) break;
    if (more < 0 && errno != EINTR) {
      throw Error("cannot be read: " + system_reason(errno), file.string());
    }
    if (more > 0) have += static_cast<std::size_t>(more);
  }
  return have;
}

/// The file's size is asked for first, so that a file that shrinks meanwhile is noticed.
std::string read_all(const Descriptor& descriptor, const fs::path& file) {
  const std::size_t size = file_bytes(descriptor, file);
  require_memory(static_cast<double>(size), static_cast<double>(size), "bytes", file.string());
  std::string text(size, '\0');
  const std::size_t have = read_up_to(descriptor, text.data(), size, file);
  if (have < size) {
    throw Error("ends after " + std::to_string(have) + " of its " + std::to_string(size) + " bytes",
                file.string(), "a file that nobody is writing");
  }
  std::array<char, 1U << 16U> block{};
  while (const std::size_t more = read_up_to(descriptor, block.data(), block.size(), file)) {
    text.append(block.data(), more);
  }
  return text;
}

}  // namespace

void write_all(int descriptor, std::string_view bytes, const fs::path& file) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      throw Error("cannot be written: " + system_reason(errno), file.string());
    }
    bytes.remove_prefix(written);
  }
}

void flush_to_disk(const fs::path& file_or_folder) {
  const Descriptor descriptor(file_or_folder, O_RDONLY);
  // Some file systems refuse to flush a folder (EINVAL): they then need no flush.
  if (::fsync(descriptor.get()) != 0 && errno != EINVAL) {
    throw Error("cannot be flushed to the disk: " + system_reason(errno), file_or_folder.string());
  }
}

PendingFile::PendingFile(fs::path target) : target_(std::move(target)), temporary_(target_) {
  // A pipe or a device would be replaced by a file.
  if (std::error_code missing; fs::exists(target_, missing)) require_regular_file(target_);
  temporary_ += kTemporarySuffix;
  // What stands there is a killed program's, or a link that must not be written through.
  std::error_code ignored;
  if (!fs::is_directory(fs::symlink_status(temporary_, ignored))) fs::remove(temporary_, ignored);
}

PendingFile::~PendingFile() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void PendingFile::commit() {
  flush_to_disk(temporary_);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw Error("cannot be renamed from its temporary name: " + system_reason(errno),
                target_.string());
  }
  committed_ = true;
  const fs::path folder = target_.parent_path();
  flush_to_disk(folder.empty() ? fs::path(".") : folder);
}

void write_file_atomically(const fs::path& file, std::string_view bytes) {
  PendingFile pending(file);
  {
    Descriptor out(pending.temporary(), O_WRONLY | O_CREAT | O_EXCL, 0666);
    write_all(out.get(), bytes, file);
    out.close(file);
  }
  pending.commit();
}

void write_file_atomically(const fs::path& file, std::span<const std::byte> bytes) {
  write_file_atomically(
      file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

bool is_temporary_file(const fs::path& file) {
  return file.filename().string().ends_with(kTemporarySuffix);
}

std::string read_whole_file(const fs::path& file) {
  require_regular_file(file);
  const Descriptor in(file, O_RDONLY, 0, "read");
  try {
    return read_all(in, file);
  } catch (const std::bad_alloc&) {
    throw Error("cannot be read: it does not fit into memory", file.string());
  }
}

std::vector<std::byte> bytes_of_file(const fs::path& file) {
  const std::string text = read_whole_file(file);
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

void make_folders(const fs::path& folder) {
  std::error_code code;
  if (fs::is_directory(folder, code)) return;
  const fs::path parent = folder.parent_path();
  if (!parent.empty() && parent != folder) make_folders(parent);
  fs::create_directory(folder, code);
  if (code) throw Error("folder cannot be made: " + system_reason(code.value()), folder.string());
  if (!parent.empty()) flush_to_disk(parent);
}

}  // namespace geoprior
