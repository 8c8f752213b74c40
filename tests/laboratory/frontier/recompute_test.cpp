// Fronts, times and break-evens of random records, computed again by recompute.py from the tables alone.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>

#include "frontier/answer.h"
#include "frontier/fields.h"
#include "frontier/some_records.h"
#include "support/paths.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

using testing::HasSubstr;

// Ratios of few distinct medians, so that many points are close; errors of few values, so that some are
// equal.
FrontierPart random_sweep(uint32_t seed, int frames_per_round = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.05);
  FrontierPart part = some_part(0, 1);
  for (const char* scene : {"hall", "a, \"b\""}) {
    for (int tile = 0; tile < 16; ++tile) {
      const double ratio = 0.5 + 0.1 * static_cast<double>(random() % 12);
      const double error = std::pow(10.0, -1.0 - static_cast<double>(random() % 5));
      const bool refused = random() % 12 == 0, not_finite = random() % 12 == 0,
                 shows_nan = random() % 12 == 0;
      for (int view = 0; view < 3; ++view) {  // the last one without times
        FrontierRecord record = some_record(tile, view);
        record.point.scene = scene;
        // Pairs of cull tests: tile 0 and 1, 2 and 3, …
        record.point.settings = {{"tile", std::to_string(tile / 2)},
                                 {"cull_test", tile % 2 ? "exact" : "aabb"}};
        record.pairs.listed = 1000000 + random() % 3 * 100000;
        record.cull_ms.clear();
        for (uint32_t round = view == 0 ? 5 + uint32_t(tile) / 2 : 0; round > 0; --round)
          record.cull_ms.push_back(5 + 0.1 * (tile % 2) + noise(random));
        record.nan_pixels = shows_nan && view == 1 ? 3 : 0;
        record.errors.total.displayed = DisplayedFlip{error * (1 + view), 0};
        record.errors.authored->total.displayed = DisplayedFlip{0.1 / error * 1e-3 * (2 - view), 0};
        if (not_finite && view == 1) record.errors.total.displayed.reset();
        record.frame_ms.clear();
        record.baseline_ms.clear();
        record.processes.clear();
        for (const auto& [key, times] : times_by_device) (record.*times).clear();
        for (const auto& [key, times] : times_by_cpu) (record.*times).clear();
        record.frames_per_round = frames_per_round;
        const bool timed_by_device = tile != 5;
        if (refused && view == 1) record.refused = "no";
        for (uint32_t runs = random() % 3 == 0 ? 21 : 4 + random() % 9;
             runs > 0 && record.refused.empty() && view < 2; --runs) {
          record.baseline_ms.push_back(10 + view + 10 * noise(random));
          record.frame_ms.push_back(record.baseline_ms.back() * (ratio + noise(random)));
          record.baseline_cpu_ms.push_back(20 + view + noise(random));
          record.cpu_ms.push_back(record.baseline_cpu_ms.back() * (ratio + 0.1 * noise(random)));
          if (timed_by_device) {
            record.baseline_device_ms.push_back(8 + view + 5 * noise(random));
            record.device_ms.push_back(record.baseline_device_ms.back() * (1.2 - ratio / 2 + noise(random)));
            record.hand_over_ms.push_back(0.5);
            record.copy_ms.push_back(0.1);
            record.read_back_ms.push_back(1);
          }
          // One process in the first scene, two in the second.
          record.processes.push_back(record.point.scene == "hall" ? 0 : int(record.processes.size()) / 3 % 2);
        }
        part.records.push_back(record);
      }
      FrontierRecord series = part.records.back();
      series.series = "lights";
      part.records.push_back(series);
    }
  }
  return part;
}

// Points far from a front have none.
nlohmann::json& largest_probability(nlohmann::json& frontier, const char* fronts, const char* of) {
  nlohmann::json* largest = &frontier["points"][0][fronts][of]["probability"];
  for (nlohmann::json& point : frontier["points"]) {
    nlohmann::json& probability = point[fronts][of]["probability"];
    if (probability > *largest) largest = &probability;
  }
  return *largest;
}

void flip(nlohmann::json& value) { value = !value.get<bool>(); }

void scale(nlohmann::json& value, double factor) { value = value.get<double>() * factor; }

// The lines of recompute.py end with "N differ" or "N points differ".
std::vector<int> counts_of_differences(const std::string& output) {
  const std::regex count(": (\\d+)( points)? differ\n");
  std::vector<int> counts;
  for (std::sregex_iterator at(output.begin(), output.end(), count), end; at != end; ++at)
    counts.push_back(std::stoi((*at)[1]));
  return counts;
}

TEST(Recomputed, FrontsAndTimesAreThoseOfTheTables) {
  if (run_command("python3 --version 2>&1").status != 0) GTEST_SKIP() << "Python is not installed";
  const TempFolder folder;
  const FrontierAnswer answer = answer_of({random_sweep(11)});
  ASSERT_GT(answer.points.size(), 20u);
  std::ofstream(folder.path / "frontier.csv") << csv_text(answer);
  std::ofstream(folder.path / "samples.csv") << samples_csv_text(answer);
  std::ofstream(folder.path / "culling.csv") << cull_csv_text(answer);
  const auto recompute = [&](const nlohmann::json& frontier) {
    std::ofstream(folder.path / "frontier.json") << frontier;
    return run_command(std::string("python3 ") + source_folder + "/tests/laboratory/frontier/recompute.py " +
                       folder.path.string() + " 2>&1");
  };
  const nlohmann::json stated = to_json(answer);
  const CommandOutcome run = recompute(stated);
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr(fmt::format("{} points, ", answer.points.size())));

  const auto with_interval = std::count_if(answer.break_even.begin(), answer.break_even.end(),
                                           [](const BreakEven& b) { return b.rounds > 0; });
  EXPECT_GE(with_interval, 6);
  EXPECT_THAT(run.output, HasSubstr(fmt::format("{} break-evens with intervals: 0 differ", with_interval)));

  // Against each reference and by each clock: a time, a front and a probability.
  nlohmann::json wrong = stated;
  flip(wrong["points"][7]["fronts"]["total"]["on"]);
  flip(wrong["points"][8]["fronts"]["authored"]["on"]);
  scale(wrong["points"][9]["relative_time"]["ci95"][1], 1.0001);
  flip(wrong["points"][7]["device_fronts"]["total"]["on"]);
  flip(wrong["points"][8]["device_fronts"]["authored"]["on"]);
  scale(wrong["points"][9]["relative_device_time"]["estimate"], 1.0001);
  scale(wrong["points"][9]["relative_cpu_time"]["views_ci95"][0], 1.0001);
  for (const char* fronts : {"fronts", "device_fronts"}) {
    for (const char* of : {"total", "authored"}) {
      nlohmann::json& probability = largest_probability(wrong, fronts, of);
      probability = std::abs(probability.get<double>() - 0.2);
    }
  }
  for (nlohmann::json& b : wrong["break_even"]) {
    if (b["rounds"] > 0) b["ci95"][1] = b["ci95"][1].get<double>() * 1.001 + 1e-6;
  }
  EXPECT_THAT(counts_of_differences(recompute(wrong).output),
              testing::ElementsAre(2, 1, 1, 2, 1, 2, 1, 1, 2, 1, with_interval));

  wrong = stated;
  wrong["points"].erase(7);
  EXPECT_NE(recompute(wrong).status, 0);
}

}  // namespace
}  // namespace lightgrid::lab
