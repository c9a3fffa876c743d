#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/options.h"
#include "testbed/figure_view.h"
#include "testbed/runner/spec/terms.h"

namespace geoprior {

/// The tables of an experiment file as they are written; spec.h has what they resolve to. Free-form
/// members (`options`, `at`, `values`, [scene]) are taken out before these are read.

enum class RunSize { full, quick };

struct HeaderTable {
  std::string title;
  std::string figure;
  std::string topic;
  std::optional<std::string> id;
  RunSize size = RunSize::full;
  int seed = 1;
  int threads = 0;
  std::optional<std::string> input;
};

struct VariantTable {
  std::string name;
  std::string method;
  std::optional<std::string> role;
  std::optional<std::string> reference;
  bool quick = true;
};

struct SweepTable {
  std::string key;
  std::vector<std::string> names;
  std::vector<std::string> variants;
  bool grid = false;
  bool base = true;
  bool claims_only = false;
};

/// A reduction of the other side: `same`, or one of those that give a number.
enum class OfReduction { same, max, min, median, p95, p99, mean, sum, last };

/// Cases in which a claim is decided and shown, but need not hold.
struct ExceptTable {
  std::vector<std::string> cases;
  std::string reason;
};

struct ClaimTable {
  std::string text;
  std::string metric;
  std::optional<std::string> variant;
  std::vector<std::string> variants;
  std::optional<std::string> of;
  std::optional<double> value;
  Comparison is = Comparison::less_equal;
  double factor = 1;
  double offset = 0;
  double tolerance = 0;
  std::optional<std::string> known_shortfall;
  std::optional<std::string> slack;
  Reduction reduce = Reduction::max;
  OfReduction of_reduce = OfReduction::same;
  std::vector<ExceptTable> except;
  ClaimOver over = ClaimOver::case_;
  std::optional<std::string> null;
  bool quick = true;
};

/// One rival at several resolutions, from coarse to fine.
struct FamilyTable {
  std::vector<std::string> variants;
};

struct StudyTable {
  std::string name;
  StudyKind kind = StudyKind::exponent;
  std::string variant;
  std::string quantity;
  std::optional<std::string> of;
  std::optional<std::string> against;
  Finer finer = Finer::smaller;
  Reduction reduce = Reduction::median;
  std::optional<std::string> match;
  Reduction match_reduce = Reduction::last;
  std::optional<std::string> keep;
  std::optional<double> keep_within;
  std::vector<FamilyTable> families;
  std::vector<std::string> cases;
};

struct TimingTable {
  int repetitions = 1;
  std::optional<int> warm_up;
};

struct CheckTable {
  bool bifurcates = false;
  std::vector<std::string> metrics;
  std::vector<std::string> quick_metrics;
  bool outcomes = false;
};

struct ToleranceTable {
  double absolute = 0;
  double relative = 0;
};

/// The members of FigureView, of which `target` may be absent.
struct FigureViewTable {
  explicit FigureViewTable(FigureView defaults = {}) : view(std::move(defaults)) {
    if (view.target) target.assign(view.target->begin(), view.target->end());
  }
  FigureView view;
  std::vector<double> target;
};

void describe(OptionVisitor& v, HeaderTable& t);
void describe(OptionVisitor& v, VariantTable& t);
void describe(OptionVisitor& v, SweepTable& t);
void describe(OptionVisitor& v, ExceptTable& t);
void describe(OptionVisitor& v, ClaimTable& t);
void describe(OptionVisitor& v, FamilyTable& t);
void describe(OptionVisitor& v, StudyTable& t);
void describe(OptionVisitor& v, TimingTable& t);
void describe(OptionVisitor& v, CheckTable& t);
void describe(OptionVisitor& v, ToleranceTable& t);
void describe(OptionVisitor& v, SectionView& t);
void describe(OptionVisitor& v, FurtherRow& t);
void describe(OptionVisitor& v, PlanePoint& t);
void describe(OptionVisitor& v, ExpectedCurve& t);
void describe(OptionVisitor& v, FigureViewTable& t);

}  // namespace geoprior
