#include "experiments/runner/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "core/error.h"
#include "experiments/formats/atomic_file.h"

namespace geoprior {

Journal::Journal(std::filesystem::path file) : file_(std::move(file)) {
  const bool is_new = !std::filesystem::exists(file_);
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw Error("cannot be opened: " + system_reason(errno), file_.string());
  try {
    lock();
    if (is_new) flush_to_disk(file_.parent_path());
    read();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() { ::close(descriptor_); }

void Journal::lock() {
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  if (errno == EWOULDBLOCK) {
    throw Error("another program is writing this run", file_.parent_path().string(),
                "wait for it, or choose another --out");
  }
  throw Error("cannot be locked: " + system_reason(errno), file_.string());
}

void Journal::read() {
  const std::string text = read_whole_file(file_);
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    try {
      lines_.push_back(journal::from_text(std::string_view(text).substr(begin, end - begin)));
    } catch (const Error& error) {
      // A crash of the machine can leave the last line at its length but without its bytes.
      if (end + 1 == text.size()) break;
      throw Error(error.what(), file_.string() + ":" + std::to_string(lines_.size() + 1));
    }
  }
  if (begin < text.size() && ::ftruncate(descriptor_, static_cast<off_t>(begin)) != 0) {
    throw Error("cannot be repaired: " + system_reason(errno), file_.string());
  }
}

void Journal::append(const journal::Line& line, bool flush) {
  const off_t before = ::lseek(descriptor_, 0, SEEK_END);
  try {
    write_all(descriptor_, journal::to_text(line) + '\n', file_);
  } catch (const Error&) {
    // Half a line would be repaired on resume anyway; this keeps the file readable until then.
    if (::ftruncate(descriptor_, before) != 0) errno = 0;
    throw;
  }
  if (flush && ::fsync(descriptor_) != 0) {
    throw Error("cannot be flushed to the disk: " + system_reason(errno), file_.string());
  }
}

}  // namespace geoprior
