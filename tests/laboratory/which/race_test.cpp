// The race's decisions on simulated times whose fastest runner is known.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "which/race.h"

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;

// Runner 0 is the fastest. Frames scatter by their runner's own deviation, some are interrupted, and each round has
// its own speed.
struct Simulation {
  std::vector<double> log_times;
  double deviation = 0.02, interrupted = 0;
  bool unequal_deviations = false;
  int max_rounds = 20;
};

struct Outcome {
  size_t won = 0, dropped = 0;  // trials in which runner 0 led at the end, and in which it was dropped
  double rounds = 0, left = 0;  // sums over the trials
};

constexpr int trials = 200;

Outcome outcome_of(const Simulation& s) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::exponential_distribution<double> interruption(1 / 0.3);
  std::uniform_real_distribution<double> uniform;
  Outcome outcome;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> deviations(s.log_times.size(), s.deviation);
    if (s.unequal_deviations)
      for (double& d : deviations) d *= std::exp(0.6 * normal(random));
    Race race(s.log_times.size());
    std::vector<RaceTime> times(s.log_times.size());
    while (race.rounds() < s.max_rounds && race.competing().size() > 1) {
      const double speed = 0.1 * normal(random);
      for (size_t i = 0; i < times.size(); ++i) {
        times[i].wall_ms = 0;
        for (int frame = 0; frame < 2; ++frame) {
          const double late = uniform(random) < s.interrupted ? interruption(random) : 0;
          times[i].wall_ms += 10 * std::exp(s.log_times[i] + speed + late + deviations[i] * normal(random));
        }
      }
      race.add_round(times);
      race.drop_slower();
    }
    outcome.won += race.leader() == 0;
    outcome.dropped += race.competing().front() != 0;
    outcome.rounds += race.rounds();
    outcome.left += double(race.competing().size());
  }
  return outcome;
}

// 15 runners; the second is slower by `gap`, each further one by `step` more.
std::vector<double> field(double gap, double step) {
  std::vector<double> log_times = {0};
  for (int i = 0; i < 14; ++i) log_times.push_back(gap + step * i);
  return log_times;
}

TEST(Race, FindsTheFastestAndEndsEarly) {
  const Outcome o = outcome_of({.log_times = field(0.05, 0.03)});
  EXPECT_GE(o.won, 0.95 * trials);
  EXPECT_LE(o.dropped, 0.05 * trials);
  EXPECT_LE(o.rounds / trials, 8) << "20 rounds were possible";
  EXPECT_LE(o.left / trials, 1.05);
}

TEST(Race, FindsTheFastestOnASharedMachine) {
  const Outcome o =
      outcome_of({.log_times = field(0.05, 0.03), .interrupted = 0.1, .unequal_deviations = true});
  EXPECT_GE(o.won, 0.95 * trials);
  EXPECT_LE(o.dropped, 0.05 * trials);
}

TEST(Race, FindsTheFasterOfTwo) {
  const Outcome o = outcome_of({.log_times = {0, 0.03}, .unequal_deviations = true});
  EXPECT_GE(o.won, 0.95 * trials);
  EXPECT_LE(o.dropped, 0.05 * trials);
}

// The hardest case: the fastest is compared with whichever of 14 rivals looks fastest, at each of 19 checks.
TEST(Race, SeldomDropsTheFastestAmongNearlyEqualRunners) {
  for (const bool unequal : {false, true}) {
    const Outcome o = outcome_of({.log_times = field(0.002, 0), .unequal_deviations = unequal});
    EXPECT_LE(o.dropped, 0.05 * trials) << unequal;
  }
}

TEST(Race, ASlowRunnerIsDroppedOnceItIsSure) {
  Race race(3);
  const auto round = [&](double a, double b, double c) {
    race.add_round(std::vector<RaceTime>{{a}, {b}, {c}});
    return race.drop_slower();
  };
  EXPECT_THAT(round(10, 10.1, 30), ElementsAre()) << "one round has no spread";
  EXPECT_THAT(round(20, 19.8, 61), ElementsAre(2));
  round(10, 10.2, 30.2);
  round(10, 9.9, 29.9);
  EXPECT_THAT(race.competing(), ElementsAre(0, 1));
  EXPECT_EQ(race.rounds(), 4);
  EXPECT_FALSE(race.is_decided());
}

TEST(Race, EqualRunnersEndIt) {
  Race race(2);
  int round = 0;
  do {
    ++round;
    race.add_round(std::vector<RaceTime>{{10 + 0.01 * (round % 3)}, {10.005 + 0.01 * (round % 2)}});
    race.drop_slower();
  } while (!race.is_decided() && round < 100);
  EXPECT_EQ(round, StopRule::least);
}

// Work in other processes disturbs wall-clock time, not the time of this process.
TEST(Race, TheOtherClockDecidesWhereWallClockTimeScatters) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Race noisy(2), steady(2), spread_work(2);
  for (int i = 0; i < 12; ++i) {
    const double a = std::exp(0.3 * normal(random)), b = std::exp(0.3 * normal(random)),
                 c = 1 + 0.001 * normal(random), d = 1 + 0.001 * normal(random);
    noisy.add_round(std::vector<RaceTime>{{10 * a, 20 * c}, {10 * b, 21 * d}});
    steady.add_round(std::vector<RaceTime>{{11 * c, 20 * a}, {10 * d, 20 * b}});
    // More work, but on more cores: less time.
    spread_work.add_round(std::vector<RaceTime>{{20 * a, 20 * c}, {5 * b, 30 * d}});
  }
  EXPECT_TRUE(noisy.by_work());
  EXPECT_EQ(noisy.leader(), 0u);
  EXPECT_THAT(noisy.drop_slower(), ElementsAre(1));
  EXPECT_FALSE(steady.by_work());
  EXPECT_EQ(steady.leader(), 1u);
  EXPECT_TRUE(spread_work.by_work());
  EXPECT_THAT(spread_work.drop_slower(), ElementsAre());
}

}  // namespace
}  // namespace lightgrid::lab
