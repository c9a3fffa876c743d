#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/topics/structure/source_tree.h"

namespace geoprior::test::structure {

/// A function with its body, of a class too; a test is one. Lines count from the first of its
/// declaration to its closing brace, comments and empty lines with them; a lambda counts to the
/// function that it stands in.
struct Function {
  std::string head;  ///< first line of its declaration
  int line = 0;      ///< of that, from 1
  int lines = 0;
};

/// Functions of a source that clang-format has formatted: a body's brace stands behind a space
/// (`int f() {`), that of an initialiser behind a name (`member_{0}`) or a sign of equality.
std::vector<Function> functions_of(std::string_view source);

/// "core/mesh.cpp:12: 71 lines: int f() {" for every function with more lines.
std::vector<std::string> long_functions(const SourceTree& tree, int most);

}  // namespace geoprior::test::structure
