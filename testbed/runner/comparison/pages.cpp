#include "testbed/runner/comparison/pages.h"

#include <openssl/evp.h>

#include <algorithm>
#include <cctype>

#include "testbed/formats/atomic_file.h"
#include "testbed/streams.h"

namespace geoprior {
namespace {

constexpr std::size_t kMostMarkdownRows = 40;
constexpr std::size_t kMostHtmlRows = 500;

constexpr const char* kStyle = R"(
body { margin: 0 auto; max-width: 1400px; padding: 32px; color: #1c1f23; background: #fff;
  font: 16px/1.5 "Source Sans 3", "Segoe UI", "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; }
h1 { font-size: 28px; line-height: 1.2; margin: 0 0 8px; }
h2 { font-size: 20px; margin: 36px 0 8px; padding-bottom: 4px; border-bottom: 1px solid #dfe3e8; }
p { margin: 6px 0; max-width: 90ch; color: #5c6570; font-size: 14.5px; }
p.verdict { font-size: 18px; font-weight: 600; color: #1c1f23; }
.good, tr.good td:first-child { color: #1a7f4b; }
.bad, tr.bad td:first-child { color: #b3261e; font-weight: 600; }
p.verdict.good { color: #1a7f4b; } p.verdict.bad { color: #b3261e; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 14.5px; font-variant-numeric: tabular-nums; }
th, td { padding: 5px 16px 5px 0; text-align: left; vertical-align: top;
  border-bottom: 1px solid #dfe3e8; overflow-wrap: anywhere; }
th { font-weight: 600; border-bottom: 1.5px solid #9aa4af; }
tbody tr:hover { background: #f6f8fa; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 16px; }
figure { margin: 8px 0; } figure img { width: 100%; height: auto; border: 1px solid #dfe3e8; }
figcaption { color: #5c6570; font-size: 14px; }
)";

/// The text with `replacement(character)` for each that has one.
template <class Replacement>
std::string replaced(std::string_view text, Replacement replacement) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string other = replacement(i);
    if (other.empty()) {
      out += text[i];
    } else {
      out += other;
    }
  }
  return out;
}

std::string entity_of(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

/// "12 more rows."; empty when all are there.
std::string rows_left_out(const DocumentTable& table, std::size_t most, const std::string& where) {
  if (table.rows.size() <= most) return {};
  return std::to_string(table.rows.size() - most) + " more rows" + where + ".";
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + escaped_markdown(cell) + " |";
  return line + "\n";
}

std::string markdown_table(const DocumentTable& table) {
  if (table.rows.empty()) return {};
  std::string text = markdown_row(table.head) + "|";
  for (std::size_t i = 0; i < table.head.size(); ++i) text += "---|";
  text += "\n";
  for (std::size_t i = 0; i < std::min(table.rows.size(), kMostMarkdownRows); ++i) {
    text += markdown_row(table.rows[i].cells);
  }
  const std::string more = rows_left_out(table, kMostMarkdownRows, " in compare.html");
  return text + (more.empty() ? "" : "\n" + more + "\n") + "\n";
}

std::string markdown_section(const DocumentSection& section) {
  std::string text = "### " + escaped_markdown(section.heading) + "\n\n";
  for (const std::string& paragraph : section.paragraphs) {
    text += escaped_markdown(paragraph) + "\n\n";
  }
  for (const DocumentPicture& picture : section.pictures) {
    text +=
        "- " + escaped_markdown(picture.caption) + (picture.file ? ": in compare.html\n" : "\n");
  }
  return text + (section.pictures.empty() ? "" : "\n") + markdown_table(section.table);
}

std::string html_row(const std::string& tag, const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    line += "<" + tag + ">" + escaped_html(cell) + "</" + tag + ">";
  }
  return line;
}

std::string class_of(Tone tone) {
  return tone == Tone::good ? "good" : tone == Tone::bad ? "bad" : "";
}

std::string html_table(const DocumentTable& table) {
  if (table.rows.empty()) return {};
  std::string text = "<div class=\"scroll\"><table><thead><tr>" + html_row("th", table.head) +
                     "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < std::min(table.rows.size(), kMostHtmlRows); ++i) {
    const DocumentTable::Row& row = table.rows[i];
    text += "<tr class=\"" + class_of(row.tone) + "\">" + html_row("td", row.cells) + "</tr>\n";
  }
  text += "</tbody></table></div>\n";
  const std::string more = rows_left_out(table, kMostHtmlRows, "");
  return more.empty() ? text : text + "<p>" + more + "</p>\n";
}

std::string base64_of(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // it ends with a zero
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                     reinterpret_cast<const unsigned char*>(bytes.data()),
                                     static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

std::string html_picture(const DocumentPicture& picture) {
  const std::string caption = escaped_html(picture.caption);
  std::string text = "<figure>";
  if (picture.file) {
    text += "<img alt=\"" + caption + "\" src=\"data:image/png;base64," +
            base64_of(read_whole_file(*picture.file)) + "\">";
  }
  return text + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string html_section(const DocumentSection& section) {
  std::string text = "<h2>" + escaped_html(section.heading) + "</h2>\n";
  for (const std::string& paragraph : section.paragraphs) {
    text += "<p>" + escaped_html(paragraph) + "</p>\n";
  }
  if (!section.pictures.empty()) {
    text += "<div class=\"pair\">\n";
    for (const DocumentPicture& picture : section.pictures) text += html_picture(picture);
    text += "</div>\n";
  }
  return text + html_table(section.table);
}

}  // namespace

std::string escaped_html(std::string_view text) {
  const std::string shown = printable(text);
  return replaced(shown, [&](std::size_t i) { return entity_of(shown[i]); });
}

std::string escaped_markdown(std::string_view text) {
  const std::string shown = printable(text);
  const auto is_letter = [&](std::size_t i) {
    return i < shown.size() && std::isalnum(static_cast<unsigned char>(shown[i])) != 0;
  };
  return replaced(shown, [&](std::size_t i) -> std::string {
    const char c = shown[i];
    if (c == '&' || c == '<' || c == '>') return entity_of(c);
    if (c == '\n' || c == '\r' || c == '\t') return " ";
    // Inside of a word an underscore is none of Markdown's.
    const bool in_word = c == '_' && i > 0 && is_letter(i - 1) && is_letter(i + 1);
    const bool is_mark = std::string_view("\\`*_[]|~$#!").find(c) != std::string_view::npos;
    return is_mark && !in_word ? std::string("\\") + c : std::string();
  });
}

std::string markdown_of(const ComparisonDocument& document) {
  std::string text = "## " + escaped_markdown(document.title) + "\n\n**" +
                     escaped_markdown(document.verdict) + "**\n\n";
  for (const DocumentSection& section : document.sections) text += markdown_section(section);
  return text;
}

std::string html_of(const ComparisonDocument& document) {
  const std::string title = escaped_html(document.title);
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      title + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + title +
      "</h1>\n<p class=\"verdict " + class_of(document.tone) + "\">" +
      escaped_html(document.verdict) + "</p>\n";
  for (const DocumentSection& section : document.sections) text += html_section(section);
  return text + "</body>\n</html>\n";
}

}  // namespace geoprior
