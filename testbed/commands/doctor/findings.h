#pragma once

#include <string>
#include <vector>

namespace geoprior {

/// One thing of the machine that the program uses.
struct Finding {
  std::string what = {};
  bool required = false;  ///< by the main job, `geoprior run skinning/knee` with its pictures
  bool found = false;
  std::string where = {};       ///< its place and version; of what is missing, what was looked for
  std::string needed_for = {};  ///< one line
  std::string get = {};         ///< how to have it, where it is missing
};

/// The home folder with what lies in it, and the folder that runs are written to.
std::vector<Finding> folder_findings();

/// Whether a picture can be drawn here, and its letters: draws one, in a child process, since a
/// display without OpenGL ends the process that asks it.
std::vector<Finding> picture_findings();

/// The modules of the Python that plots and reports are made with, and of the `python3` in PATH,
/// which may be another: that one starts methods from outside.
std::vector<Finding> python_findings();

/// Programs that are called, or that open what is exported, and what is loaded when it is needed.
std::vector<Finding> program_findings();

}  // namespace geoprior
