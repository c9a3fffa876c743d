#pragma once

#include <string>
#include <vector>

#include "core/frame.h"
#include "testbed/formats/hdf5/content.h"

namespace geoprior {

/// Writes the table `events` of a variant: a row an event, as recorded. Behind the fields that all
/// events have, each number that some event has is a column, NaN where another event has it not.
void write_events(H5Group& group, const std::vector<Event>& events);

/// The events of that table. @throws Error  for a further column that is not of numbers
std::vector<Event> read_events(const H5Node& group);

/// @param where  what the event belongs to
/// @throws Error  for an event whose numbers the table cannot hold: a name that is no plain name or
/// that of a field, a value that is not finite
void require_event_numbers(const Event& event, const std::string& where);

}  // namespace geoprior
