#pragma once

#include <cstdint>
#include <string>

namespace geoprior {

/// Held by the program that makes the input of a run, so that another one which needs the same run
/// waits for it. One byte, chosen by the hash of the specification, of the file `.making` in the
/// folder of the runs: it stays, and the lock ends with the program, however that ends.
class MakingLock {
 public:
  /// @param hash  of the specification, in hex digits
  /// @throws Error  naming the file when it cannot be made
  explicit MakingLock(const std::string& hash);
  ~MakingLock();
  MakingLock(const MakingLock&) = delete;
  MakingLock& operator=(const MakingLock&) = delete;

  /// True from when it is ours. @throws Error  where the file system has no locks
  bool try_lock();

 private:
  int descriptor_ = -1;
  std::int64_t byte_;
};

}  // namespace geoprior
