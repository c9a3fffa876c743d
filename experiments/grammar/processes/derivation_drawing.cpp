#include "experiments/grammar/processes/derivation_drawing.h"

#include <algorithm>
#include <cstdio>

#include "testbed/formats/artifact.h"

namespace geoprior::grammar {
namespace {

constexpr double kBoxWidth = 236, kBoxHeight = 62, kBoxGapX = 14, kBoxGapY = 34, kMargin = 20;
constexpr std::size_t kMostLetters = 36;

/// Where the boxes of a derivation are drawn: columns and rows.
struct TraceLayout {
  std::vector<double> column;
  std::vector<int> row;
  double columns = 0;
  int rows = 0;
};

TraceLayout layout_of(const std::vector<TraceNode>& trace) {
  const int n = static_cast<int>(trace.size());
  TraceLayout out{std::vector<double>(n, 0), std::vector<int>(n, 0)};
  int up = 0;
  while (up < n && trace[up].phase == Phase::up) ++up;
  std::vector<std::vector<int>> children(n);
  for (int i = std::max(up, 1); i < n; ++i)
    if (trace[i].parent >= 0) children[trace[i].parent].push_back(i);
  for (int i = 0; i < up; ++i) out.column[i] = up - 1 - i;
  for (int i = up; i < n; ++i)
    out.row[i] = trace[i].parent >= 0 ? out.row[trace[i].parent] + 1 : (up > 0 ? 1 : 0);
  // Leaves get a column each, in order; what asks stands in the middle of what it asked.
  double next = 0;
  for (int i = up; i < n; ++i)
    if (children[i].empty()) out.column[i] = next++;
  for (int i = n - 1; i >= up; --i)
    if (!children[i].empty())
      out.column[i] = (out.column[children[i].front()] + out.column[children[i].back()]) / 2;
  out.columns = std::max(next, static_cast<double>(up));
  out.rows = n > 0 ? *std::max_element(out.row.begin(), out.row.end()) + 1 : 0;
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text.substr(0, kMostLetters)) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else
      out += c;
  }
  return out + (text.size() > kMostLetters ? "…" : "");
}

std::string number_pair(const char* form, double a, double b) {
  char text[160];
  std::snprintf(text, sizeof text, form, a, b);
  return text;
}

std::string trace_box(const Hierarchy& h, const TraceNode& node, double x, double y) {
  std::string title = h.label(node.first);
  if (node.count > 1) title += " +" + std::to_string(node.count - 1);
  const std::string what =
      std::string(node.phase == Phase::up ? "↑ " : "↓ ") + std::string(name_of(node.kind));
  std::string out = number_pair("<rect x=\"%.1f\" y=\"%.1f\" ", x, y);
  out += number_pair("width=\"%.0f\" height=\"%.0f\" rx=\"5\" ", kBoxWidth, kBoxHeight);
  out += node.phase == Phase::up ? "fill=\"#fbe3c0\" stroke=\"#b06a00\"/>\n"
                                 : "fill=\"#dce9f7\" stroke=\"#2b5f9e\"/>\n";
  out += number_pair("<text x=\"%.1f\" y=\"%.1f\" font-weight=\"bold\">", x + 8, y + 18) +
         escaped(title) + "</text>\n";
  out += number_pair("<text x=\"%.1f\" y=\"%.1f\">", x + 8, y + 35) + escaped(what) + "</text>\n";
  return out + number_pair("<text x=\"%.1f\" y=\"%.1f\">", x + 8, y + 52) + escaped(node.rule) +
         "</text>\n";
}

}  // namespace

void add_touched(const Transaction& transaction, Frame& frame) {
  const auto found = frame.parts.find("surface");
  if (found == frame.parts.end()) return;
  Part& surface = found->second;
  const std::vector<int> changed = transaction.changed();
  std::vector<char> moved(transaction.first_new(), 0);
  for (const int element : changed) moved[element] = 1;
  NamedArray touched{"touched", "1", NamedArray::On::cells,
                     Eigen::MatrixXd(surface.triangles.rows(), 1)};
  const NamedArray& element = surface.require_array("element", NamedArray::On::cells, 1);
  for (Eigen::Index f = 0; f < touched.values.rows(); ++f) {
    const int e = static_cast<int>(element.values(f, 0));
    touched.values(f, 0) = e >= transaction.first_new() ? 3
                           : moved[e] != 0              ? 2
                           : transaction.touched(e)     ? 1
                                                        : 0;
  }
  surface.arrays.push_back(std::move(touched));
}

std::string derivation_svg(const Hierarchy& hierarchy, const DerivationReport& report) {
  const TraceLayout layout = layout_of(report.trace);
  const auto x = [&](std::size_t i) { return kMargin + layout.column[i] * (kBoxWidth + kBoxGapX); };
  const auto y = [&](std::size_t i) { return kMargin + layout.row[i] * (kBoxHeight + kBoxGapY); };
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" font-family=\"DejaVu Sans, sans-serif\" "
      "font-size=\"10.5\" " +
      number_pair("width=\"%.0f\" height=\"%.0f\">\n",
                  2 * kMargin + layout.columns * (kBoxWidth + kBoxGapX) - kBoxGapX,
                  2 * kMargin + layout.rows * (kBoxHeight + kBoxGapY) - kBoxGapY) +
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (std::size_t i = 0; i < report.trace.size(); ++i) {
    const int parent = report.trace[i].parent;
    if (parent < 0) continue;
    const auto p = static_cast<std::size_t>(parent);
    const bool beside = layout.row[i] == layout.row[p];
    out += number_pair("<line x1=\"%.1f\" y1=\"%.1f\" ", x(p) + (beside ? 0 : kBoxWidth / 2),
                       y(p) + (beside ? kBoxHeight / 2 : kBoxHeight));
    out += number_pair("x2=\"%.1f\" y2=\"%.1f\" stroke=\"#777\"/>\n",
                       x(i) + (beside ? kBoxWidth : kBoxWidth / 2),
                       y(i) + (beside ? kBoxHeight / 2 : 0));
  }
  for (std::size_t i = 0; i < report.trace.size(); ++i)
    out += trace_box(hierarchy, report.trace[i], x(i), y(i));
  return out + "</svg>\n";
}

std::vector<Artifact> derivation_files(const Hierarchy& hierarchy, const DerivationReport& report,
                                       int frame) {
  char name[40];
  std::snprintf(name, sizeof name, "derivation-%03d", frame);
  return {artifact_of(std::string(name) + ".svg", derivation_svg(hierarchy, report)),
          artifact_of(std::string(name) + ".txt", trace_text(hierarchy, report))};
}

}  // namespace geoprior::grammar
