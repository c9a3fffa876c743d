#include "testbed/runner/peak_memory.h"

#include <gtest/gtest.h>

#include <vector>

#include "testbed/runner/journal.h"

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

// Pages of 4 kB, and what else the process may touch meanwhile: a quarter of a megabyte.
TEST(PeakMemory, SeesAnAllocationOfKnownSizeThatWasFreedAgain) {
  if (!PeakMemory().use()) GTEST_SKIP() << "the kernel does not let a process reset VmHWM";
  const std::size_t seen = seen_growth(64 * kMegabyte);
  EXPECT_GE(seen, 64 * kMegabyte - kMegabyte / 4);
  EXPECT_LE(seen, 65 * kMegabyte);
}

// A larger allocation before it is forgotten, also when the library would have kept its pages.
TEST(PeakMemory, ForgetsWhatCameBefore) {
  if (!PeakMemory().use()) GTEST_SKIP() << "the kernel does not let a process reset VmHWM";
  take_and_free(128 * kMegabyte);
  const PeakMemory idle;
  EXPECT_LE(growth(idle.use().value()), kMegabyte);
  const std::size_t seen = seen_growth(32 * kMegabyte);
  EXPECT_GE(seen, 32 * kMegabyte - kMegabyte / 4);
  EXPECT_LE(seen, 33 * kMegabyte);
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
