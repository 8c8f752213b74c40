// Conditions as a made-up /proc and /sys have them.
#include "frontier/conditions.h"

#include <gmock/gmock.h>

#include <fstream>

#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

void put(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

TEST(Conditions, AreReadFromLinux) {
  const TempFolder folder;
  const auto root = folder.path;
  put(root / "proc/stat", "cpu  1000 0 500 10000 100 0 0 50 0 0\ncpu0 1 2 3\n");
  for (const int cpu : {0, 1}) {
    const auto of = root / ("sys/devices/system/cpu/cpu" + std::to_string(cpu));
    put(of / "cpufreq/scaling_cur_freq", cpu == 0 ? "2000000" : "3000000");
    put(of / "thermal_throttle/core_throttle_count", "7");
  }
  put(root / "sys/devices/system/cpu/cpufreq/scaling_cur_freq", "9");
  put(root / "sys/class/thermal/thermal_zone0/temp", "45000");
  put(root / "sys/class/thermal/thermal_zone1/temp", "71500");
  put(root / "sys/class/powercap/intel-rapl:0/energy_uj", "1000000");
  put(root / "sys/class/powercap/intel-rapl:0:0/energy_uj", "999000000");
  ConditionsReader reader(root);
  const FrontierConditions first = reader.sample();
  EXPECT_EQ(first.clock_mhz, 2500);
  EXPECT_EQ(first.temperature_c, 71.5);
  EXPECT_FALSE(first.others_percent || first.power_w || first.throttles) << "of a time there is nothing yet";
  EXPECT_FALSE(is_shared(first) || is_throttled(first));

  // 10,000 ticks more, of which 2,500 are busy, nearly none of them ours, and 300 stolen.
  put(root / "proc/stat", "cpu  3000 0 1000 17100 200 0 0 350 0 0\n");
  put(root / "sys/devices/system/cpu/cpu1/thermal_throttle/core_throttle_count", "9");
  put(root / "sys/class/powercap/intel-rapl:0/energy_uj", "3000000");
  const FrontierConditions second = reader.sample();
  EXPECT_NEAR(*second.others_percent, 25, 1);
  EXPECT_EQ(second.steal_percent, 3);
  EXPECT_EQ(second.throttles, 2);
  EXPECT_GT(*second.power_w, 0);
  EXPECT_TRUE(is_shared(second) && is_throttled(second));
}

TEST(Conditions, StayEmptyWhereNothingTells) {
  const TempFolder folder;
  ConditionsReader reader(folder.path);
  reader.sample();
  const FrontierConditions c = reader.sample();
  EXPECT_FALSE(c.others_percent || c.steal_percent || c.clock_mhz || c.temperature_c || c.power_w ||
               c.throttles);
  EXPECT_FALSE(is_shared(c) || is_throttled(c));
}

// This program's own time is not others'.
TEST(Conditions, DoNotCountOwnTimeAsOthers) {
  ConditionsReader reader;
  if (!std::filesystem::exists("/proc/stat")) GTEST_SKIP() << "no /proc";
  reader.sample();
  const Timer timer;
  while (timer.elapsed_ms() < 300) {
  }
  const FrontierConditions c = reader.sample();
  ASSERT_TRUE(c.others_percent);
  EXPECT_GE(*c.others_percent, 0);
  EXPECT_LE(*c.others_percent, 100);
}

}  // namespace
}  // namespace lightgrid::lab
