// The further numbers of events in the journal, in run.h5 and in the content hash.

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>

#include "testbed/formats/hdf5/content.h"
#include "testbed/runner/journal/content_hash.h"
#include "testbed/runner/journal/event_table.h"
#include "testbed/runner/journal/journal.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Event crossing() { return {0.5, "crossing", {1, 2, 3}, 0.25, 0.125}; }

Event with(const std::string& name, double value) {
  Event event = crossing();
  event.numbers[name] = value;
  return event;
}

RunRecord record_of(const std::vector<Event>& events) {
  RunRecord record;
  record.experiment_id = "toy/events";
  CaseRecord one;
  one.name = "default";
  VariantRecord variant;
  variant.name = "v";
  variant.events = events;
  one.variants = {variant};
  record.cases = {one};
  return record;
}

Event through_journal(const Event& event) {
  const std::string text = journal::to_text(journal::EventLine{{"default", "v"}, event});
  return std::get<journal::EventLine>(journal::from_text(text)).event;
}

TEST(EventNumbers, GoThroughTheJournalBitByBit) {
  Event event = with("l_r_m", 0.1);
  event.numbers["tiny"] = std::numeric_limits<double>::denorm_min();
  event.numbers["sample"] = 255;
  EXPECT_EQ(through_journal(event).numbers, event.numbers);
}

// The line as versions without further numbers wrote it, and write it still.
TEST(EventNumbers, AreAbsentInLinesOfOlderJournals) {
  const std::string old =
      R"({"case":"default","duration_s":0.125,"energy_J":0.25,"kind":"event",)"
      R"("kind_of_event":"crossing","position":[1.0,2.0,3.0],"time_s":0.5,"variant":"v"})";
  EXPECT_TRUE(std::get<journal::EventLine>(journal::from_text(old)).event.numbers.empty());
  EXPECT_EQ(journal::to_text(journal::EventLine{{"default", "v"}, crossing()}), old);
}

// The line of the format's first version: no blessed content changes.
TEST(EventNumbers, AreHashedAndAnEventWithoutThemHashesAsBefore) {
  const std::string without = content_text(record_of({crossing()}));
  EXPECT_THAT(without, HasSubstr("event 0x1p-1 crossing 0x1p+0 0x1p+1 0x1.8p+1 0x1p-2 0x1p-3\n"));
  Event two = with("sample", 3);
  two.numbers["area_m2"] = 0.5;
  EXPECT_THAT(content_text(record_of({two})),
              HasSubstr(" 0x1p-2 0x1p-3 area_m2=0x1p-1 sample=0x1.8p+1\n"));
  EXPECT_NE(content_sha256(record_of({with("sample", 3)})),
            content_sha256(record_of({with("sample", std::nextafter(3.0, 4.0))})));
  EXPECT_NE(content_sha256(record_of({with("sample", 3)})),
            content_sha256(record_of({with("l_r_m", 3)})));
}

class EventTable : public RunTest {
 protected:
  [[nodiscard]] std::vector<std::string> columns_of(const std::vector<Event>& events) const {
    write_run_file(record_of(events), folder() / "run.h5");
    std::vector<std::string> names;
    const H5Node variant = read_hdf5(folder() / "run.h5")
                               .open_group("cases")
                               .open_group("default")
                               .open_group("variants");
    for (const H5Column& column : variant.open_group("v").read_table("events")) {
      names.push_back(column.name);
    }
    return names;
  }
};

TEST_F(EventTable, HasTheFieldsAloneWhereNoEventHasFurtherNumbers) {
  EXPECT_THAT(columns_of({crossing()}),
              ElementsAre("time_s", "kind", "position", "energy_J", "duration_s"));
  EXPECT_EQ(columns_of({}).size(), 5U);
}

TEST_F(EventTable, HasAColumnForEachNumberThatSomeEventHas) {
  const std::vector<Event> events{with("sample", 3), crossing(), with("area_m2", 0)};
  EXPECT_THAT(columns_of(events), ElementsAre("time_s", "kind", "position", "energy_J",
                                              "duration_s", "area_m2", "sample"));
  const auto read = read_run_file(folder() / "run.h5").cases.at(0).variants.at(0).events;
  ASSERT_EQ(read.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(read[i].numbers, events[i].numbers) << i;
}

TEST_F(EventTable, WithAFurtherColumnOfTextIsRefused) {
  const H5File other = H5File::create();
  other.root().write_table("events", {{"time_s", std::vector<double>{0}},
                                      {"kind", std::vector<std::string>{"a"}},
                                      {"position", std::vector<std::array<double, 3>>{{0, 0, 0}}},
                                      {"energy_J", std::vector<double>{0}},
                                      {"duration_s", std::vector<double>{0}},
                                      {"class", std::vector<std::string>{"flap"}}});
  other.save(folder() / "other.h5");
  const H5Node root = read_hdf5(folder() / "other.h5");
  EXPECT_THAT(error_of([&] { (void)read_events(root); }), HasSubstr("column 'class'"));
}

TEST(EventNumbers, ThatNoTableCanHoldAreRefused) {
  require_event_numbers(with("l_r_m", 0.1), "here");
  EXPECT_THAT(error_of([] { require_event_numbers(with("energy_J", 1), "variant 'v'"); }),
              ::testing::AllOf(HasSubstr("'energy_J'"), HasSubstr("variant 'v'")));
  EXPECT_THAT(error_of([] { require_event_numbers(with("l r", 1), "here"); }), HasSubstr("'l r'"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error_of([&] { require_event_numbers(with("l_c_m", nan), "here"); }),
              ::testing::AllOf(HasSubstr("'l_c_m'"), HasSubstr("crossing"), HasSubstr("0.5 s")));
}

// Numbers of the toy's crossings: the energy is half the square of the speed (unit mass).
TEST_F(EventTable, OfARunHasTheNumbersOfTheMethod) {
  const ExecuteResult result = run(load(pendulum()), folder() / "out");
  const std::vector<Event> read =
      read_run_file(result.folder / "run.h5").cases.at(0).variants.at(0).events;
  ASSERT_FALSE(read.empty());
  for (const Event& event : read) {
    const double speed = event.numbers.at("speed_m_s");
    EXPECT_DOUBLE_EQ(event.energy_J, 0.5 * speed * speed);
  }
}

}  // namespace
}  // namespace geoprior::test
