#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "testbed/commands/doctor/findings.h"
#include "testbed/view/child_process.h"
#include "testbed/view/display.h"
#include "testbed/view/panel/panel.h"

namespace geoprior {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr unsigned kSecondsToDraw = 60;

/// A triangle in the middle of a small panel is seen.
bool draws_a_triangle() {
  const Display display;
  Part triangle;
  triangle.points.resize(3, 3);
  triangle.points << -0.4, -0.4, 0, 0.4, -0.4, 0, 0, 0.4, 0;
  triangle.triangles.resize(1, 3);
  triangle.triangles << 0, 1, 2;
  constexpr int kSize = 32;
  const Picture picture = draw_panel({{&triangle}, {}, {}}, {}, {}, kSize, kSize);
  return picture.at(kSize / 2, kSize / 2) != Rgb{255, 255, 255};
}

/// Runs in the child, which nobody hears.
[[noreturn]] void end_after_drawing() {
  ::alarm(kSecondsToDraw);
  const int silent = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(silent, stream);
  try {
    ::_exit(draws_a_triangle() ? 0 : 1);
  } catch (...) {
    ::_exit(1);
  }
}

bool child_draws() {
  const pid_t child = ::fork();
  if (child == 0) end_after_drawing();
  int status = 0;
  while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string name_of_display() {
  if (const auto xvfb = find_program("Xvfb")) return *xvfb;
  const char* display = std::getenv("DISPLAY");
  if (display != nullptr && *display != '\0') return "DISPLAY=" + std::string(display);
  return "no Xvfb, and DISPLAY is not set";
}

}  // namespace

std::vector<Finding> picture_findings() {
  const bool draws = child_draws();
  const std::string display = name_of_display();
  std::error_code ignored;
  return {{"display", true, draws, draws ? display + " draws" : display + ": draws no triangle",
           "figure.png, videos", "apt-get install xvfb libgl1-mesa-dri"},
          {"font", false, std::filesystem::is_regular_file(kFont, ignored), kFont,
           "letters of pictures: degrees and Greek", "apt-get install fonts-dejavu-core"}};
}

}  // namespace geoprior
