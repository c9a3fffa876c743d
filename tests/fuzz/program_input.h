#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/fuzz/scratch_home.h"

namespace geoprior::test {

/// The command that reads an input, and what it needs beside it.
struct ReadingCommand {
  std::vector<std::string> arguments;
  std::string file;     ///< below the home: gets the mutated bytes
  std::string program;  ///< executable that knows the topics
};

/// What is mutated and where: made once, before the mutations.
struct ProgramInput {
  std::vector<std::string> seeds;
  Files home;
  std::vector<ReadingCommand> commands;  ///< one of them is drawn for a mutation
};

/// A kind of file that the program reads from outside.
struct InputKind {
  std::string name;  ///< in the name of the test
  double share = 1;  ///< of all mutations, relative; small where a command takes long
  std::function<ProgramInput()> make;
};

void PrintTo(const InputKind& kind, std::ostream* out);

std::vector<InputKind> input_kinds();

}  // namespace geoprior::test
