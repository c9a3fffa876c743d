#include "solvers/details/triplet_options.h"

namespace geoprior::details {

void describe(OptionVisitor& v, TripletOptions& options) {
  v.value("radius", options.radius,
          {.doc = "R: the largest edge of a triplet, in mean edges of M_d", .min = 1, .max = 10});
  v.value("all", options.all,
          {.doc = "all triplets whatever their size, as the thesis says (at most 400 details)"});
  v.value("interior_only", options.interior_only,
          {.doc = "only triplets with a detail strictly inside"});
  v.value("cells", options.cells,
          {.doc = "cells of the table along each of its two keys", .min = 4, .max = 1024});
  v.value("cell_capacity", options.cell_capacity,
          {.doc = "triplets kept in a cell of the table", .min = 1, .max = 1024});
}

}  // namespace geoprior::details
