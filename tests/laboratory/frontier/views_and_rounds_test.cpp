// Intervals and fronts where views are a level: a scene whose views are drawn from a population, in which a
// point's mean ratio and mean error are known. 400 trials, or 2,000 in the long tests (support/long_tests.h).
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <random>

#include "frontier/simulated_machine.h"

namespace lightgrid::lab {
namespace {

// Standard deviations of logarithms. A view is heavy or light (weight), better or worse for a point (ratio),
// and its error is larger or smaller (error), in part for all points alike.
struct Views {
  int views = 5, processes = 1, rounds = 6;
  double weight = 0.4, ratio = 0.08, error = 0.3, noise = 0.03, process_noise = 0;
};

struct Truth {
  std::vector<double> log_ratios, errors;
};

class Simulation {
 public:
  Simulation(const Views& v, uint64_t seed) : v_(v), random_(seed) {}

  double normal() { return normal_(random_); }
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  uint64_t seed() { return random_(); }

  std::vector<DrawnPoint> points(const Truth& truth) {
    const size_t n = truth.errors.size();
    std::vector<DrawnPoint> all(n);
    std::vector<double> weights;
    std::vector<std::vector<double>> ratios(n);
    for (int view = 0; view < v_.views; ++view) {
      weights.push_back(20 * std::exp(v_.weight * normal()));
      const double shared = normal();
      for (size_t i = 0; i < n; ++i) {
        // Both factors are 1 in the mean.
        ratios[i].push_back(std::exp(truth.log_ratios[i] + v_.ratio * normal() - 0.5 * v_.ratio * v_.ratio));
        all[i].errors[view] = truth.errors[i] * std::exp(v_.error * (0.8 * shared + 0.6 * normal()) -
                                                         0.5 * v_.error * v_.error);
      }
    }
    for (int process = 0; process < v_.processes; ++process) time(process, weights, ratios, all);
    return all;
  }

 private:
  void time(int process, const std::vector<double>& weights, const std::vector<std::vector<double>>& ratios,
            std::vector<DrawnPoint>& all) {
    std::vector<double> of_process(all.size() + 1);
    for (double& noise : of_process) noise = v_.process_noise * normal();
    for (int round = 0; round < v_.rounds; ++round) {
      std::vector<double> sums(all.size());
      double baseline_sum = 0;
      for (int view = 0; view < v_.views; ++view) {
        const double shared = 0.05 * normal();
        const auto ms = [&](double ratio, double noise) {
          return weights[size_t(view)] * ratio * std::exp(shared + noise + v_.noise * normal());
        };
        const double baseline = ms(1, of_process.back());
        baseline_sum += baseline;
        for (size_t i = 0; i < all.size(); ++i) {
          const double own = ms(ratios[i][size_t(view)], of_process[i]);
          sums[i] += own;
          ViewTimes& times = all[i].times.views[view];
          times.rounds[{0, process, round}] = std::log(own / baseline);
          times.baseline_ms = weights[size_t(view)];
        }
      }
      for (size_t i = 0; i < all.size(); ++i)
        all[i].times.rounds[{0, process, round}] = std::log(sums[i] / baseline_sum);
    }
  }

  Views v_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{0, 1};
};

TEST(ViewsAndRounds, IntervalsOverViewsContainTheTruthAndThoseOfRoundsDoNot) {
  const std::pair<const char*, Views> cases[] = {
      {"three views", {.views = 3}},
      {"five views", {}},
      {"five views of few rounds", {.rounds = 3}},
      {"sixteen views", {.views = 16}},
      {"views that hardly differ", {.ratio = 0.002}},
      {"five processes", {.processes = 5, .rounds = 3, .process_noise = 0.02}},
      {"five processes of views that hardly differ",
       {.processes = 5, .rounds = 3, .ratio = 0.01, .process_noise = 0.02}}};
  uint64_t seed = 1;
  for (const auto& [name, views] : cases) {
    Simulation simulation(views, seed++);
    int held = 0, held_by_rounds = 0;
    const int n = 2000;
    for (int trial = 0; trial < n; ++trial) {
      const RelativeTime r = relative_time(simulation.points({{std::log(1.3)}, {0.1}})[0].times);
      ASSERT_TRUE(r.over_views);
      held += r.over_views->low <= 1.3 && 1.3 <= r.over_views->high;
      held_by_rounds += r.low <= 1.3 && 1.3 <= r.high;
    }
    EXPECT_GE(held, 0.93 * n) << name;
    EXPECT_LE(held, 0.97 * n) << name;
    if (views.ratio > 0.05) {
      EXPECT_LT(held_by_rounds, 0.75 * n) << name;
    }
    RecordProperty(
        std::string("coverage of ") + name,
        fmt::format("{:.3f}, by rounds alone {:.3f}", double(held) / n, double(held_by_rounds) / n));
  }
}

// True times and errors are drawn in each trial. Of the points whose probability is about p, the share p is on
// the front of the true times and errors: within 5 points, and the sample's noise.
TEST(ViewsAndRounds, ProbabilitiesOfTheFrontAreCalibrated) {
  const std::pair<const char*, Views> cases[] = {
      {"three views", {.views = 3}},
      {"five views", {}},
      {"sixteen views", {.views = 16}},
      {"five processes", {.processes = 5, .rounds = 3, .process_noise = 0.02}}};
  uint64_t seed = 11;
  for (const auto& [name, views] : cases) {
    Simulation simulation(views, seed++);
    constexpr int bins = 5;
    double stated[bins] = {}, found[bins] = {}, counted[bins] = {};
    double far_by_rounds = 0, sure_by_rounds = 0;
    for (int trial = 0; trial < trials(); ++trial) {
      Truth truth;
      for (int i = 0; i < 12; ++i) {
        truth.log_ratios.push_back(simulation.uniform());
        truth.errors.push_back(0.01 * std::exp(3 * simulation.uniform()));
      }
      const std::vector<DrawnPoint> points = simulation.points(truth);
      const std::vector<double> p = front_probabilities(drawn_over_views(points, 0, 400, simulation.seed())),
                                front = front_probabilities({truth.log_ratios}, truth.errors);
      std::vector<LogTimes> rounds;
      std::vector<double> errors;
      for (const DrawnPoint& point : points) {
        rounds.push_back(point.times.rounds);
        errors.push_back(0);
        for (const auto& [view, error] : point.errors) errors.back() += error / double(point.errors.size());
      }
      const std::vector<double> by_rounds =
          front_probabilities(drawn_log_times(rounds, 0, 400, simulation.seed()), errors);
      for (size_t i = 0; i < p.size(); ++i) {
        const int bin = std::min(int(p[i] * bins), bins - 1);
        stated[bin] += p[i];
        found[bin] += front[i];
        ++counted[bin];
        sure_by_rounds += by_rounds[i] > 0.99;
        far_by_rounds += by_rounds[i] > 0.99 && front[i] == 0;
      }
    }
    for (int bin = 0; bin < bins; ++bin) {
      ASSERT_GT(counted[bin], 50) << name << ", bin " << bin;
      const double p = stated[bin] / counted[bin];
      EXPECT_NEAR(found[bin] / counted[bin], p,
                  long_tests() ? 0.05 : 0.02 + three_deviations(p, int(counted[bin])))
          << name << ", bin " << bin;
      RecordProperty(fmt::format("{}, {:.3f}", name, p), fmt::format("{:.3f}", found[bin] / counted[bin]));
    }
    EXPECT_GT(far_by_rounds, 0.03 * sure_by_rounds) << name << ": rounds alone are too sure";
  }
}

}  // namespace
}  // namespace lightgrid::lab
