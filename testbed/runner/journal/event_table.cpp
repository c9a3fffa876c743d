#include "testbed/runner/journal/event_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.h"
#include "testbed/runner/names.h"
#include "testbed/runner/number_text.h"

namespace geoprior {

namespace {

constexpr const char* kTable = "events";
constexpr std::array<std::string_view, 5> kFields{"time_s", "kind", "position", "energy_J",
                                                  "duration_s"};

bool is_field(std::string_view name) {
  return std::find(kFields.begin(), kFields.end(), name) != kFields.end();
}

/// name: its values, one an event.
std::map<std::string, std::vector<double>> number_columns(const std::vector<Event>& events) {
  const double absent = std::numeric_limits<double>::quiet_NaN();
  std::map<std::string, std::vector<double>> columns;
  for (std::size_t i = 0; i < events.size(); ++i) {
    for (const auto& [name, value] : events[i].numbers) {
      std::vector<double>& column =
          columns.try_emplace(name, std::vector<double>(events.size(), absent)).first->second;
      column[i] = value;
    }
  }
  return columns;
}

template <class T>
const std::vector<T>& values(const std::vector<H5Column>& table, std::size_t i) {
  return std::get<std::vector<T>>(table[i].values);
}

void read_numbers(const H5Column& column, const std::string& place, std::vector<Event>& events) {
  const auto* numbers = std::get_if<std::vector<double>>(&column.values);
  if (numbers == nullptr) throw Error("column '" + column.name + "' has no numbers", place);
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (!std::isnan((*numbers)[i])) events[i].numbers[column.name] = (*numbers)[i];
  }
}

}  // namespace

void write_events(H5Group& group, const std::vector<Event>& events) {
  std::vector<double> time, energy, duration;
  std::vector<std::string> kind;
  std::vector<std::array<double, 3>> position;
  for (const Event& event : events) {
    time.push_back(event.time_s);
    kind.push_back(event.kind);
    position.push_back({event.position.x(), event.position.y(), event.position.z()});
    energy.push_back(event.energy_J);
    duration.push_back(event.duration_s);
  }
  std::vector<H5Column> table{{"time_s", time},
                              {"kind", kind},
                              {"position", position},
                              {"energy_J", energy},
                              {"duration_s", duration}};
  for (const auto& [name, column] : number_columns(events)) table.push_back({name, column});
  group.write_table(kTable, table);
}

std::vector<Event> read_events(const H5Node& group) {
  std::vector<H5Column> fields{{"time_s", std::vector<double>{}},
                               {"kind", std::vector<std::string>{}},
                               {"position", std::vector<std::array<double, 3>>{}},
                               {"energy_J", std::vector<double>{}},
                               {"duration_s", std::vector<double>{}}};
  group.read_table(kTable, fields);
  std::vector<Event> events(values<double>(fields, 0).size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    events[i].time_s = values<double>(fields, 0)[i];
    events[i].kind = values<std::string>(fields, 1)[i];
    const std::array<double, 3>& x = values<std::array<double, 3>>(fields, 2)[i];
    events[i].position = {x[0], x[1], x[2]};
    events[i].energy_J = values<double>(fields, 3)[i];
    events[i].duration_s = values<double>(fields, 4)[i];
  }
  for (const H5Column& column : group.read_table(kTable)) {
    if (!is_field(column.name)) read_numbers(column, group.place() + "/" + kTable, events);
  }
  return events;
}

void require_event_numbers(const Event& event, const std::string& where) {
  for (const auto& [name, value] : event.numbers) {
    require_plain_name(name, "a number of an event", where);
    if (is_field(name)) {
      throw Error("'" + name + "' is a field of every event", where, "a number of another name");
    }
    if (!std::isfinite(value)) {
      throw Error("number '" + name + "' of the event '" + event.kind + "' at " +
                      number_text(event.time_s) + " s is not finite",
                  where, "leave out what has no value");
    }
  }
}

}  // namespace geoprior
