// Foreign text that is nested deeper than any stack.

#include "testbed/formats/text/nesting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "core/error.h"
#include "testbed/formats/gltf/model.h"
#include "testbed/formats/sequence/pvd.h"
#include "testbed/formats/sequence/sidecar.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/spec/toml_tree.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using test::expect_error;

constexpr int kDeep = 100000;
constexpr int kShallow = 50;

std::string repeated(std::string_view text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// A value in so many brackets.
std::string in_brackets(int depth, std::string_view open = "[", std::string_view close = "]",
                        std::string_view inside = "") {
  return repeated(open, depth) + std::string(inside) + repeated(close, depth);
}

TEST(Nesting, OfTomlIsLimited) {
  const auto refuse = [](const std::string& text, const std::string& line) {
    expect_error([&] { (void)parse_toml_text(text, "x.toml"); }, {"x.toml:" + line, "at most 100"});
  };
  refuse("\na = " + in_brackets(kDeep), "2");
  refuse("a = " + in_brackets(kDeep, "{ a = ", " }", "1"), "1");
  refuse("[a" + repeated(".a", kDeep) + "]", "1");
  refuse("[[a" + repeated(" . a", kDeep) + "]]", "1");
  refuse("\n\na" + repeated(".\"a\"", kDeep) + " = 1", "3");
  refuse("x = { a" + repeated(".a", kDeep) + " = 1 }", "1");
  // A text of several lines may end in quotes of its own.
  for (const char* text : {"'''a''''", "'''a'''''", "\"\"\"a\"\"\"\"", "\"\"\"a\"\"\"\"\""}) {
    refuse("y = [" + std::string(text) + ", { a" + repeated(".a", kDeep) + " = 1 }]", "1");
  }
}

TEST(Nesting, OfTomlCountsNoTextsCommentsAndNumbers) {
  const std::string brackets = repeated("[{", kDeep), dots = repeated(".", kDeep);
  const std::string text =
      "# " + brackets + dots + "\na = \"" + brackets + "\\\"" + dots + "\"\nb = '" + brackets +
      dots + "'\nc = \"\"\"\n" + brackets + "\"\n\"\"\"\nd = [" + repeated("1.5, ", kDeep) +
      "1.5]\ne = " + in_brackets(kShallow) + "\nf" + repeated(".f", kShallow) + " = 1\n";
  EXPECT_EQ(parse_toml_text(text, "x.toml").items.size(), 6U);
}

TEST(Nesting, OfJsonIsLimited) {
  const std::string deep = "{\"scale\": " + in_brackets(kDeep) + "}";
  expect_error([&] { (void)parse_sidecar(deep, "x.json"); }, {"x.json, byte 1", "at most 100"});
  expect_error([&] { (void)journal::from_text(deep); }, {"damaged line", "at most 100"});
  std::vector<std::byte> bytes(deep.size());
  std::memcpy(bytes.data(), deep.data(), deep.size());
  expect_error([&] { (void)gltf::parse_gltf(bytes, "x.gltf", false); },
               {"x.gltf, byte", "at most 100"});
  // Shallow enough to be parsed: refused for what it says.
  expect_error([] { (void)parse_sidecar("{\"scale\": " + in_brackets(kShallow) + "}", "x.json"); },
               {"\"scale\" is [[["});
  expect_error([] { (void)parse_sidecar("{\"" + repeated("[\\\"", kDeep) + "\": 1}", "x.json"); },
               {"unknown key"});
}

TEST(Nesting, OfXmlIsLimited) {
  const auto parse = [](const std::string& text) { (void)parse_pvd(text, "x.pvd"); };
  expect_error([&] { parse(in_brackets(kDeep, "<a b='>'>", "</a>")); },
               {"x.pvd, byte", "at most 100"});
  expect_error([&] { parse(repeated("<a>", kDeep)); }, {"x.pvd, byte", "at most 100"});
}

TEST(Nesting, OfXmlCountsNoCommentsAndNoEmptyElements) {
  const std::string text = "<?xml version=\"1.0\"?><!--" + repeated("<a>", kDeep) +
                           "--><VTKFile><Collection>" +
                           repeated("<DataSet timestep=\"0\" file=\"a/b.vtp\"/>", kDeep) +
                           "<![CDATA[" + repeated("<a>", kDeep) + "]]>" +
                           in_brackets(kShallow, "<a>", "</a>") + "</Collection></VTKFile>";
  EXPECT_EQ(parse_pvd(text, "x.pvd").size(), static_cast<std::size_t>(kDeep));
}

}  // namespace
}  // namespace geoprior
