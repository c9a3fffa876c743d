#include "testbed/runner/comparison/document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <tuple>

#include "testbed/formats/folders.h"
#include "testbed/joined.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/reference/headlines.h"

namespace geoprior {
namespace {

constexpr int kFewDigits = 4, kAllDigits = 17;
constexpr double kLargeRatio = 3;  ///< from here on a factor reads better than per cent
constexpr std::uintmax_t kMostPictureBytes = 50'000'000;
constexpr std::size_t kHashDigits = 12;  ///< of a hash, for people

using Row = DocumentTable::Row;

Tone tone_of(Change change) {
  if (is_fall(change)) return Tone::bad;
  return change == Change::better ? Tone::good : Tone::plain;
}

/// "3 values are", "1 value is".
std::string counted(std::size_t count, const std::string& what, bool with_verb = true) {
  const std::string text = std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  return with_verb ? text + (count == 1 ? " is" : " are") : text;
}

std::string verdict_words(Change change, const std::string& unjudged) {
  return text_of(change) + (unjudged.empty() ? "" : " (" + unjudged + ")");
}

/// Two numbers with as many digits as tell them apart.
std::pair<std::string, std::string> told_apart(double before, double after) {
  const auto text = [](double x, int digits) {
    return std::isnan(x) ? std::string("no value") : rounded_text(x, digits);
  };
  int digits = kFewDigits;
  while (digits < kAllDigits && before != after && text(before, digits) == text(after, digits)) {
    ++digits;
  }
  return {text(before, digits), text(after, digits)};
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() || unit == "1" || number == "no value" ? number : number + " " + unit;
}

/// "+12 %", "×17".
std::string change_text(double before, double after) {
  const double ratio = after / before;
  if (std::isfinite(ratio) && ratio >= kLargeRatio) return "×" + rounded_text(ratio, 3);
  const double share = 100 * (after - before) / std::abs(before);
  if (!std::isfinite(share)) return "-";
  return (share > 0 ? "+" : "") + rounded_text(share, 3) + " %";
}

/// The changes of one metric at one variant and case, which differ in the statistic only, as one
/// row: the one that moved farthest, with the names of the others.
struct MetricRow {
  const ValueChange* farthest = nullptr;
  std::vector<std::string> others;
};

std::vector<MetricRow> by_metric(const std::vector<ValueChange>& values) {
  std::vector<MetricRow> rows;
  std::map<std::tuple<std::string, std::string, std::string, Change>, std::size_t> known;
  for (const ValueChange& value : values) {
    const std::string metric = without_statistic(value.metric);
    const auto [at, is_new] = known.emplace(
        std::tuple(value.case_name, value.variant, metric, value.change), rows.size());
    if (is_new) {
      rows.push_back({&value, {}});
    } else {
      rows[at->second].others.push_back(value.metric.substr(metric.size()));
    }
  }
  return rows;
}

/// With a column of cases only where there are several.
class RowMaker {
 public:
  explicit RowMaker(bool has_cases) : has_cases_(has_cases) {}
  [[nodiscard]] std::vector<std::string> operator()(std::vector<std::string> cells,
                                                    std::size_t column,
                                                    const std::string& case_name) const {
    if (has_cases_) {
      cells.insert(cells.begin() + static_cast<std::ptrdiff_t>(column), case_name);
    }
    return cells;
  }

 private:
  bool has_cases_;
};

Row value_row(const MetricRow& row, const RowMaker& cells) {
  const ValueChange& value = *row.farthest;
  const auto [before, after] = told_apart(value.before, value.after);
  std::string metric = value.metric;
  if (!row.others.empty()) metric += " (also " + joined(row.others) + ")";
  return {cells({verdict_words(value.change, value.unjudged), metric, value.variant,
                 with_unit(before, value.unit), with_unit(after, value.unit),
                 change_text(value.before, value.after), direction_words(value),
                 with_unit("±" + rounded_text(value.tolerance, 2), value.unit)},
                3, value.case_name),
          tone_of(value.change)};
}

DocumentSection values_section(const RunComparison& comparison, const RowMaker& cells) {
  DocumentSection section;
  section.heading = "Metrics";
  section.table.head = cells(
      {"", "metric", "variant", "before", "after", "change", "direction", "tolerance"}, 3, "case");
  for (const MetricRow& row : by_metric(comparison.values)) {
    section.table.rows.push_back(value_row(row, cells));
  }
  section.paragraphs.push_back(counted(comparison.within, "value") +
                               " within tolerance and not listed.");
  const auto add_names = [&](const std::vector<std::string>& names, const std::string& what) {
    if (!names.empty()) section.paragraphs.push_back(what + ": " + joined(names) + ".");
  };
  add_names(comparison.lost, "Metrics that have no value any more");
  add_names(comparison.gone, "Metrics of the first run only");
  add_names(comparison.added, "Metrics of the second run only");
  return section;
}

DocumentSection statuses_section(const RunComparison& comparison, const RowMaker& cells) {
  DocumentSection section;
  section.heading = "Variants that failed in one run";
  section.table.head = cells({"", "variant", "before", "after"}, 2, "case");
  for (const StatusChange& one : comparison.statuses) {
    section.table.rows.push_back(
        {cells({text_of(one.change), one.variant, one.before, one.after}, 2, one.case_name),
         tone_of(one.change)});
  }
  return section;
}

DocumentSection claims_section(const RunComparison& comparison, const RowMaker& cells) {
  DocumentSection section;
  section.heading = "Claims";
  if (comparison.same_claims > 0) {
    section.paragraphs.push_back(counted(comparison.same_claims, "claim") +
                                 " decided alike and not listed.");
  }
  section.table.head = cells({"", "claim", "before", "after", "in the second run"}, 2, "case");
  for (const ClaimChange& one : comparison.claims) {
    section.table.rows.push_back({cells({verdict_words(one.change, one.unjudged), one.text,
                                         one.before, one.after, one.detail},
                                        2, one.case_name),
                                  tone_of(one.change)});
  }
  return section;
}

std::string ratio_words(const Interval& ratio) {
  if (std::isnan(ratio.low)) return "one pair";
  if (ratio.low > 1) return "slower";
  return ratio.high < 1 ? "faster" : "not told apart";
}

DocumentSection times_section(const RunComparison& comparison, const RowMaker& cells) {
  DocumentSection section;
  section.heading = "Times";
  if (comparison.times.empty()) {
    section.paragraphs.emplace_back("The runs have no times of equal frames.");
    return section;
  }
  section.paragraphs.emplace_back(
      "Median of the ratios after / before at equal frames and repetitions, with its bootstrap 95 "
      "% "
      "interval. Times are no part of the verdict.");
  section.paragraphs.emplace_back(
      comparison.one_run
          ? "The variants were timed in turns: the ratios are paired."
          : "The runs were made at different times, so that the ratios are not paired: the "
            "interval has the spread over the frames, not that between runs.");
  if (!comparison.same_processor) {
    section.paragraphs.emplace_back(
        "The processors differ: the ratios compare machines as much as programs.");
  }
  section.table.head =
      cells({"", "variant", "phase", "before", "after", "after / before", "pairs"}, 2, "case");
  for (const TimeRatio& one : comparison.times) {
    const auto ms = [](double s) { return rounded_text(1e3 * s, 3) + " ms"; };
    std::string ratio = rounded_text(one.ratio.value, 3);
    if (!std::isnan(one.ratio.low)) {
      ratio += " [" + rounded_text(one.ratio.low, 3) + ", " + rounded_text(one.ratio.high, 3) + "]";
    }
    section.table.rows.push_back(
        {cells({ratio_words(one.ratio), one.variant, one.phase, ms(one.before_s), ms(one.after_s),
                ratio, std::to_string(one.pairs)},
               2, one.case_name)});
  }
  return section;
}

DocumentSection keys_section(const std::string& heading, const std::string& words,
                             const std::vector<KeyDifference>& keys) {
  DocumentSection section;
  section.heading = heading;
  section.paragraphs = {words};
  section.table.head = {"key", "before", "after"};
  for (const KeyDifference& one : keys) {
    section.table.rows.push_back({{one.key, one.before, one.after}});
  }
  return section;
}

DocumentSection specifications_section(const RunComparison& comparison) {
  return keys_section(
      "Specifications",
      "These keys differ; only cases, variants and metrics that both runs have are compared.",
      comparison.keys);
}

DocumentSection options_section(const RunComparison& comparison) {
  return keys_section("Variants", "What the compared variants differ in.", comparison.options);
}

/// "0123456789ab, …" or "absent".
std::string hashes_text(const std::set<std::string>& hashes) {
  std::vector<std::string> beginnings;
  for (const std::string& hash : hashes) beginnings.push_back(hash.substr(0, kHashDigits));
  return beginnings.empty() ? "absent" : joined(beginnings);
}

DocumentSection inputs_section(const RunComparison& comparison) {
  DocumentSection section;
  section.heading = "Inputs";
  section.paragraphs.emplace_back(
      "These files are not the same in both runs; what differs may come from them.");
  section.table.head = {"file", "SHA-256 before", "after"};
  for (const InputDifference& one : comparison.inputs) {
    section.table.rows.push_back({{one.name, hashes_text(one.before), hashes_text(one.after)}});
  }
  return section;
}

/// By its signature, which is all that a page needs: a browser leaves out what it cannot draw.
bool is_png(const std::filesystem::path& file) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  std::array<char, kSignature.size()> head{};
  std::ifstream(file, std::ios::binary).read(head.data(), head.size());
  return std::string_view(head.data(), head.size()) == kSignature;
}

DocumentPicture picture_of(const OpenedRun& run, const std::string& which) {
  const std::filesystem::path file = path_below(run.folder(), "figure.png");
  const std::string command = "geoprior render " + run.folder().string();
  if (!std::filesystem::exists(file)) return {which + ": no picture yet: " + command, {}};
  if (std::filesystem::is_regular_file(file) &&
      std::filesystem::file_size(file) > kMostPictureBytes) {
    return {which + ": figure.png has more than 50 MB: it is in the run's folder", {}};
  }
  if (std::filesystem::is_regular_file(file) && !is_png(file)) {
    return {which + ": figure.png is no PNG; made anew by: " + command, {}};
  }
  return {which, file};
}

DocumentSection pictures_section(const OpenedRun& before, const OpenedRun& after) {
  DocumentSection section;
  section.heading = "Pictures";
  section.pictures = {picture_of(before, "before"), picture_of(after, "after")};
  return section;
}

std::string provenance_of(const RunRecord& record, const std::string& key) {
  const auto found = record.provenance.find(key);
  return found == record.provenance.end() ? "-" : found->second;
}

std::string commit_text(const RunRecord& record) {
  const std::string commit = provenance_of(record, "git_commit").substr(0, kHashDigits);
  return commit + (provenance_of(record, "git_dirty") == "true" ? ", with changes" : "");
}

DocumentSection runs_section(const RunComparison& comparison, const OpenedRun& before,
                             const OpenedRun& after) {
  DocumentSection section;
  section.heading = "The two runs";
  section.table.head = {"", "before", "after"};
  const RunRecord& a = before.record();
  const RunRecord& b = after.record();
  const auto add = [&](const std::string& name, const std::string& x, const std::string& y) {
    section.table.rows.push_back({{name, x, y}});
  };
  const auto folder = [](const OpenedRun& run) {
    return std::filesystem::absolute(run.folder()).lexically_normal().filename().string();
  };
  add("experiment", a.experiment_id + (a.quick ? ", quick" : ""),
      b.experiment_id + (b.quick ? ", quick" : ""));
  add("run", folder(before), folder(after));
  add("start", provenance_of(a, "start"), provenance_of(b, "start"));
  add("commit", commit_text(a), commit_text(b));
  add("processor", provenance_of(a, "cpu"), provenance_of(b, "cpu"));
  for (const char* key : {"version", "compiler", "flags", "instruction_set", "system",
                          "hardware_threads", "measured_git_commit"}) {
    if (provenance_of(a, key) != provenance_of(b, key)) {
      add(key, provenance_of(a, key), provenance_of(b, key));
    }
  }
  add("content", a.content_sha256.substr(0, kHashDigits), b.content_sha256.substr(0, kHashDigits));
  const auto add_missing = [&](const std::vector<std::string>& missing, const std::string& which) {
    if (!missing.empty()) {
      section.paragraphs.push_back("Only in the " + which + " run: " + joined(missing, "; ") + ".");
    }
  };
  add_missing(comparison.only_before, "first");
  add_missing(comparison.only_after, "second");
  return section;
}

std::size_t count_claims(const RunComparison& comparison, Change change) {
  return static_cast<std::size_t>(
      std::count_if(comparison.claims.begin(), comparison.claims.end(),
                    [&](const ClaimChange& one) { return one.change == change; }));
}

std::string verdict_of(const RunComparison& comparison) {
  const std::string inputs =
      comparison.inputs.empty() ? ""
                                : counted(comparison.inputs.size(), "input file") + " not the same";
  if (comparison.same_bytes && comparison.values.empty() && comparison.claims.empty()) {
    return "Same bytes: frames and metrics of the two runs are equal" +
           (inputs.empty() ? "." : ", although " + inputs + ".");
  }
  const std::size_t worse = comparison.count(Change::worse);
  const std::size_t lost = comparison.count(Change::lost);
  const std::size_t claims = count_claims(comparison, Change::worse);
  std::vector<std::string> parts;
  if (worse > 0) parts.push_back(counted(worse, "value") + " worse");
  if (lost > 0) parts.push_back(counted(lost, "value") + " lost");
  if (!comparison.lost.empty())
    parts.push_back(counted(comparison.lost.size(), "metric") + " lost");
  for (const StatusChange& one : comparison.statuses) {
    if (is_fall(one.change)) parts.push_back("variant " + one.variant + " failed");
  }
  if (claims > 0) parts.push_back(counted(claims, "claim", false) + " fell");
  const bool fell = comparison.fell();
  if (!fell) parts.emplace_back("no value is worse, no claim fell");
  const std::size_t better = comparison.count(Change::better);
  if (better > 0) parts.push_back(counted(better, "value") + " better");
  const std::size_t changed = comparison.count(Change::changed);
  if (changed > 0) parts.push_back(counted(changed, "value") + " changed without being judged");
  if (!inputs.empty()) parts.push_back(inputs);
  return std::string(fell ? "Quality fell: " : "Quality did not fall: ") + joined(parts) + ".";
}

}  // namespace

std::string text_of(Change change) {
  switch (change) {
    case Change::worse:
      return "worse";
    case Change::lost:
      return "lost";
    case Change::better:
      return "better";
    case Change::changed:
      break;
  }
  return "changed";
}

std::string direction_words(const ValueChange& value) {
  switch (value.direction) {
    case Direction::lower_is_better:
      return "lower is better";
    case Direction::higher_is_better:
      return "higher is better";
    case Direction::closer_to_target:
      return "closer to " + number_text(value.target) + " is better";
    case Direction::none:
      break;
  }
  return "-";
}

ComparisonDocument describe_comparison(const RunComparison& comparison, const OpenedRun& before,
                                       const OpenedRun& after) {
  ComparisonDocument document;
  document.title = after.record().title;
  document.verdict = verdict_of(comparison);
  document.tone = comparison.fell() ? Tone::bad : Tone::good;
  const auto has_cases = [&](bool of_claims) {
    const auto& cases = before.record().cases;
    return std::count_if(cases.begin(), cases.end(),
                         [&](const CaseRecord& in) { return of_claims || !in.claims_only; }) > 1;
  };
  const RowMaker cells(has_cases(false)), claim_cells(has_cases(true));
  auto& sections = document.sections;
  if (!comparison.keys.empty()) sections.push_back(specifications_section(comparison));
  if (!comparison.options.empty()) sections.push_back(options_section(comparison));
  if (!comparison.inputs.empty()) sections.push_back(inputs_section(comparison));
  if (!comparison.statuses.empty()) sections.push_back(statuses_section(comparison, cells));
  sections.push_back(values_section(comparison, cells));
  if (comparison.same_claims > 0 || !comparison.claims.empty()) {
    sections.push_back(claims_section(comparison, claim_cells));
  }
  sections.push_back(pictures_section(before, after));
  sections.push_back(times_section(comparison, cells));
  sections.push_back(runs_section(comparison, before, after));
  return document;
}

}  // namespace geoprior
