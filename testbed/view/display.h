#pragma once

#include <memory>

namespace geoprior {

/// An X display for as long as it lives: VTK aborts the process without one.
///
/// Starts a virtual server (Xvfb) of its own, also where the user has a display: its software
/// renderer gives the same pixels on every machine. Falls back to the user's display when Xvfb is
/// not installed and that display answers.
/// @throws Error  when there is neither, naming the package to install
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace geoprior
