// Pages tell their reader to type `geoprior describe <name>`: every such line works.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "testbed/topic.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> pages() {
  const fs::path root = GEOPRIOR_SOURCE_DIR;
  std::vector<fs::path> found{root / "README.md"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  }
  return found;
}

/// Names that a text tells to describe, without placeholders: "<topic>", and "my-method", which the
/// reader is to write.
std::vector<std::string> described_in(const std::string& text) {
  static const std::regex line("(?:geoprior |`)describe +([A-Za-z0-9][A-Za-z0-9/_-]*)");
  std::vector<std::string> names;
  for (std::sregex_iterator at(text.begin(), text.end(), line), end; at != end; ++at) {
    const std::string name = (*at)[1];
    if (!name.starts_with("my-")) names.push_back(name);
  }
  return names;
}

TEST(DescribedNames, AreSeenInCodeAndText) {
  const std::vector<std::string> expected{"implicit", "sketch/boot", "stroke"};
  EXPECT_EQ(
      described_in("build/release/geoprior describe implicit   # all\n"
                   "`geoprior describe sketch/boot`, `describe stroke`; `describe` of a name; "
                   "geoprior describe <topic>, `geoprior describe my-method --markdown`"),
      expected);
}

using DescribedNamesOfPages = RunTest;

TEST_F(DescribedNamesOfPages, AreKnownToTheProgram) {
  std::map<std::string, fs::path> page_of;
  for (const fs::path& page : pages()) {
    for (const std::string& name : described_in(text_of(page))) page_of.emplace(name, page);
  }
  EXPECT_GE(page_of.size(), 20U) << "a pattern that finds nothing does not pass";
  for (const auto& [name, page] : page_of) {
    ProgramProcess program(
        [&, what = name] {
          return run_as_program({"describe", what}, all_topics());
        },
        folder() / "log");
    EXPECT_EQ(program.wait(), 0) << page.string() << ": describe " << name << "\n"
                                 << text_of(folder() / "log");
  }
}

}  // namespace
}  // namespace geoprior::test
