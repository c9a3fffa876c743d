#pragma once

#include <string>
#include <string_view>

#include "testbed/runner/comparison/document.h"

namespace geoprior {

/// Text inside of an element or a quoted attribute of HTML.
std::string escaped_html(std::string_view text);

/// Text of a paragraph or a cell of Markdown (GitHub's): nothing in it is markup, HTML or the end
/// of a cell, and it is one line.
std::string escaped_markdown(std::string_view text);

/// The comparison as Markdown, to be pasted into a pull request: at most 40 rows a table, without
/// pictures.
std::string markdown_of(const ComparisonDocument& document);

/// The comparison as one HTML file that needs no other: at most 500 rows a table, the pictures in
/// it. @throws Error  naming a picture that cannot be read
std::string html_of(const ComparisonDocument& document);

}  // namespace geoprior
