// Texts of options: each stands alone in a sorted table, and no header repeats it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "testbed/formats/atomic_file.h"
#include "testbed/joined.h"
#include "testbed/runner/options/listing.h"
#include "testbed/runner/spec/tables.h"
#include "testbed/topic.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

/// Why a text does not stand alone; empty where it does.
///
/// It is a sentence or a noun phrase: it begins with no conjunction, preposition or pronoun, whose
/// noun would be the key or the row above, and it is no fragment that the next row continues. A
/// symbol alone says nothing.
std::string leaning(const std::string& text) {
  static const std::regex begins(
      "^(…|\\.\\.\\.|(and|or|but|nor|then|that|those|these|they|it|its|likewise|ditto|also|"
      "the same|in|on|of|at|to|from|over|under|within|below|above|beyond|by|with|without|towards|"
      "for|after|before|between|through|along|across|about|near|beside|around|inside|outside|"
      "until|against|as|into|per|than)\\b)",
      std::regex::icase);
  static const std::regex ends(
      "(…|\\.\\.\\.|[,:;]|\\b(of|than|under|below|above|after|before) (it|them|that|those)|"
      "\\blikewise)$");
  if (text.size() < 4) return "says too little";
  std::smatch found;
  if (std::regex_search(text, found, begins)) return "begins with '" + found[1].str() + "'";
  if (std::regex_search(text, found, ends)) return "ends with '" + found[0].str() + "'";
  return "";
}

TEST(OptionText, LeaningIsSeen) {
  for (const char* text :
       {"", "E", "and from which it is", "or the whole", "… a disc of it", "a straight line, or …",
        "the same in contact", "of the circle", "along u", "at the start", "its normal",
        "likewise of the tail", "a point of it", "points of the pattern:", "After that"}) {
    EXPECT_NE(leaning(text), "") << text;
  }
  for (const char* text :
       {"time", "bending stiffness along the fibres", "whether the border stays",
        "where suggested cuts lie", "false: quick runs leave the claim out", "0: all",
        "weights below it are dropped", "order in which seams are cut", "offset of the origin",
        "iterations", "Poisson's ratio nu", "Only the last frame is drawn."}) {
    EXPECT_EQ(leaning(text), "") << text;
  }
}

/// The texts of all options, by where they stand: "skinning/implicit", "[[claim]]".
using Texts = std::map<std::string, std::vector<OptionRow>>;

template <class Table>
std::vector<OptionRow> rows_of_table() {
  Table table;
  return list_options([&](OptionVisitor& visitor) { describe(visitor, table); });
}

std::vector<OptionRow> rows_of_set(OptionSet& set) {
  return list_options([&](OptionVisitor& visitor) { set.visit(visitor); });
}

Texts all_texts() {
  Texts texts{{"experiment", rows_of_table<HeaderTable>()},
              {"[[variant]]", rows_of_table<VariantTable>()},
              {"[[sweep]]", rows_of_table<SweepTable>()},
              {"[[claim]]", rows_of_table<ClaimTable>()},
              {"[[study]]", rows_of_table<StudyTable>()},
              {"[timing]", rows_of_table<TimingTable>()},
              {"[check]", rows_of_table<CheckTable>()},
              {"[tolerance]", rows_of_table<ToleranceTable>()},
              {"[figure_view]", rows_of_table<FigureViewTable>()}};
  for (const Topic& topic : all_topics()) {
    texts[topic.name + "/scene"] = rows_of_set(*topic.default_scene());
    for (const MethodEntry& method : topic.methods) {
      texts[topic.name + "/" + method.name] = rows_of_set(*method.default_options());
    }
    for (const TopicCommand& command : topic.commands) {
      texts["geoprior " + command.name] = rows_of_set(*command.default_options());
    }
    for (const TopicFile& file : topic.files) {
      texts[topic.name + "/" + file.name] = file.keys;
    }
  }
  return texts;
}

// A line each text:
//   build/release/tests/test_topics --gtest_filter=OptionTexts.* | grep '^  '
TEST(OptionTexts, StandAlone) {
  std::set<std::string> lines;
  for (const auto& [where, rows] : all_texts()) {
    for (const OptionRow& row : rows) {
      const std::string why = leaning(row.doc);
      if (!why.empty()) lines.insert(where + " " + row.key + ": " + why + ": " + row.doc);
    }
  }
  EXPECT_TRUE(lines.empty()) << lines.size() << " texts lean on their neighbours\n  "
                             << joined(lines, "\n  ");
}

/// Lower case, without the point at the end, one space between words.
std::string plain_text(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  std::string plain = joined(words, " ");
  std::transform(plain.begin(), plain.end(), plain.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (plain.ends_with('.')) plain.pop_back();
  return plain;
}

/// A comment behind a member, on as many lines as it has.
struct MemberComment {
  std::size_t line = 0;
  std::string text;
};

std::vector<MemberComment> member_comments(const std::string& header) {
  const std::string mark = "///< ";
  std::vector<MemberComment> comments;
  std::istringstream in(header);
  std::size_t number = 0;
  bool goes_on = false;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::size_t at = line.find(mark);
    if (at == std::string::npos) {
      goes_on = false;
      continue;
    }
    const std::string text = line.substr(at + mark.size());
    const bool is_alone = line.find_first_not_of(' ') == at;
    if (is_alone && goes_on) {
      comments.back().text += " " + text;
    } else {
      comments.push_back({number, text});
    }
    goes_on = true;
  }
  return comments;
}

/// Comments that say one of the texts to the letter; of headers that describe options.
std::vector<std::string> repetitions(const std::string& header, const std::string& name,
                                     const std::set<std::string>& texts) {
  std::vector<std::string> lines;
  if (header.find("OptionVisitor") == std::string::npos) return lines;
  for (const MemberComment& comment : member_comments(header)) {
    if (!texts.contains(plain_text(comment.text))) continue;
    lines.push_back(name + ":" + std::to_string(comment.line) + ": " + comment.text);
  }
  return lines;
}

TEST(OptionText, ACommentThatRepeatsItIsSeen) {
  const std::string header =
      "struct Options {\n"
      "  double a = 1;  ///< Factor of the  hinge energy.\n"
      "  double b = 1;  ///< factor of the\n"
      "                 ///< plate energy\n"
      "  double c = 1;  ///< factor of nothing\n"
      "};\n";
  const std::set<std::string> texts{"factor of the hinge energy", "factor of the plate energy"};
  EXPECT_THAT(
      repetitions(header + "void describe(OptionVisitor& v, Options& o);\n", "o.h", texts),
      ElementsAre("o.h:2: Factor of the  hinge energy.", "o.h:3: factor of the plate energy"));
  EXPECT_THAT(repetitions(header, "o.h", texts), IsEmpty()) << "no option";
}

TEST(OptionTexts, AreNotRepeatedInHeaders) {
  std::set<std::string> texts;
  for (const auto& [where, rows] : all_texts()) {
    for (const OptionRow& row : rows) texts.insert(plain_text(row.doc));
  }
  const fs::path root = GEOPRIOR_SOURCE_DIR;
  std::set<std::string> lines;
  for (const char* room :
       {"core", "metrics", "models", "baselines", "solvers", "testbed", "experiments"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
      if (entry.path().extension() != ".h") continue;
      const std::string name = fs::relative(entry.path(), root).string();
      for (std::string& line : repetitions(read_whole_file(entry.path()), name, texts)) {
        lines.insert(std::move(line));
      }
    }
  }
  EXPECT_TRUE(lines.empty()) << lines.size() << " comments repeat the text of an option\n  "
                             << joined(lines, "\n  ");
}

}  // namespace
}  // namespace geoprior::test
