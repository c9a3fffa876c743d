#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace geoprior::toy {

/// What a program left: exit code, standard output, standard error.
struct Outcome {
  int code = 0;
  std::string out;
  std::string err;
};

/// A folder like a clone, with experiments of the toy topics, that goes when the test ends.
class Home {
 public:
  Home() {
    std::string pattern = (std::filesystem::temp_directory_path() / "geoprior-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
    root_ = pattern;
    for (const char* folder : {"experiments/toy-circle", "experiments/toy-pendulum",
                               "results/reference", "results/runs"}) {
      std::filesystem::create_directories(root_ / folder);
    }
  }
  ~Home() {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }
  Home(const Home&) = delete;
  Home& operator=(const Home&) = delete;

  [[nodiscard]] const std::filesystem::path& root() const { return root_; }

  /// Writes a file below the folder and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = root_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
  }

  [[nodiscard]] static std::string read(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  /// Runs a program, that with the toy topics, on this folder; `arguments` as a shell reads them.
  [[nodiscard]] Outcome run(const std::string& arguments,
                            const std::string& program = GEOPRIOR_TOY_PROGRAM) const {
    const auto out = root_ / "stdout.txt", err = root_ / "stderr.txt";
    const std::string command = "GEOPRIOR_HOME='" + root_.string() + "' GEOPRIOR_RUNS= '" +
                                program + "' " + arguments + " > '" + out.string() + "' 2> '" +
                                err.string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
  }

 private:
  std::filesystem::path root_;
};

/// Behind an experiment on the disc: what a figure plots has reference values.
inline const std::string kPlotted = "[figure_view]\nmetrics = [\"radius_error\"]\n";

/// A small experiment on the disc; `polygon_options` is the inside of an inline table.
inline std::string disc_experiment(const std::string& polygon_options = "segments = 16",
                                   const std::string& more = "") {
  return R"(title  = "A disc as a polygon"
figure = ""
topic  = "toy-circle"
[scene]
radius_m = 2.0
motion = { from_deg = 0, to_deg = 90, frames = 3 }
[[variant]]
name = "exact"
method = "exact"
[[variant]]
name = "polygon"
method = "polygon"
role = "ablation"
reference = "exact"
options = { )" +
         polygon_options + " }\n" + more;
}

}  // namespace geoprior::toy
