#include "experiments/assembly/processes/survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <unordered_set>
#include <utility>

#include "core/frame_loop.h"
#include "models/assembly/exchange/embedding.h"

namespace geoprior::assembly {
namespace {

constexpr int kWordBits = 48;  ///< of a set in one number of a table

std::vector<double> words_of(const PartSet& set, int parts) {
  std::vector<double> out((parts + kWordBits - 1) / kWordBits, 0.);
  for (const int part : set.parts())
    out[part / kWordBits] += static_cast<double>(std::uint64_t{1} << (part % kWordBits));
  return out;
}

constexpr int kSurveyedBetweenStops = 1024;

/// A number for a donor's set and a match: sums of its upper half do not depend on an order.
std::uint64_t mixed(const Replacement& r) {
  std::uint64_t h = static_cast<std::uint64_t>(r.donor) + 0x9e3779b97f4a7c15ULL;
  const auto add = [&](std::uint64_t w) {
    h = (h ^ w) * 0xbf58476d1ce4e5b9ULL;
    h ^= h >> 31;
  };
  for (const std::uint64_t w : r.inserted.parts.words()) add(w);
  for (const int m : r.match) add(static_cast<std::uint64_t>(m) + 1);
  return h;
}

/// What is said of one substructure of the host.
struct Partners {
  std::unordered_set<std::uint64_t> seen;  ///< replacements may be found more than once
  double count = 0;
  std::uint64_t sum = 0;

  void add(const Replacement& r) {
    const std::uint64_t h = mixed(r);
    if (!seen.insert(h).second) return;
    count += 1;
    sum += h >> 32;
  }
};

/// Counts of gaps, in steps of a tenth of a decade from a micrometre to ten metres; the first bin
/// has all below.
struct GapHistogram {
  static constexpr double kLeast = 1e-6, kPerDecade = 10;
  static constexpr int kBins = 71;
  std::array<double, kBins> count{}, closing{};

  static double bound(int bin) { return kLeast * std::pow(10., (bin - 1) / kPerDecade); }
  void add(double gap, bool closes) {
    const double bin = gap <= kLeast ? 0 : 1 + std::floor(kPerDecade * std::log10(gap / kLeast));
    const int i = static_cast<int>(std::clamp(bin, 0., kBins - 1.));
    ++count[i];
    if (closes) ++closing[i];
  }
};

/// All that a survey gathers of one host.
struct HostSurvey {
  std::map<Substructure, Partners> partners;
  GapHistogram residuals;
  std::set<CanonicalKey> outputs;
  std::optional<Variation> first_closing;
  SearchCounts counts;
};

class SurveyModel final : public FrameModel {
 public:
  SurveyModel(const AssemblyInput& input, FinderFactory factory, bool symmetries,
              const SearchOptions& options, RunContext& context)
      : input_(input),
        factory_(std::move(factory)),
        symmetries_(symmetries),
        options_(options),
        compatibility_(input.set, symmetries),
        donors_{&input.set, &compatibility_, {}},
        filter_(input, input.rules.tolerance, symmetries) {
    if (!input.survey->across) return;
    for (int i = 0; i < frame_count(); ++i) donors_.donors.push_back(i);
    finder_ = factory_(donors_, input.survey->pairs, context);
  }

  [[nodiscard]] int frame_count() const override {
    return static_cast<int>(input_.set.models.size());
  }

  void record(int index, FrameSink& sink, RunContext& context) override {
    const Assembly& host = input_.set.models[index];
    if (!input_.survey->across) {
      donors_.donors = {index};
      finder_ = factory_(donors_, input_.survey->pairs, context);
    }
    HostSurvey survey;
    {
      const Phase phase(context, "substructures");
      for (Substructure& s : finder_->substructures(host)) survey.partners[std::move(s)];
    }
    if (input_.survey->pairs || input_.survey->outputs || input_.survey->embeds) {
      const Phase phase(context, "replacements");
      look_at_replacements(host, survey, context);
    }
    const Variation shown = survey.first_closing.value_or(unchanged(host));
    Frame frame = assembly_frame(index, shown, input_.set.types, &survey.counts);
    frame.tables["substructures"] = substructure_table(survey, static_cast<int>(host.parts.size()));
    frame.tables["residuals"] = residual_table(survey);
    frame.tables["outputs"] = output_table(survey);
    sink.frame(std::move(frame));
  }

 private:
  void look_at_replacements(const Assembly& host, HostSurvey& survey, RunContext& context) {
    VariationSearch search(input_, symmetries_, options_);
    filter_.begin(host);
    int removed_number = -1;
    Partners* partners = nullptr;
    std::vector<int> outside;
    int since_look = 0;
    finder_->find(host, [&](const Replacement& r) {
      if (++since_look % kSurveyedBetweenStops == 0 && context.stop_requested()) return false;
      ++survey.counts.candidates;
      if (r.removed_number != removed_number) {
        removed_number = r.removed_number;
        partners = &survey.partners[r.removed];
        const std::vector<int> pieces = pieces_outside(host, r.removed.parts);
        outside.clear();
        for (const int c : r.removed.boundary)
          outside.push_back(pieces[outside_end(host.connections[c], r.removed.parts).part]);
      }
      if (input_.survey->pairs) partners->add(r);
      if (input_.survey->outputs)
        survey.outputs.insert(canonical_key(replace(host, input_.set.models[r.donor], r).assembly,
                                            input_.set.types, symmetries_));
      if (input_.survey->embeds) embed_closing(host, r, outside, search, survey);
      return survey.counts.candidates < options_.candidates;
    });
    const double candidates = survey.counts.candidates, closing = survey.counts.closing;
    survey.counts = search.counts();
    survey.counts.candidates = candidates;
    survey.counts.closing = closing;
  }

  /// Seams that one piece holds have a residual; where it is within the tolerance the assembly is
  /// made and held against the rules. Boundaries of bridges always close, and are so many that they
  /// are counted only.
  void embed_closing(const Assembly& host, const Replacement& r, const std::vector<int>& outside,
                     VariationSearch& search, HostSurvey& survey) {
    std::vector<int> pieces = outside;
    std::sort(pieces.begin(), pieces.end());
    if (std::adjacent_find(pieces.begin(), pieces.end()) == pieces.end()) return;
    const Misfit m = seam_residual(host, input_.set.models[r.donor], input_.set.types, r, outside);
    const bool closes = within(m, input_.rules.tolerance);
    if (closes && filter_.is_same(host, r)) return;
    survey.residuals.add(m.translation, closes);
    if (!closes) return;
    survey.counts.closing += 1;
    Variation variation;
    if (search.consider(unchanged(host), r, variation) && !survey.first_closing)
      survey.first_closing = variation;
  }

  [[nodiscard]] FrameTable substructure_table(const HostSurvey& survey, int parts) const {
    FrameTable out;
    const int words = (parts + kWordBits - 1) / kWordBits;
    out.columns = {"boundary [1]", "parts [1]"};
    for (int w = 0; w < words; ++w) out.columns.push_back("set_" + std::to_string(w) + " [1]");
    if (input_.survey->pairs) out.columns.insert(out.columns.end(), {"pairs [1]", "sum [1]"});
    out.rows.resize(static_cast<Eigen::Index>(survey.partners.size()),
                    static_cast<Eigen::Index>(out.columns.size()));
    Eigen::Index row = 0;
    for (const auto& [s, partners] : survey.partners) {
      out.rows(row, 0) = static_cast<double>(s.boundary.size());
      out.rows(row, 1) = s.parts.size();
      const std::vector<double> set = words_of(s.parts, parts);
      for (int w = 0; w < words; ++w) out.rows(row, 2 + w) = set[w];
      if (input_.survey->pairs) {
        out.rows(row, 2 + words) = partners.count;
        out.rows(row, 3 + words) = static_cast<double>(partners.sum % (std::uint64_t{1} << 52));
      }
      ++row;
    }
    return out;
  }

  static FrameTable residual_table(const HostSurvey& survey) {
    FrameTable out;
    out.columns = {"from [m]", "to [m]", "replacements [1]", "closing [1]"};
    out.rows.resize(GapHistogram::kBins, 4);
    for (int i = 0; i < GapHistogram::kBins; ++i)
      out.rows.row(i) << (i == 0 ? 0 : GapHistogram::bound(i)), GapHistogram::bound(i + 1),
          survey.residuals.count[i], survey.residuals.closing[i];
    return out;
  }

  static FrameTable output_table(const HostSurvey& survey) {
    FrameTable out;
    out.columns = {"key_0 [1]", "key_1 [1]", "key_2 [1]", "key_3 [1]"};
    out.rows.resize(static_cast<Eigen::Index>(survey.outputs.size()), 4);
    Eigen::Index row = 0;
    for (const CanonicalKey& key : survey.outputs) {
      for (int k = 0; k < 4; ++k)
        out.rows(row, k) = static_cast<double>(
            static_cast<std::uint32_t>(key.words[k / 2] >> (k % 2 == 0 ? 32 : 0)));
      ++row;
    }
    return out;
  }

  const AssemblyInput& input_;
  FinderFactory factory_;
  bool symmetries_;
  SearchOptions options_;
  Compatibility compatibility_;
  DonorSet donors_;
  SeamFilter filter_;
  std::unique_ptr<ReplacementFinder> finder_;
};

}  // namespace

std::unique_ptr<Process> survey_process(const AssemblyInput& input, FinderFactory factory,
                                        bool symmetries, const SearchOptions& options) {
  return frame_process([&input, factory = std::move(factory), symmetries,
                        options](RunContext& context) -> std::unique_ptr<FrameModel> {
    return std::make_unique<SurveyModel>(input, factory, symmetries, options, context);
  });
}

}  // namespace geoprior::assembly
