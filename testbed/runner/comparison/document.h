#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/comparison/comparison.h"

namespace geoprior {

/// How a row or a verdict is meant.
enum class Tone { plain, good, bad };

/// A table of plain texts; what is written for a page is escaped there (pages.h).
struct DocumentTable {
  struct Row {
    std::vector<std::string> cells;
    Tone tone = Tone::plain;
  };
  std::vector<std::string> head;
  std::vector<Row> rows;
};

/// figure.png of a run.
struct DocumentPicture {
  std::string caption;
  std::optional<std::filesystem::path> file;  ///< absent: `caption` says how it is made
};

struct DocumentSection {
  std::string heading;
  std::vector<std::string> paragraphs;  ///< above the table
  DocumentTable table;
  std::vector<DocumentPicture> pictures;
};

/// What is said of two runs: the same for the terminal, Markdown and HTML.
struct ComparisonDocument {
  std::string title;
  std::string verdict;  ///< one sentence
  Tone tone = Tone::plain;
  std::vector<DocumentSection> sections;
};

/// "worse", "lost", "better", "changed".
std::string text_of(Change change);

/// "lower is better", "closer to 1 is better", "-".
std::string direction_words(const ValueChange& value);

ComparisonDocument describe_comparison(const RunComparison& comparison, const OpenedRun& before,
                                       const OpenedRun& after);

}  // namespace geoprior
