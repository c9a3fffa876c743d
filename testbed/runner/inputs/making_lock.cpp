#include "testbed/runner/inputs/making_lock.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/system_reason.h"
#include "testbed/runner/run_folder.h"

namespace geoprior {
namespace {

std::filesystem::path making_file() { return runs_root() / ".making"; }

/// 60 bits: offsets are signed.
std::int64_t byte_of(const std::string& hash) {
  return std::stoll(hash.substr(0, 15), nullptr, 16);
}

}  // namespace

MakingLock::MakingLock(const std::string& hash) : byte_(byte_of(hash)) {
  make_folders(std::filesystem::absolute(runs_root()));
  descriptor_ = ::open(making_file().c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  if (descriptor_ < 0) {
    throw Error("cannot be opened: " + system_reason(errno), making_file().string());
  }
}

MakingLock::~MakingLock() { ::close(descriptor_); }

bool MakingLock::try_lock() {
  struct flock range {};
  range.l_type = F_WRLCK;
  range.l_whence = SEEK_SET;
  range.l_start = byte_;
  range.l_len = 1;
  if (::fcntl(descriptor_, F_OFD_SETLK, &range) == 0) return true;
  if (errno == EAGAIN || errno == EACCES) return false;
  throw Error("cannot be locked: " + system_reason(errno), making_file().string());
}

}  // namespace geoprior
