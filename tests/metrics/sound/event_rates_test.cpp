#include "metrics/sound/event_rates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/random.h"

namespace geoprior {
namespace {

Event event_of(double time_s, const std::string& kind, double energy_J = 0) {
  Event event;
  event.time_s = time_s;
  event.kind = kind;
  event.energy_J = energy_J;
  return event;
}

TEST(EventRates, AreByKindAndOfAll) {
  const std::vector<Event> events{event_of(3, "crac", 1), event_of(0.5, "flap", 2),
                                  event_of(1, "crac", 4), event_of(1.5, "crac", 8)};
  const std::map<std::string, EventRate> rates = event_rates(events, 4, 1);
  ASSERT_EQ(rates.size(), 3u);
  EXPECT_EQ(rates.at("crac").count, 3);
  EXPECT_DOUBLE_EQ(rates.at("crac").rate_per_s, 0.75);
  EXPECT_DOUBLE_EQ(rates.at("crac").energy_J, 13);
  EXPECT_DOUBLE_EQ(*rates.at("crac").median_interval_s, 0.5);  // the lower of 0.5 and 1.5
  EXPECT_FALSE(rates.at("flap").median_interval_s);
  EXPECT_EQ(rates.at("").count, 4);
  EXPECT_DOUBLE_EQ(rates.at("").energy_J, 15);
  // Counts 1, 2, 0, 1: variance 1/2 over mean 1.
  EXPECT_DOUBLE_EQ(*rates.at("").fano_factor, 0.5);
}

TEST(EventRates, OfAClockVaryNot) {
  std::vector<Event> events;
  for (int i = 0; i < 100; ++i) events.push_back(event_of(0.05 + 0.1 * i, "tick"));
  const EventRate rate = event_rates(events, 10, 0.5).at("tick");
  EXPECT_EQ(*rate.fano_factor, 0);
  EXPECT_NEAR(*rate.median_interval_s, 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(rate.rate_per_s, 10);
}

// Independent events: the Fano factor of w windows spreads by sqrt(2 / w) about 1, the median
// interval is ln 2 over the rate. In bursts of 5 at a time it is 5.
TEST(EventRates, OfIndependentEventsHaveAFanoFactorOfOne) {
  RandomStream random(1, "events");
  std::vector<Event> events, bursts;
  for (int i = 0; i < 20000; ++i) events.push_back(event_of(1000 * random.uniform(), "pop"));
  for (int i = 0; i < 4000; ++i) bursts.insert(bursts.end(), 5, events[i]);
  const EventRate rate = event_rates(events, 1000, 0.1).at("pop");
  EXPECT_NEAR(*rate.fano_factor, 1, 4 * std::sqrt(2e-4));
  EXPECT_NEAR(*rate.median_interval_s, std::log(2) / 20, 0.002);
  EXPECT_NEAR(*event_rates(bursts, 1000, 0.1).at("pop").fano_factor, 5, 0.5);
}

TEST(EventRates, OfNoEventsAreZero) {
  const std::map<std::string, EventRate> rates = event_rates({}, 10);
  ASSERT_EQ(rates.size(), 1u);
  EXPECT_EQ(rates.at("").count, 0);
  EXPECT_EQ(rates.at("").rate_per_s, 0);
  EXPECT_FALSE(rates.at("").fano_factor);
}

TEST(EventRates, NameWhatIsWrong) {
  EXPECT_THROW(event_rates({}, 0), Error);
  EXPECT_THROW(event_rates({}, 1, 0), Error);
  EXPECT_THROW(event_rates({}, 1, 1e-12), Error);
  EXPECT_THROW(event_rates(std::vector{event_of(2, "a")}, 1), Error);
  EXPECT_THROW(event_rates(std::vector{event_of(0.5, "a", -1)}, 1), Error);
  EXPECT_THROW(event_rates(std::vector{event_of(std::nan(""), "a")}, 1), Error);
}

TEST(EventEnergyExponent, IsThatOfItsKindAlone) {
  RandomStream random(3, "energies");
  std::vector<Event> events;
  for (int i = 0; i < 2000; ++i) {
    events.push_back(event_of(0, "crac", std::pow(1 - random.uniform(), -1 / 0.45)));
    events.push_back(event_of(0, "flap", 1 + random.uniform()));
  }
  const PowerLawFit crac = event_energy_exponent(events, "crac");
  EXPECT_NEAR(crac.exponent, 1.45, 0.05);
  EXPECT_EQ(event_energy_exponent(events, "flap").count, 0);  // within an octave
  EXPECT_FALSE(event_energy_exponent(events, "flap").withheld.empty());
  EXPECT_FALSE(event_energy_exponent(events, "").withheld.empty());  // a mixture
}

TEST(EventEnergyExponent, TakesTheEnergiesInTheOrderOfTime) {
  std::vector<Event> events;
  for (int i = 0; i < 600; ++i) {
    events.push_back(event_of((i * 7) % 600, "crac", std::pow(10., ((i * 7) % 600) / 100.)));
  }
  EXPECT_GT(event_energy_exponent(events, "crac").serial_correlation, 0.99);
}

}  // namespace
}  // namespace geoprior
