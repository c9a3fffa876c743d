#pragma once

#include <span>
#include <vector>

#include "solvers/fluid/tracking/motion.h"
#include "solvers/fluid/tracking/track.h"

namespace geoprior::fluid {

/// What a path cover cannot say: where tracks touch.
///  - split: a track begins where a region of another, which goes on, was in the frame before;
///  - merge: a track ends where a region of another, which was there already, is in the next frame;
///  - causes: an isolated track ends, and a differential one that no split began begins close to
///    where it was heading, within a quarter of a second and six cells beside its radius. Every
///    wave has one cause at most, the nearest.
/// Regions are where their motion takes them; they overlap when the smaller one's cubes (two cells,
/// give or take one) are shared by three in ten. An end in the last frame is no end, a
/// beginning in the first no beginning.
/// @return  by frame, kind, from, to
std::vector<TrackEvent> track_events(std::span<const Region> regions, std::span<const double> times,
                                     double cell, const TrackingOptions& options,
                                     const std::vector<Track>& tracks,
                                     const std::vector<int>& successor,
                                     const RegionMotions& motions);

/// Share of the smaller support that the other one covers, a cube around included, after `a` has
/// moved by `shift` (m); supports have cubes of two cells.
double support_overlap(const Region& a, const Region& b, const Eigen::Vector3d& shift, double cell);

}  // namespace geoprior::fluid
