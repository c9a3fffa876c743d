#include "models/assembly/search/seam_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "models/assembly/exchange/embedding.h"
#include "models/assembly/graph/labels.h"

namespace geoprior::assembly {
namespace {

double port_height(const Assembly& assembly, const std::vector<PartType>& types, PortRef ref) {
  const PlacedPart& part = assembly.parts[ref.part];
  return part.pose.linear().row(2).dot(types[part.type].ports[ref.port].frame.translation()) +
         part.pose.translation().z();
}

bool is_within(const std::optional<PartCount>& rule, int count) {
  return !rule || (count >= rule->least && count <= rule->most);
}

}  // namespace

SeamFilter::SeamFilter(const AssemblyInput& input, const JointTolerance& tolerance, bool symmetries)
    : input_(input), tolerance_(tolerance), symmetries_(symmetries) {
  const Rules& rules = input.rules;
  for (const PartType& type : input.set.types) {
    is_entry_.push_back(rules.entries && is_among(rules.entries->labels, type.label));
    is_exit_.push_back(rules.exits && is_among(rules.exits->labels, type.label));
    is_grounded_.push_back(is_among(rules.grounded, type.label));
    bill_of_.push_back(-1);
    for (std::size_t i = 0; i < rules.bill.size(); ++i)
      if (is_meant(rules.bill[i].label, type.label)) bill_of_.back() = static_cast<int>(i);
  }
}

SeamFilter::Counts SeamFilter::counts_of(const Assembly& assembly, const PartSet* parts) const {
  Counts out;
  out.bill.assign(input_.rules.bill.size(), 0);
  const auto count = [&](int part) {
    const int type = assembly.parts[part].type;
    ++out.parts;
    out.entries += is_entry_[type];
    out.exits += is_exit_[type];
    if (bill_of_[type] >= 0) ++out.bill[bill_of_[type]];
  };
  if (parts != nullptr)
    for (const int part : parts->parts()) count(part);
  else
    for (int part = 0; part < static_cast<int>(assembly.parts.size()); ++part) count(part);
  return out;
}

void SeamFilter::look_at_host(const Assembly& host, const Substructure& removed) {
  const std::vector<PartType>& types = input_.set.types;
  removed_ = {};
  removed_.counts = counts_of(host, &removed.parts);
  removed_.pieces = pieces_outside(host, removed.parts);
  std::vector<char> stands(host.parts.size(), 0);
  for (std::size_t i = 0; i < host.parts.size(); ++i)
    if (is_grounded_[host.parts[i].type] && !removed.parts.has(static_cast<int>(i)))
      stands[removed_.pieces[i]] = 1;
  std::vector<int> at_seams;
  for (const int c : removed.boundary) {
    const PortRef outer = outside_end(host.connections[c], removed.parts);
    at_seams.push_back(removed_.pieces[outer.part]);
    removed_.held.push_back(stands[at_seams.back()]);
    removed_.heights.push_back(port_height(host, types, outer));
  }
  removed_.pieces = at_seams;
  std::sort(at_seams.begin(), at_seams.end());
  removed_.has_shared_piece =
      std::adjacent_find(at_seams.begin(), at_seams.end()) != at_seams.end();
}

SeamFilter::Looked& SeamFilter::look_at_donor(int number, int donor, const Substructure& inserted) {
  if (number >= 0)
    if (const auto found = inserted_.find(number); found != inserted_.end()) return found->second;
  Looked out;
  const Assembly& model = input_.set.models[donor];
  out.counts = counts_of(model, &inserted.parts);
  for (const int part : inserted.parts.parts())
    out.stands = out.stands || is_grounded_[model.parts[part].type];
  for (const int c : inserted.boundary)
    out.heights.push_back(
        port_height(model, input_.set.types, inside_end(model.connections[c], inserted.parts)));
  if (number < 0) return unnumbered_ = std::move(out);
  return inserted_[number] = std::move(out);
}

bool SeamFilter::counts_hold(const Counts& inserted) const {
  const Rules& rules = input_.rules;
  const Counts& removed = removed_.counts;
  if (whole_.parts - removed.parts + inserted.parts > rules.parts) return false;
  for (std::size_t i = 0; i < rules.bill.size(); ++i)
    if (whole_.bill[i] - removed.bill[i] + inserted.bill[i] > rules.bill[i].most) return false;
  return is_within(rules.entries, whole_.entries - removed.entries + inserted.entries) &&
         is_within(rules.exits, whole_.exits - removed.exits + inserted.exits);
}

bool SeamFilter::floor_holds(const Assembly& host, const Replacement& replacement,
                             const Looked& inserted) const {
  std::optional<double> lift;
  if (inserted.stands) lift = 0;
  const Assembly& model = input_.set.models[replacement.donor];
  for (std::size_t k = 0; k < removed_.held.size(); ++k) {
    if (!removed_.held[k]) continue;
    const double lifted = removed_.heights[k] - inserted.heights[replacement.match[k]];
    if (!lift) {
      lift = lifted;
      continue;
    }
    if (std::abs(lifted - *lift) <= 2 * input_.rules.ground_tolerance + tolerance_.translation)
      continue;
    const Pose outer = port_pose(
        host, input_.set.types,
        outside_end(host.connections[replacement.removed.boundary[k]], replacement.removed.parts));
    const Pose inner =
        port_pose(model, input_.set.types,
                  inside_end(model.connections[replacement.inserted.boundary[replacement.match[k]]],
                             replacement.inserted.parts));
    const Pose motion = mated(outer) * inner.inverse();
    constexpr double kUpright = 1 - 1e-6;
    if (motion.linear()(2, 2) > kUpright) return false;
  }
  return true;
}

bool SeamFilter::is_same(const Assembly& host, const Replacement& replacement, Looked& inserted) {
  const auto key = [&](Looked& looked, const Assembly& assembly, const PartSet& parts,
                       const std::vector<int>& seams) {
    const auto [found, is_new] = looked.keys.try_emplace(seams);
    if (is_new) {
      std::vector<int> places(seams.size());
      std::iota(places.begin(), places.end(), 0);
      found->second = canonical_key(assembly, input_.set.types, parts, seams, places, symmetries_);
    }
    return found->second;
  };
  if (removed_.counts.parts != inserted.counts.parts) return false;
  std::vector<int> seams;
  for (const int m : replacement.match) seams.push_back(replacement.inserted.boundary[m]);
  return key(removed_, host, replacement.removed.parts, replacement.removed.boundary) ==
         key(inserted, input_.set.models[replacement.donor], replacement.inserted.parts, seams);
}

void SeamFilter::begin(const Assembly& host) {
  whole_ = counts_of(host, nullptr);
  host_number_.reset();
}

void SeamFilter::turn_to(const Assembly& host, const Replacement& replacement) {
  if (host_number_ == replacement.removed_number) return;
  host_number_ = replacement.removed_number;
  look_at_host(host, replacement.removed);
}

bool SeamFilter::is_same(const Assembly& host, const Replacement& replacement) {
  turn_to(host, replacement);
  return is_same(
      host, replacement,
      look_at_donor(replacement.inserted_number, replacement.donor, replacement.inserted));
}

SeamFilter::Verdict SeamFilter::look(const Assembly& host, const Replacement& replacement) {
  turn_to(host, replacement);
  Looked& inserted =
      look_at_donor(replacement.inserted_number, replacement.donor, replacement.inserted);
  if (!counts_hold(inserted.counts)) return Verdict::counts;
  if (!floor_holds(host, replacement, inserted)) return Verdict::floor;
  if (removed_.has_shared_piece &&
      !within(seam_residual(host, input_.set.models[replacement.donor], input_.set.types,
                            replacement, removed_.pieces),
              tolerance_))
    return Verdict::seams;
  return is_same(host, replacement, inserted) ? Verdict::same : Verdict::passes;
}

}  // namespace geoprior::assembly
