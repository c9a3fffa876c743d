#include "testbed/runner/process/peak_memory.h"

#include <gtest/gtest.h>

#include <vector>

#include "testbed/runner/journal/journal.h"

namespace geoprior::test {
namespace {

constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20;

/// Takes memory, writes to every page of it and frees it again.
void take_and_free(std::uint64_t bytes) {
  std::vector<char> memory(bytes, 1);
  const volatile char used = memory[bytes / 2];
  (void)used;
}

std::uint64_t growth(const MemoryUse& use) { return use.peak - use.start; }

/// What the kernel's two readings may be apart from the truth. It counts pages in batches for each
/// processor (`percpu_counter_batch`: 32 or more) and reads the sum without what is in a batch, so
/// a process that moved between two processors misses up to 2 x 31 pages of 4 kB in each reading,
/// as well of its anonymous pages as of its files'. A megabyte holds all of them.
constexpr std::uint64_t kUncounted = kMegabyte;

/// Growth seen while this much is taken and freed, the nearest to it of five tries: meanwhile the
/// kernel may take pages of the program away that were idle, and what grew seems less.
std::size_t seen_growth(std::size_t bytes) {
  std::size_t nearest = 0;
  const auto error = [&](std::size_t seen) { return seen > bytes ? seen - bytes : bytes - seen; };
  for (int i = 0; i < 5; ++i) {
    const PeakMemory memory;
    take_and_free(bytes);
    const std::size_t seen = growth(memory.use().value());
    if (error(seen) < error(nearest)) nearest = seen;
  }
  return nearest;
}

TEST(PeakMemory, SeesAnAllocationOfKnownSizeThatWasFreedAgain) {
  if (!PeakMemory().use()) GTEST_SKIP() << "the kernel does not let a process reset VmHWM";
  const std::size_t seen = seen_growth(64 * kMegabyte);
  EXPECT_GE(seen, 64 * kMegabyte - kUncounted);
  EXPECT_LE(seen, 64 * kMegabyte + kUncounted);
}

// A larger allocation before it is forgotten, also when the library would have kept its pages.
TEST(PeakMemory, ForgetsWhatCameBefore) {
  if (!PeakMemory().use()) GTEST_SKIP() << "the kernel does not let a process reset VmHWM";
  take_and_free(128 * kMegabyte);
  const PeakMemory idle;
  EXPECT_LE(growth(idle.use().value()), kUncounted);
  const std::size_t seen = seen_growth(32 * kMegabyte);
  EXPECT_GE(seen, 32 * kMegabyte - kUncounted);
  EXPECT_LE(seen, 32 * kMegabyte + kUncounted);
}

TEST(PeakMemory, StandsInTheJournalWhereItWasMeasured) {
  journal::EndLine line;
  line.place = {"default", "dense"};
  EXPECT_EQ(journal::to_text(line).find("memory"), std::string::npos);
  EXPECT_FALSE(std::get<journal::EndLine>(journal::from_text(journal::to_text(line))).memory);
  line.memory = MemoryUse{123456, 987654321};
  const auto again = std::get<journal::EndLine>(journal::from_text(journal::to_text(line)));
  EXPECT_EQ(again.memory->start, 123456U);
  EXPECT_EQ(again.memory->peak, 987654321U);
}

}  // namespace
}  // namespace geoprior::test
