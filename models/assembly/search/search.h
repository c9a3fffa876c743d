#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <unordered_set>
#include <vector>

#include "core/method.h"
#include "core/options.h"
#include "models/assembly/exchange/replacement.h"
#include "models/assembly/isomorphism/canonical.h"
#include "models/assembly/search/input.h"
#include "models/assembly/search/seam_filter.h"
#include "models/assembly/search/variation.h"

namespace geoprior::assembly {

/// In which order variations come.
enum class Order {
  varied,  ///< a generation at a time, each next one the least like all before
  found,   ///< as they are found
  best,    ///< each better than all before by the scene's guide: best-first search
};

struct SearchOptions {
  int count = 16;
  int generations = 1;
  int pool = 64;
  double candidates = 1e6;
  bool prefilter = true;  ///< whether `SeamFilter` is asked; described by methods that offer it
  Order order = Order::varied;
};
void describe(OptionVisitor& v, SearchOptions& options);

/// Valid and distinct variations of assemblies: what all finders of replacements share.
///
/// A candidate passes when its seams meet (`seam_residual`), the graph and the placed assembly keep
/// the rules, and no assembly that was made before is isomorphic to it, the inputs among them.
class VariationSearch {
 public:
  /// @param symmetries  whether assemblies that differ by symmetries of parts are the same
  VariationSearch(const AssemblyInput& input, bool symmetries, const SearchOptions& options);

  /// At most so many variations that one replacement makes of a state, in the order of the finder;
  /// at most three for one removed substructure, so that they are not all of one kind. Ends early
  /// when the run is to stop, or all candidates are spent.
  std::vector<Variation> expand(const Variation& state, ReplacementFinder& finder,
                                RunContext& context, int most);
  [[nodiscard]] bool is_spent() const { return counts_.candidates >= options_.candidates; }
  [[nodiscard]] const SearchCounts& counts() const { return counts_; }
  [[nodiscard]] const Objective& objective() const { return objective_; }

  /// Takes an assembly that was made otherwise. @return  whether it is valid and new
  bool accept(Variation& variation);
  /// Makes a replacement that is known to close. @return  whether it is valid and new
  bool consider(const Variation& state, const Replacement& replacement, Variation& out);

 private:
  /// @return  whether no assembly isomorphic to this one was made before
  bool is_new(const Assembly& assembly);
  bool keeps_rules(Variation& variation);
  bool passes_filter(const Assembly& host, const Replacement& replacement);

  const AssemblyInput& input_;
  bool symmetries_;
  SearchOptions options_;
  Objective objective_;
  SeamFilter filter_;
  SearchCounts counts_;
  /// All that were made, the inputs and those that broke a rule among them.
  std::unordered_set<CanonicalKey, CanonicalHash> made_;
};

/// Takes variations as they come: pushes a frame each, those that a resumed run has already left
/// out. The inputs are frames -(n - 1) ... 0.
class VariationFrames {
 public:
  VariationFrames(const AssemblyInput& input, FrameSink& sink, const std::optional<State>& resumed);
  void push_inputs();
  void push(const Variation& variation, const SearchCounts& counts);
  [[nodiscard]] int count() const { return variations_; }

 private:
  void push(Frame frame);

  const AssemblyInput& input_;
  FrameSink& sink_;
  int done_ = 0;    ///< frames of the run that is resumed
  int frames_ = 0;  ///< so far
  int variations_ = 0;
};

/// Makes the finder of a method. @param keep_alike  whether isomorphic substructures are kept apart
using FinderFactory = std::function<std::unique_ptr<ReplacementFinder>(
    const DonorSet& donors, bool keep_alike, RunContext& context)>;

/// Variations of the inputs, as the options order them.
std::unique_ptr<Process> variation_process(const AssemblyInput& input, FinderFactory factory,
                                           bool symmetries, const SearchOptions& options);

}  // namespace geoprior::assembly
