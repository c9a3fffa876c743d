#include "solvers/details/triplet_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/limits.h"
#include "core/parallel.h"
#include "solvers/details/triplet_builder.h"

namespace geoprior::details {
namespace {

/// Details whose surroundings are searched at most. Chosen: at some 85 triplets each
/// (details/ablations, diagnostic triplets_met) they about fill the default table, 24 in each of
/// 128 x 128 cells.
constexpr std::size_t kMostSources = 4000;

/// Sources whose surroundings are searched: details, evenly spread over their numbers.
std::vector<int> sources_of(const DetailMesh& original, const TripletOptions& options) {
  std::vector<int> details;
  for (int i = 0; i < original.site_slots(); ++i)
    if (original.is_detail(i)) details.push_back(i);
  if (options.all && details.size() > 400) {
    throw Error("all triplets of " + std::to_string(details.size()) + " details", "triplets",
                "at most 400 details, or local triplets");
  }
  if (options.all || details.size() <= kMostSources) return details;
  std::vector<int> some;
  for (std::size_t i = 0; i < kMostSources; ++i)
    some.push_back(details[i * details.size() / kMostSources]);
  return some;
}

/// A full table: its interiors are numbered with 32 bits.
void require_table(const TripletOptions& options) {
  const double triplets =
      static_cast<double>(options.cells) * options.cells * options.cell_capacity;
  const double interiors = triplets * kMostInside;
  const std::string where = "options.triplets.cells";
  require_memory(triplets * sizeof(FoundTriplet) + interiors * sizeof(TripletInterior), triplets,
                 "triplets", where);
  require_count(interiors, "details inside of triplets", std::numeric_limits<int>::max(), where);
}

/// Keeps a random choice of the triplets met in every cell (reservoir sampling, Vitter 1985).
class Reservoirs {
 public:
  Reservoirs(int cells, int capacity, std::uint64_t seed)
      : capacity_(capacity),
        kept_(static_cast<std::size_t>(cells) * cells),
        seen_(kept_.size(), 0),
        random_(seed, "triplets") {}

  void offer(FoundTriplet& triplet) {
    auto& cell = kept_[triplet.cell];
    const std::uint32_t seen = ++seen_[triplet.cell];
    if (cell.size() < capacity_) {
      cell.push_back(std::move(triplet));
      return;
    }
    const std::uint32_t place = random_.below(seen);
    if (place < capacity_) cell[place] = std::move(triplet);
  }
  [[nodiscard]] const std::vector<std::vector<FoundTriplet>>& kept() const { return kept_; }

 private:
  std::size_t capacity_;
  std::vector<std::vector<FoundTriplet>> kept_;
  std::vector<std::uint32_t> seen_;
  RandomStream random_;
};

}  // namespace

TripletTable::TripletTable(const DetailMesh& original, const TripletOptions& options,
                           std::uint64_t seed)
    : cells_(options.cells) {
  require_table(options);
  const double mean = mean_edge(original);
  const std::vector<int> sources = sources_of(original, options);
  Reservoirs reservoirs(cells_, options.cell_capacity, seed);
  constexpr std::size_t kBatch = 64, kBlock = 4;
  std::vector<TripletSearch> search(kBatch / kBlock, TripletSearch(original, options, mean));
  largest_area_ = search[0].largest_area();
  for (std::size_t first = 0; first < sources.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, sources.size() - first);
    std::vector<std::vector<FoundTriplet>> found(search.size());
    std::vector<std::int64_t> met(search.size(), 0);
    parallel_blocks(count, kBlock, [&](std::size_t begin, std::size_t end) {
      const std::size_t block = begin / kBlock;
      for (std::size_t i = begin; i < end; ++i)
        search[block].around(sources[first + i], found[block], met[block]);
    });
    for (std::size_t block = 0; block < found.size(); ++block) {
      met_ += met[block];
      for (FoundTriplet& triplet : found[block]) reservoirs.offer(triplet);
    }
  }
  for (const auto& cell : reservoirs.kept()) {
    cell_begin_.push_back(static_cast<int>(entry_.size()));
    for (const FoundTriplet& triplet : cell) {
      entry_.push_back({triplet.corner, triplet.edge, static_cast<std::int32_t>(interior_.size()),
                        triplet.clockwise});
      interior_.insert(interior_.end(), triplet.interior.begin(), triplet.interior.end());
    }
  }
  cell_begin_.push_back(static_cast<int>(entry_.size()));
  entry_.shrink_to_fit();
  interior_.shrink_to_fit();
}

std::span<const TripletInterior> TripletTable::interior(int triplet) const {
  const std::size_t begin = entry_[triplet].interior_begin;
  const auto end = static_cast<std::size_t>(triplet) + 1 < entry_.size()
                       ? static_cast<std::size_t>(entry_[triplet + 1].interior_begin)
                       : interior_.size();
  return {interior_.data() + begin, end - begin};
}

const std::array<int, 3>& TripletTable::corners(int triplet) const {
  return entry_[triplet].corner;
}

std::size_t TripletTable::bytes() const {
  return entry_.size() * sizeof(Entry) + interior_.size() * sizeof(TripletInterior) +
         cell_begin_.size() * sizeof(int);
}

void TripletTable::search_cell(int cell, const std::array<double, 3>& sorted, int max_interior,
                               int count, std::vector<TripletMatch>& into) const {
  for (int e = cell_begin_[cell]; e < cell_begin_[cell + 1]; ++e) {
    const auto inside = static_cast<int>(interior(e).size());
    if (inside < 1 || inside > max_interior) continue;
    double difference = 0;
    for (std::size_t k = 0; k < 3; ++k)
      difference += std::abs(sorted[k] - static_cast<double>(entry_[e].edge[k]));
    const bool full = std::ssize(into) == count;
    if (full && difference >= into.back().edge_difference) continue;
    if (full) into.pop_back();
    const auto place = std::upper_bound(
        into.begin(), into.end(), difference,
        [](double d, const TripletMatch& other) { return d < other.edge_difference; });
    into.insert(place, TripletMatch{e, {}, false, difference});
  }
}

void TripletTable::closest(const std::array<double, 3>& edges, int max_interior, int count,
                           std::vector<TripletMatch>& into) const {
  into.clear();
  if (entry_.empty() || max_interior < 1) return;
  std::array<double, 3> sorted = edges;
  std::sort(sorted.begin(), sorted.end());
  const auto [u, v] = triplet_cell(keys_of(edges), largest_area_, cells_);
  int last = cells_ - 1;
  for (int ring = 0; ring <= last; ++ring) {
    for (int i = std::max(0, u - ring); i <= std::min(cells_ - 1, u + ring); ++i) {
      const bool rim = i == u - ring || i == u + ring;
      const int step = rim || ring == 0 ? 1 : 2 * ring;
      for (int j = v - ring; j <= v + ring; j += step)
        if (j >= 0 && j < cells_) search_cell(i * cells_ + j, sorted, max_interior, count, into);
    }
    if (!into.empty() && last == cells_ - 1) last = std::min(ring + 1, cells_ - 1);
  }
  // Edges in sorted order fit best of all six ways: corner k of the triplets, whose edges are
  // sorted, goes to corner by_edges[k] of the triangle.
  const auto by_edges = corners_by_edges(edges);
  std::array<int, 3> order{};
  for (int k = 0; k < 3; ++k) order[by_edges[k]] = k;
  const bool odd = (order[1] - order[0] + 3) % 3 != 1;
  for (TripletMatch& match : into) {
    match.order = order;
    match.mirrored = entry_[match.triplet].clockwise != odd;
  }
}

}  // namespace geoprior::details
