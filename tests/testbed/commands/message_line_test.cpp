#include "testbed/commands/message_line.h"

#include <gtest/gtest.h>

namespace geoprior {
namespace {

TEST(MessageLine, LeavesWordsOfAnyLanguage) {
  EXPECT_EQ(message_line("a.toml:3: 'Kniebeuge', 90° (allowed: 0 … 1)"),
            "a.toml:3: 'Kniebeuge', 90° (allowed: 0 … 1)");
}

TEST(MessageLine, NamesControlCharactersInsteadOfObeyingThem) {
  EXPECT_EQ(message_line("a\nb\tc\rd"), "a\\nb\\tc\\x0dd");
  EXPECT_EQ(message_line("\x1b[2J\x7f"), "\\x1b[2J\\x7f") << "would clear the screen";
  EXPECT_EQ(message_line("\xc2\x9b"
                         "2J"),
            "\\xc2\\x9b2J")
      << "the same, as one character";
  EXPECT_EQ(message_line(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(message_line("\u202emlt.a"), "\\xe2\\x80\\xaemlt.a") << "would be read as a.tlm";
}

TEST(MessageLine, ShowsBothEndsOfALongTextAndCutsNoCharacter) {
  std::string text = "file:1: '";
  for (int i = 0; i < 5000; ++i) text += "ü";
  text += "' is no number";
  const std::string shown = message_line(text);
  EXPECT_LT(shown.size(), 1600U);
  EXPECT_TRUE(shown.starts_with("file:1: 'ü"));
  EXPECT_TRUE(shown.ends_with("ü' is no number"));
  EXPECT_NE(shown.find("ü […] ü"), std::string::npos);
}

}  // namespace
}  // namespace geoprior
