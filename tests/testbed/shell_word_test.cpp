#include "testbed/shell_word.h"

#include <gtest/gtest.h>

namespace geoprior::test {
namespace {

TEST(ShellWord, IsQuotedWhereAShellWouldReadSomethingElse) {
  EXPECT_EQ(shell_word("runs/a-1.toml"), "runs/a-1.toml");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's $HOME"), R"('it'\''s $HOME')");
}

TEST(ShellWord, HoldsNothingThatATerminalObeys) {
  EXPECT_EQ(shell_word("a\nb\tc"), R"($'a\nb\tc')");
  EXPECT_EQ(shell_word("\x1b[31m'\\"), R"($'\x1b[31m\'\\')");
}

TEST(ShellLine, KeepsWordsApart) {
  EXPECT_EQ(shell_line({"python3", "my method.py", "", "-n"}), "python3 'my method.py' '' -n");
  EXPECT_EQ(shell_line({}), "");
}

}  // namespace
}  // namespace geoprior::test
