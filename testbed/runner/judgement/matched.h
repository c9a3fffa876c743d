#pragma once

#include <vector>

#include "core/random.h"
#include "testbed/runner/judgement/interval.h"
#include "testbed/runner/spec/terms.h"

namespace geoprior {

/// What a variant costs and what its quality is, one value a case.
struct Priced {
  std::vector<double> cost;       ///< s, or what else is compared
  std::vector<double> quality;    ///< an error, or a quantity that the truth has, too
  std::vector<double> kept = {};  ///< what rivals may not pay with, more is better; or empty
};

/// A method, rivals of many resolutions, and what is right.
struct Matched {
  Priced method;
  std::vector<std::vector<Priced>> families;  ///< each from coarse to fine
  std::vector<double> truth;                  ///< of each case; empty: qualities are errors
  Reduction cost = Reduction::median;         ///< over the cases: median or mean
  double within = 0;  ///< how much less of `kept` a rival may have than the method
};

/// How far off a variant is: the mean of its errors; with a truth the first Wasserstein distance of
/// the two samples (mean difference of their sorted values), since where a motion bifurcates only
/// distributions can agree.
double error_of(const Priced& variant, const std::vector<double>& truth);

/// Median or mean over the cases.
double cost_of(const Priced& variant, Reduction over);

/// What the cheapest family costs at the method's error, over what the method costs: above 1 the
/// method is cheaper than its rivals at their equal. Of a family the cost is interpolated between
/// the two members about that error, linearly in the logarithms, along the best error so far; it is
/// that of the first member where that errs no more than the method, and infinite where none does,
/// or where the family has less of `kept` there (mean of the cases, interpolated likewise).
double matched_ratio(const Matched& all);

/// The same with its 95 % percentile bootstrap interval (2000 resamples of the cases, which all
/// variants share). Of one case there is no interval (NaN).
Interval matched_with_interval(const Matched& all, RandomStream random);

}  // namespace geoprior
