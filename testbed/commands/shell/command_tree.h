#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace geoprior {

/// What a shell offers for the value of an option or of an argument.
enum class Offer { nothing, experiments, runs, names, files, folders, choices };

/// An option or an argument of a command, as its help describes it.
struct CommandWord {
  std::vector<std::string> flags;  ///< "-h", "--help"; of an argument none
  std::string value;               ///< what stands for its value, "DIR"; of a flag nothing
  std::string description;
  bool required = false;
  bool repeated = false;  ///< takes any number of values
  Offer offer = Offer::nothing;
  std::vector<std::string> choices;  ///< all values that there are; empty: not a choice

  /// Whether a value follows the flag.
  [[nodiscard]] bool takes_value() const { return !value.empty(); }
};

/// A command, and the commands below it.
struct CommandTree {
  std::string name;
  std::string description;
  std::string footer;  ///< of the program: examples, exit codes
  std::vector<CommandWord> options;
  std::vector<CommandWord> arguments;
  std::vector<CommandTree> commands;
};

/// Everything that a command line says of itself: help, completion and manual cannot differ.
CommandTree command_tree(const CLI::App& app);

}  // namespace geoprior
