#include "testbed/runner/reference/reference.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/home.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/reference/parser.h"
#include "testbed/runner/reference/text.h"

namespace geoprior {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr int kMostDigits = 9;
/// Share of a tolerance that rounding may take.
constexpr double kRoundingShare = 0.1;

bool within(double value, double reference, double tolerance) {
  if (std::isnan(value) || std::isnan(reference)) return std::isnan(value) == std::isnan(reference);
  return value == reference || std::abs(value - reference) <= tolerance;  // equal infinities too
}

std::string change(const Gate& gate, double value, double reference) {
  const double worse = worsening(gate, value, reference);
  if (std::isnan(worse) || gate.direction == Direction::none) return "changed";
  return worse > 0 ? "changed for the worse" : "changed for the better (bless it to keep it)";
}

/// Fills in `problem`; leaves it empty where the value is what it was.
void judge(const Gate& gate, const GatedValue& now, const ReferenceValue& before, Mismatch& m) {
  m.reference = before.value;
  m.tolerance = gate.tolerance.of(now.size.value_or(before.value));
  if (before.unit != now.unit) {
    m.problem = "unit was " + before.unit;
    return;
  }
  const double worse = worsening(gate, now.value, before.value);
  if (!within(now.value, before.value, m.tolerance)) {
    m.problem = change(gate, now.value, before.value);
    if (gate.only_more && worse < 0) {
      m.problem = "is less work (bless it to keep it)";
      m.fails = false;
    }
    return;
  }
  const double limit = headline_limit(gate, before.value);
  if (gate.headline && worse > limit) {
    m.problem = "is named by a claim and changed for the worse";
    m.tolerance = limit;
  }
}

/// Names of what a ContentHash does not cover have a prefix.
template <class Values>
void erase_metrics(Values& values) {
  for (auto& [case_name, variants] : values) {
    for (auto& [variant, named] : variants) {
      std::erase_if(named,
                    [](const auto& one) { return one.first.find(':') == std::string::npos; });
    }
  }
}

/// Whether a value that the set lacks fails: one of a metric that the set has elsewhere, and by how
/// much a claim falls short, whose sentence says that it is known.
bool must_be_blessed(const ReferenceSet& set, const std::string& name) {
  bool known = name.starts_with("shortfall:");
  visit_values(set, [&](const auto&, const auto&, const std::string& other, const auto&) {
    known = known || other == name;
  });
  return known;
}

std::string gone_text(const std::string& name) {
  return name.starts_with("shortfall:")
             ? "is gone: the claim holds (remove its known_shortfall, and bless)"
             : "is gone (bless the rest to forget it)";
}

}  // namespace

std::filesystem::path reference_file(const std::string& experiment_id) {
  return geoprior_home() / "results" / "reference" / (experiment_id + ".txt");
}

Reference read_reference(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return {};
  return parse_reference(read_whole_file(file), file.string());
}

void write_reference(const Reference& reference, const std::filesystem::path& file) {
  const std::string text = reference_text(reference);
  make_folders(file.parent_path());
  write_file_atomically(file, std::string_view(text));
}

std::vector<Mismatch> compare_with_reference(const GatedValues& now, const ReferenceSet& reference,
                                             const Gates& gates) {
  std::vector<Mismatch> mismatches;
  visit_values(now, [&](const auto& in, const auto& variant, const auto& name, const auto& value) {
    const Gate gate = gates.of(variant, name);
    if (!gate.compared) return;
    Mismatch mismatch{in, variant, name, "", value.value, kNoValue, 0, value.unit};
    if (const auto* before = find_value(reference, in, variant, name)) {
      judge(gate, value, *before, mismatch);
    } else {
      mismatch.fails = must_be_blessed(reference, name);
      mismatch.problem =
          mismatch.fails ? "has no reference value (bless it)" : "is new (bless it to hold it)";
    }
    if (!mismatch.problem.empty()) mismatches.push_back(mismatch);
  });
  visit_values(
      reference, [&](const auto& in, const auto& variant, const auto& name, const auto& before) {
        if (find_value(now, in, variant, name) != nullptr || !gates.of(variant, name).compared)
          return;
        mismatches.push_back(
            {in, variant, name, gone_text(name), kNoValue, before.value, 0, before.unit});
      });
  return mismatches;
}

ContentHash content_of(const RunRecord& record) {
  const auto instructions = record.provenance.find("instruction_set");
  return {instructions == record.provenance.end() ? "unknown" : instructions->second,
          record.frames_sha256, record.metrics_sha256};
}

SameBytes compare_bytes(const RunRecord& record, const ContentHash& blessed) {
  const ContentHash now = content_of(record);
  if (now.instruction_set != blessed.instruction_set) return SameBytes::incomparable;
  if (!blessed.content.empty()) {
    return blessed.content == record.content_sha256 ? SameBytes::all : SameBytes::none;
  }
  if (now.frames != blessed.frames) return SameBytes::none;
  return now.metrics == blessed.metrics ? SameBytes::all : SameBytes::frames;
}

std::size_t count_values(const GatedValues& values) {
  std::size_t count = 0;
  visit_values(values, [&](const auto&, const auto&, const auto&, const auto&) { ++count; });
  return count;
}

void keep_outside_content(GatedValues& values) { erase_metrics(values); }
void keep_outside_content(ReferenceSet& values) { erase_metrics(values); }

double rounded_for(double value, const Tolerance& tolerance) {
  const double moved = kRoundingShare * tolerance.of(value);
  if (!std::isfinite(value) || std::abs(value) <= moved) return std::isfinite(value) ? 0 : value;
  // Digits down to a power of ten of which half is at most `moved`, so that neighbours agree.
  const double last_place = std::floor(std::log10(2 * moved));
  const double first_place = std::floor(std::log10(std::abs(value)));
  const double digits = std::clamp(first_place - last_place + 1, 1.0, double{kMostDigits});
  const std::string text = rounded_text(value, static_cast<int>(digits));
  double rounded = 0;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return std::abs(rounded - value) <= moved ? rounded : value;
}

ReferenceSet bless_values(const GatedValues& now, const Gates& gates) {
  ReferenceSet set;
  visit_values(now, [&](const auto& in, const auto& variant, const auto& name, const auto& value) {
    const Gate gate = gates.of(variant, name);
    if (!gate.compared) return;
    const Tolerance tolerance =
        value.size ? Tolerance{gate.tolerance.of(*value.size), 0} : gate.tolerance;
    set[in][variant][name] = {rounded_for(value.value, tolerance), value.unit};
  });
  return set;
}

std::string mismatch_text(const std::string& experiment_id, const Mismatch& m) {
  const std::string unit = m.unit.empty() || m.unit == "1" ? "" : " " + m.unit;
  std::string place = experiment_id;
  if (!m.case_name.empty()) place += ", case '" + m.case_name + "'";
  if (!m.variant.empty()) place += ", variant '" + m.variant + "'";
  return place + ", metric '" + m.metric + "' " + m.problem + ": value " + number_text(m.value) +
         unit + ", reference " + number_text(m.reference) + unit + ", tolerance " +
         rounded_text(m.tolerance) + unit;
}

}  // namespace geoprior
