// Intervals, fronts and the comparison of two points on a machine of known truth: 400 trials, or 2,000 in the
// long tests (support/long_tests.h).
#include "frontier/simulated_machine.h"

#include <gmock/gmock.h>

#include "support/long_tests.h"

namespace lightgrid {
namespace {

int trials() { return long_tests() ? 2000 : 400; }

// Of shares of n trials the deviation is at most this.
double three_deviations(double share, int n) { return 3 * std::sqrt(share * (1 - share) / n); }

struct Coverage {
  int held = 0, all = 0, bimodal = 0;
};

Coverage coverage_on(const SimulatedMachine& machine, uint64_t seed) {
  std::mt19937_64 random(seed);
  Coverage c;
  const double truth = std::exp(0.3 * std::log(2.0));
  for (int trial = 0; trial < trials(); ++trial) {
    const RelativeTime r = relative_time(simulated_times(machine, {truth}, random)[0]);
    c.held += r.low <= truth && truth <= r.high, ++c.all;
    c.bimodal += !r.modes.empty();
  }
  return c;
}

TEST(SimulatedMachine, IntervalsHoldTheTruth) {
  const std::pair<const char*, SimulatedMachine> machines[] = {
      {"six rounds", {.rounds = 6}},
      {"eleven rounds", {}},
      {"forty rounds", {.rounds = 40}},
      {"heavy tails", {.rounds = 16, .heavy_tails = 0.1}},
      {"five processes", {.processes = 5, .rounds = 4, .process_noise = 0.02}},
      {"five processes of little noise of their own", {.processes = 5, .rounds = 4, .process_noise = 0.002}},
      {"ten processes", {.processes = 10, .rounds = 2, .process_noise = 0.03, .heavy_tails = 0.05}}};
  uint64_t seed = 1;
  for (const auto& [name, machine] : machines) {
    const Coverage c = coverage_on(machine, seed++);
    const double share = double(c.held) / c.all,
                 slack = trials() < 2000 ? three_deviations(0.95, c.all) : 0.02;
    EXPECT_NEAR(share, 0.95, slack) << name;
    EXPECT_EQ(c.bimodal, 0) << name;
    RecordProperty(std::string("coverage of ") + name, std::to_string(share));
  }
}

// Rounds alone do not know what differs between processes: the level is there for a reason.
TEST(SimulatedMachine, RoundsOfOneProcessMissWhatProcessesDifferIn) {
  const Coverage c = coverage_on({.rounds = 20, .process_noise = 0.02}, 21);
  EXPECT_LT(double(c.held) / c.all, 0.7);
}

TEST(SimulatedMachine, TwoModesAreMarkedAndHeld) {
  std::mt19937_64 random(3);
  const SimulatedMachine machine{.rounds = 16, .slow_mode = std::log(2.0)};
  int marked = 0, held = 0, others = 0;
  for (int trial = 0; trial < trials(); ++trial) {
    const auto times = simulated_times(machine, {0.8, 0.8}, random, 1);
    const RelativeTime r = relative_time(times[0]);
    marked += !r.modes.empty();
    held += r.low <= 0.8 && r.high >= 1.6 * 0.95;
    others += !relative_time(times[1]).modes.empty();
    if (r.modes.size() == 2) {
      EXPECT_NEAR(r.modes[0], 0.8, 0.05);
      EXPECT_NEAR(r.modes[1], 1.6, 0.1);
    }
  }
  // With less than two slow or two fast runs of 16 there are no two groups: one trial in 300.
  EXPECT_GE(marked, int(0.97 * trials()));
  EXPECT_GE(held, int(0.97 * trials()));
  EXPECT_EQ(others, 0);
}

// True times and errors are drawn anew in each trial; of the points whose probability is about p, the share p
// is on the front of the true times.
TEST(SimulatedMachine, ProbabilitiesOfTheFrontAreCalibrated) {
  for (const SimulatedMachine& machine :
       {SimulatedMachine{.rounds = 8},
        SimulatedMachine{.processes = 5, .rounds = 3, .process_noise = 0.015}}) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    constexpr int bins = 5;
    double stated[bins] = {}, found[bins] = {}, counted[bins] = {};
    for (int trial = 0; trial < trials(); ++trial) {
      std::vector<double> truths, errors;
      for (int i = 0; i < 12; ++i)
        truths.push_back(std::exp(0.1 * uniform(random))), errors.push_back(uniform(random));
      const auto draws = drawn_log_times(simulated_times(machine, truths, random), 0, 400, random());
      const std::vector<double> p = front_probabilities(draws, errors);
      std::vector<double> log_truths;
      for (const double truth : truths) log_truths.push_back(std::log(truth));
      const std::vector<double> front = front_probabilities({log_truths}, errors);
      for (size_t i = 0; i < p.size(); ++i) {
        const int bin = std::min(int(p[i] * bins), bins - 1);
        stated[bin] += p[i], found[bin] += front[i], ++counted[bin];
      }
    }
    for (int bin = 0; bin < bins; ++bin) {
      ASSERT_GT(counted[bin], 50) << bin;
      const double p = stated[bin] / counted[bin];
      EXPECT_NEAR(found[bin] / counted[bin], p, 0.02 + three_deviations(p, int(counted[bin])))
          << "bin " << bin;
      RecordProperty("front " + std::to_string(machine.processes) + " " + std::to_string(p),
                     std::to_string(found[bin] / counted[bin]));
    }
  }
}

// The probability that the first of two points of equal error is the faster one, as the front has it.
double first_is_faster(const SimulatedMachine& machine, double first, double second,
                       std::mt19937_64& random) {
  const auto draws = drawn_log_times(simulated_times(machine, {first, second}, random), 0, 1000, random());
  return front_probabilities(draws, std::vector<double>{0.1, 0.1})[0];
}

TEST(SimulatedMachine, FindsADifferenceOfTwoPerCentAndNoneWhereNoneIs) {
  std::mt19937_64 random(7);
  int found = 0, found_in_fewer = 0, false_alarms = 0;
  for (int trial = 0; trial < trials(); ++trial) {
    found += first_is_faster({.rounds = 16}, 0.98, 1, random) > 0.975;
    found_in_fewer += first_is_faster({.rounds = 11}, 0.98, 1, random) > 0.975;
    const double p = first_is_faster({.rounds = 11}, 1, 1, random);
    false_alarms += p > 0.975 || p < 0.025;
  }
  EXPECT_GE(double(found) / trials(), 0.9);           // 18 of 20
  EXPECT_GE(double(found_in_fewer) / trials(), 0.8);  // the signed-rank test: 0.85; Mann-Whitney: 0.2
  EXPECT_NEAR(double(false_alarms) / trials(), 0.05, three_deviations(0.05, trials()));
  RecordProperty("found in 16 rounds", std::to_string(double(found) / trials()));
  RecordProperty("found in 11 rounds", std::to_string(double(found_in_fewer) / trials()));
}

// The fastest of equal points leads by luck in the rounds that it was picked on, and not in the others.
TEST(SimulatedMachine, PicksAreReportedOnOtherRounds) {
  std::mt19937_64 random(9);
  double on_its_own = 0, on_the_others = 0;
  for (int trial = 0; trial < trials(); ++trial) {
    const auto times = simulated_times({.rounds = 12}, std::vector<double>(14, 1.0), random);
    size_t best = 0;
    const auto of = [&](size_t i, int parity) { return relative_time(half_of(times[i], parity)).estimate; };
    for (size_t i = 1; i < times.size(); ++i) {
      if (of(i, 0) < of(best, 0)) best = i;
    }
    on_its_own += std::log(of(best, 0)) / trials(), on_the_others += std::log(of(best, 1)) / trials();
  }
  EXPECT_LT(on_its_own, -0.005);
  EXPECT_NEAR(on_the_others, 0, 0.001);
}

// What a control finds wrong is in every interval.
TEST(SimulatedMachine, WidenedIntervalsHoldAControlsError) {
  std::mt19937_64 random(11);
  const LogTimes control = simulated_times({}, {1.08}, random)[0];
  const RelativeTime plain = relative_time(control),
                     widened = relative_time(control, std::log(plain.estimate));
  EXPECT_GT(plain.low, 1);
  EXPECT_LE(widened.low, 1);
  EXPECT_NEAR(std::log(widened.high / plain.high), std::log(plain.estimate), 1e-12);
}

}  // namespace
}  // namespace lightgrid
