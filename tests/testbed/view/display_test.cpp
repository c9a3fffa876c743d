// The virtual display that pictures are drawn on.

#include "testbed/view/display.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace geoprior {
namespace {

namespace fs = std::filesystem;

/// Whether this process has a child of that name.
bool has_child(const std::string& name) {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    // "pid (name) state parent …"; empty when no process, or when it has ended meanwhile.
    std::ifstream file(entry.path() / "stat");
    std::string pid, command, state;
    pid_t parent = 0;
    if (file >> pid >> command >> state >> parent && command == "(" + name + ")" &&
        parent == ::getpid()) {
      return true;
    }
  }
  return false;
}

TEST(Display, IsOursAndEndsWithItsObject) {
  const char* before = std::getenv("DISPLAY");
  const std::string old = before != nullptr ? before : "";
  {
    const Display display;
    EXPECT_NE(std::getenv("DISPLAY"), old);
    EXPECT_TRUE(has_child("Xvfb"));
  }
  const char* after = std::getenv("DISPLAY");
  EXPECT_EQ(after != nullptr ? after : "", old);
  // Not its socket: a test beside this one may have taken the number by now.
  EXPECT_FALSE(has_child("Xvfb"));
}

}  // namespace
}  // namespace geoprior
