#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/runner/options/json.h"
#include "testbed/runner/options/listing.h"
#include "testbed/runner/options/toml.h"

namespace geoprior {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

enum class Shape { round, square };
constexpr std::array<std::string_view, 2> kShapes{"round", "square"};

struct Inner {
  double weight = 0.5;
};
void describe(OptionVisitor& v, Inner& o) {
  v.value("weight", o.weight, {.doc = "weight", .unit = "kg", .min = 0, .max = 1});
}

/// One of everything that options can hold.
struct Everything {
  double real = 1.5;
  int integer = 3;
  bool flag = true;
  std::string text = "a";
  std::vector<double> reals{1, 2};
  std::vector<std::string> texts;
  std::optional<double> maybe_real;
  std::optional<int> maybe_integer;
  std::optional<std::string> maybe_text;
  std::array<double, 3> point{0, 0, 1};
  std::array<int, 3> size{1, 1, 1};
  Shape shape = Shape::round;
  std::optional<Shape> maybe_shape;
  Inner inner;
  std::optional<Inner> maybe_inner;
  std::vector<Inner> inners;
};
void describe(OptionVisitor& v, Everything& o) {
  v.value("real", o.real, {.doc = "a length", .unit = "m", .min = 0});
  v.value("integer", o.integer, {.doc = "a count", .min = 0, .max = 10});
  v.value("flag", o.flag, {.doc = "a flag"});
  v.value("text", o.text, {.doc = "a text"});
  v.value("reals", o.reals, {.doc = "numbers", .min = 0});
  v.value("texts", o.texts, {.doc = "texts"});
  v.value("maybe_real", o.maybe_real, {.doc = "may be absent"});
  v.value("maybe_integer", o.maybe_integer, {.doc = "may be absent"});
  v.value("maybe_text", o.maybe_text, {.doc = "may be absent"});
  v.value("point", o.point, {.doc = "a point"});
  v.value("size", o.size, {.doc = "a size", .min = 1});
  describe_choice(v, "shape", o.shape, kShapes, {.doc = "a choice"});
  describe_choice(v, "maybe_shape", o.maybe_shape, kShapes, {.doc = "may be absent"});
  describe_group(v, "inner", o.inner, {.doc = "a table"});
  describe_group(v, "maybe_inner", o.maybe_inner, {.doc = "a table that may be absent"});
  describe_list(v, "inners", o.inners, {.doc = "tables"});
}

Everything read(const std::string& toml) {
  Everything options;
  read_options(parse_toml_text(toml, "file.toml"), "options", options);
  return options;
}

std::string error_of(const std::string& toml) {
  try {
    (void)read(toml);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

nlohmann::ordered_json json_of(Everything options) {
  OptionJsonWriter writer;
  describe(writer, options);
  return writer.json();
}

constexpr const char* kAll = R"(
real = 2
integer = 7
flag = false
text = "b \"quoted\""
reals = [0.5, 1]
texts = ["x", "y"]
maybe_real = 0.25
maybe_integer = 4
maybe_text = "t"
point = [1, 2.5, 3]
size = [4, 5, 6]
shape = "square"
maybe_shape = "round"
inner = { weight = 0.75 }
maybe_inner = { }
inners = [{ weight = 0.1 }, { }]
)";

TEST(OptionToml, ReadsEveryKindAndKeepsDefaultsOfAbsentKeys) {
  const Everything o = read(kAll);
  EXPECT_EQ(o.real, 2);
  EXPECT_EQ(o.integer, 7);
  EXPECT_FALSE(o.flag);
  EXPECT_EQ(o.text, "b \"quoted\"");
  EXPECT_THAT(o.reals, testing::ElementsAre(0.5, 1));
  EXPECT_THAT(o.texts, testing::ElementsAre("x", "y"));
  EXPECT_EQ(o.maybe_real, 0.25);
  EXPECT_EQ(o.maybe_integer, 4);
  EXPECT_EQ(o.maybe_text, "t");
  EXPECT_EQ(o.point, (std::array<double, 3>{1, 2.5, 3}));
  EXPECT_EQ(o.size, (std::array<int, 3>{4, 5, 6}));
  EXPECT_EQ(o.shape, Shape::square);
  EXPECT_EQ(o.maybe_shape, Shape::round);
  EXPECT_EQ(o.inner.weight, 0.75);
  ASSERT_TRUE(o.maybe_inner);
  ASSERT_EQ(o.inners.size(), 2U);
  EXPECT_EQ(o.inners[1].weight, 0.5);
  EXPECT_FALSE(read("").maybe_inner);
  EXPECT_FALSE(read("").maybe_shape);
  EXPECT_EQ(json_of(read("")), json_of(Everything{}));
}

TEST(OptionToml, ResolvedJsonWrittenAsTomlReadsBackAsTheSameOptions) {
  for (const char* text : {kAll, "", "maybe_inner = { weight = 1 }\nreals = []"}) {
    const Everything first = read(text);
    EXPECT_EQ(json_of(read(toml_text(json_of(first)))), json_of(first)) << text;
  }
}

TEST(OptionToml, FalseSwitchesAnOptionalTableOff) {
  EXPECT_FALSE(read("maybe_inner = false").maybe_inner);
}

TEST(OptionToml, UnknownKeyNamesFileLineKeyAndTheOneThatIsMeant) {
  EXPECT_THAT(error_of("flag = true\nintegre = 3"),
              AllOf(HasSubstr("file.toml:2:1"), HasSubstr("options.integre"),
                    HasSubstr("unknown key"), HasSubstr("did you mean 'integer'")));
  EXPECT_THAT(error_of("inner = { wieght = 1 }"),
              AllOf(HasSubstr("options.inner.wieght"), HasSubstr("did you mean 'weight'")));
  EXPECT_THAT(error_of("[[inners]]\n[[inners]]\nother = 1"),
              AllOf(HasSubstr("file.toml:3:1"), HasSubstr("options.inners.1.other")));
}

TEST(OptionToml, WrongTypesAreRefused) {
  EXPECT_THAT(error_of("integer = 2.5"), AllOf(HasSubstr(":1:1"), HasSubstr("an integer")));
  EXPECT_THAT(error_of("real = \"2\""), AllOf(HasSubstr("is a text"), HasSubstr("a number")));
  EXPECT_THAT(error_of("flag = 1"), HasSubstr("true or false"));
  EXPECT_THAT(error_of("text = 1"), HasSubstr("a text in quotes"));
  EXPECT_THAT(error_of("point = [1, 2]"), AllOf(HasSubstr("2 elements"), HasSubstr("3 numbers")));
  EXPECT_THAT(error_of("reals = 1"), HasSubstr("an array of numbers"));
  EXPECT_THAT(error_of("inner = 1"), HasSubstr("a table"));
  EXPECT_THAT(error_of("inners = [1]"), HasSubstr("a table"));
  EXPECT_THAT(error_of("real = 1979-05-27"), HasSubstr("dates"));
}

TEST(OptionToml, NanInfinityAndValuesOutOfRangeAreRefused) {
  EXPECT_THAT(error_of("real = nan"), HasSubstr("not finite"));
  EXPECT_THAT(error_of("maybe_real = -inf"), HasSubstr("not finite"));
  EXPECT_THAT(error_of("real = -1e-9"), HasSubstr("at least 0 m"));
  EXPECT_THAT(error_of("integer = 11"), HasSubstr("between 0 and 10"));
  EXPECT_THAT(error_of("maybe_integer = 3000000000"), HasSubstr("out of range"));
  EXPECT_THAT(error_of("reals = [1, -1]"), HasSubstr("at least 0"));
  EXPECT_THAT(error_of("inner.weight = 2"), HasSubstr("between 0 and 1 kg"));
  EXPECT_THAT(error_of("shape = \"sqare\""),
              AllOf(HasSubstr("round, square"), HasSubstr("did you mean 'square'")));
  EXPECT_THAT(error_of("maybe_shape = \"oval\""), HasSubstr("round, square"));
}

TEST(OptionToml, SyntaxErrorNamesTheLine) {
  EXPECT_THAT(error_of("real = 1\nflag = = 2"), HasSubstr("file.toml:2:"));
}

std::vector<std::string> keys_of(const std::vector<OptionRow>& rows) {
  std::vector<std::string> keys;
  for (const OptionRow& row : rows) keys.push_back(row.key);
  return keys;
}

TEST(OptionListing, ListsEveryKeyWithDefaultRangeAndUnit) {
  Everything options;
  const std::vector<OptionRow> rows = list_options([&](OptionVisitor& v) { describe(v, options); });
  EXPECT_THAT(keys_of(rows),
              testing::IsSupersetOf({"real", "shape", "maybe_shape", "inner.weight",
                                     "maybe_inner.weight", "inners[].weight", "size"}));
  EXPECT_EQ(rows[0].default_value, "1.5");
  EXPECT_EQ(rows[0].range, "at least 0");
  EXPECT_EQ(rows[0].unit, "m");
  EXPECT_THAT(markdown_table(rows), HasSubstr("| `real` | number | `1.5` | at least 0 | m"));
  EXPECT_THAT(markdown_table(rows), HasSubstr("| `maybe_shape` | choice |  | round \\| square |"));
  for (const OptionRow& row : rows) EXPECT_EQ(row.when, "") << row.key;
}

/// Texts that name files and folders.
struct Places {
  std::string drawing;
  std::optional<std::string> bank;
};
void describe(OptionVisitor& v, Places& o) {
  v.value("drawing", o.drawing, {.doc = "a drawing", .required = true, .named = Named::file});
  v.value("bank", o.bank, {.doc = "a bank", .named = Named::folder});
}

TEST(OptionListing, TellsFilesAndFoldersFromTexts) {
  Places options;
  const std::vector<OptionRow> rows = list_options([&](OptionVisitor& v) { describe(v, options); });
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].type, "file");
  EXPECT_EQ(rows[0].default_value, "required");
  EXPECT_EQ(rows[1].type, "folder");
  for (const OptionRow& row : rows) EXPECT_EQ(row.unit, "") << row.key;
}

/// Tags select members, one of them a tag itself.
struct Tagged {
  enum class Kind { ball, box, none };
  enum class Corners { sharp, rounded };
  Kind kind = Kind::box;
  Corners corners = Corners::sharp;
  double radius = 1, width = 2, bevel = 0.1, mass = 3;
};
void describe(OptionVisitor& v, Tagged& o) {
  static constexpr std::array<std::string_view, 3> kKinds{"ball", "box", "none"};
  static constexpr std::array<std::string_view, 2> kCorners{"sharp", "rounded"};
  describe_choice(v, "kind", o.kind, kKinds, {.doc = "of body"});
  if (o.kind == Tagged::Kind::ball) v.value("radius", o.radius, {.doc = "half as wide"});
  if (o.kind == Tagged::Kind::box) {
    v.value("width", o.width, {.doc = "of the box"});
    describe_choice(v, "corners", o.corners, kCorners, {.doc = "of the box"});
    if (o.corners == Tagged::Corners::rounded) v.value("bevel", o.bevel, {.doc = "radius"});
  }
  if (o.kind != Tagged::Kind::none) v.value("mass", o.mass, {.doc = "how heavy", .unit = "kg"});
}
struct Bodies {
  Tagged first;
  std::vector<Tagged> others;
};
void describe(OptionVisitor& v, Bodies& o) {
  describe_group(v, "first", o.first, {.doc = "a body"});
  describe_list(v, "others", o.others, {.doc = "bodies"});
}

TEST(OptionListing, ListsTheMembersOfEveryTagAndNamesTheTags) {
  Bodies options;
  options.first.kind = Tagged::Kind::none;
  const std::vector<OptionRow> rows = list_options([&](OptionVisitor& v) { describe(v, options); });
  // What a default tag selects comes first, the rest where it is walked.
  EXPECT_THAT(keys_of(rows),
              testing::ElementsAre("first", "first.kind", "first.radius", "first.width",
                                   "first.corners", "first.bevel", "first.mass", "others",
                                   "others[].kind", "others[].width", "others[].corners",
                                   "others[].radius", "others[].bevel", "others[].mass"));
  const std::map<std::string, std::string> when{{"kind", ""},
                                                {"radius", "kind = ball"},
                                                {"width", "kind = box"},
                                                {"corners", "kind = box"},
                                                {"bevel", "kind = box, corners = rounded"},
                                                {"mass", "kind = ball | box"}};
  for (const OptionRow& row : rows) {
    const std::size_t dot = row.key.find('.');
    if (dot == std::string::npos) continue;
    EXPECT_EQ(row.when, when.at(row.key.substr(dot + 1))) << row.key;
  }
  EXPECT_EQ(rows[1].default_value, "\"none\"");
  EXPECT_EQ(rows[8].default_value, "\"box\"");
  EXPECT_EQ(rows[7].default_value, "[]");
  EXPECT_EQ(rows[2].meaning(), "[kind = ball] half as wide");
  EXPECT_EQ(options.first.kind, Tagged::Kind::none) << "choices are left as they were";
}

TEST(TomlTree, BareWordsAreTextsAndEverythingElseIsToml) {
  EXPECT_EQ(parse_toml_value("union", "--set").text, "union");
  EXPECT_EQ(parse_toml_value("bulge-in-contact", "--set").text, "bulge-in-contact");
  EXPECT_EQ(parse_toml_value("run:fluid/boat/flip", "--set").text, "run:fluid/boat/flip");
  EXPECT_EQ(parse_toml_value("3", "--set").integer, 3);
  EXPECT_EQ(parse_toml_value("[1, 2]", "--set").items.size(), 2U);
  EXPECT_EQ(parse_toml_value("{ a = 1 }", "--set").kind, TomlNode::Kind::table);
  EXPECT_THROW((void)parse_toml_value("[1, 2", "--set"), Error);
  EXPECT_THROW((void)parse_toml_value("1\nscene = 2", "--set"), Error);
  EXPECT_THROW((void)parse_toml_value("", "--set"), Error);
}

}  // namespace
}  // namespace geoprior
