// Tables as spreadsheets of several countries write them.

#include "testbed/formats/text/csv_table.h"

#include <gtest/gtest.h>

#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using test::expect_error;

class CsvTables : public test::ScratchFolder {
 protected:
  [[nodiscard]] CsvTable table(const std::string& text) const {
    return {write("a.csv", text), {"x", "name"}, {"weight"}};
  }
};

TEST_F(CsvTables, SemicolonsInTheFirstLineAllowDecimalCommas) {
  const CsvTable t = table("x; weight;name\n-1,5;2.5;a,b\n1e3;1,25;c\n");
  ASSERT_EQ(t.rows().size(), 2U);
  EXPECT_EQ(t.number(t.rows()[0], "x"), -1.5);
  EXPECT_EQ(t.number(t.rows()[0], "weight"), 2.5);
  EXPECT_EQ(t.text(t.rows()[0], "name"), "a,b");
  EXPECT_EQ(t.number(t.rows()[1], "x"), 1000);
  EXPECT_EQ(t.number(t.rows()[1], "weight"), 1.25);
  const CsvTable thousands = table("x;name\n1.234,5;a\n");
  expect_error([&] { (void)thousands.number(thousands.rows()[0], "x"); },
               {"a.csv:2", "'1.234,5' is no finite number"});
}

TEST_F(CsvTables, DecimalCommasBetweenCommasAreRefused) {
  expect_error([&] { (void)table("x,name\n0,5,a\n"); },
               {"a.csv:2", "3 cells below 2 columns", "';'"});
  EXPECT_EQ(table("x,name\n0.5,a,,\n").rows().size(), 1U) << "empty cells at the end";
}

TEST_F(CsvTables, OtherColumnsAreReadWhereTheyAreWanted) {
  const auto open = [&](const std::string& text) {
    return CsvTable(write("a.csv", text), {"x"}, {}, CsvTable::Others::read);
  };
  const CsvTable t = open("area_m2;X;\"depth, m\";\n0,5;1;;\n# a word\n;2;3;\n");
  EXPECT_EQ(t.others(), (std::vector<std::string>{"area_m2", "depth, m"}));
  EXPECT_EQ(t.number(t.rows()[0], "area_m2"), 0.5);
  EXPECT_EQ(t.number(t.rows()[0], "depth, m"), std::nullopt);
  EXPECT_EQ(t.number(t.rows()[1], "depth, m"), 3);
  expect_error([&] { (void)open("x,a,A\n"); }, {"a.csv:1", "names the column 'A' twice"});
  EXPECT_TRUE(table("x,name,area\n").others().empty());
}

TEST_F(CsvTables, TabsSeparateWhereNothingElseDoes) {
  const CsvTable t = table("x\tname\tweight\n1.5\ta b\t\n");
  EXPECT_EQ(t.text(t.rows()[0], "name"), "a b");
  EXPECT_EQ(t.number(t.rows()[0], "weight"), std::nullopt);
}

TEST_F(CsvTables, QuotesMayHoldSeparatorsQuotesCommentsAndLineEnds) {
  const CsvTable t =
      table("\"x\",\"name\"\n\"1.5\" , \"a, \"\"b\"\" # c\n;d\" # comment\n2,\"\"\n3,z\n");
  ASSERT_EQ(t.rows().size(), 3U);
  EXPECT_EQ(t.number(t.rows()[0], "x"), 1.5);
  EXPECT_EQ(t.text(t.rows()[0], "name"), "a, \"b\" # c\n;d");
  EXPECT_EQ(t.rows()[2].place, (folder() / "a.csv:5").string()) << "lines inside of quotes count";
  EXPECT_EQ(table("\"x;\",x,name\n0,1,a\n").rows().size(), 1U) << "a quoted ; does not separate";
  expect_error([&] { (void)table("x,name\n1,\"a\n"); }, {"a.csv:2", "not closed"});
  expect_error([&] { (void)table("x,name\n1,\"a\"b\n"); }, {"a.csv:2", "behind its quotes"});
}

TEST_F(CsvTables, EmptyCellsOfOptionalColumnsAreAbsent) {
  const CsvTable t = table("x,name,weight\n1,a,\n2,b, \n3,,1\n,d,1\n");
  EXPECT_EQ(t.number(t.rows()[0], "weight"), std::nullopt);
  EXPECT_EQ(t.text(t.rows()[1], "weight"), std::nullopt);
  expect_error([&] { (void)t.text(t.rows()[2], "name"); }, {"a.csv:4", "has no name"});
  expect_error([&] { (void)t.number(t.rows()[3], "x"); }, {"a.csv:5", "has no x"});
}

TEST_F(CsvTables, NamesOfColumnsAreComparedWithoutCase) {
  const CsvTable t = table("X,NAME,Weight\n1,a,2\n");
  EXPECT_EQ(t.number(t.rows()[0], "weight"), 2);
  EXPECT_EQ(t.text(t.rows()[0], "name"), "a");
  expect_error([&] { (void)table("x,name,X\n1,a,2\n"); }, {"a.csv:1", "'X' twice"});
  expect_error([&] { (void)table("y,name\n1,a\n"); }, {"a.csv:1", "names no column 'x'", "weight"});
}

}  // namespace
}  // namespace geoprior
