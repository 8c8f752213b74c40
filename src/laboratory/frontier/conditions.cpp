#include "frontier/conditions.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace lightgrid::lab {
namespace {

namespace fs = std::filesystem;

std::optional<double> number_in(const fs::path& path) {
  std::ifstream file(path);
  double value = 0;
  if (file >> value) return value;
  return {};
}

// The entries of a folder whose names begin with `prefix` and go on with a digit.
std::set<fs::path> numbered(const fs::path& folder, const std::string& prefix) {
  std::set<fs::path> found;
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const std::string name = entry->path().filename();
    if (name.starts_with(prefix) && name.size() > prefix.size() && std::isdigit(name[prefix.size()]))
      found.insert(entry->path());
  }
  return found;
}

std::optional<double> mean_clock_mhz(const fs::path& root) {
  double sum = 0;
  int count = 0;
  for (const fs::path& cpu : numbered(root / "sys/devices/system/cpu", "cpu")) {
    if (const auto khz = number_in(cpu / "cpufreq/scaling_cur_freq")) {
      sum += *khz / 1000;
      ++count;
    }
  }
  if (count > 0) return sum / count;
  std::ifstream file(root / "proc/cpuinfo");  // virtual machines have this alone
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(':');
    if (line.starts_with("cpu MHz") && colon != std::string::npos) {
      sum += std::atof(line.c_str() + colon + 1);
      ++count;
    }
  }
  if (count > 0) return sum / count;
  return {};
}

std::optional<double> hottest_c(const fs::path& root) {
  std::optional<double> hottest;
  for (const fs::path& zone : numbered(root / "sys/class/thermal", "thermal_zone")) {
    if (const auto milli = number_in(zone / "temp"))
      hottest = std::max(hottest.value_or(-1e9), *milli / 1000);
  }
  return hottest;
}

double own_seconds() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

bool is_shared(const FrontierConditions& c) {
  return c.others_percent.value_or(0) >= 5 || c.steal_percent.value_or(0) >= 1;
}

bool is_throttled(const FrontierConditions& c) { return c.throttles.value_or(0) > 0; }

ConditionsReader::ConditionsReader(fs::path root) : root_(std::move(root)) {}

ConditionsReader::Counts ConditionsReader::count() const {
  Counts c;
  c.ms = timer_.elapsed_ms();
  c.own_s = own_seconds();
  std::ifstream file(root_ / "proc/stat");  // cpu user nice system idle iowait irq softirq steal (proc(5))
  std::string word;
  double ticks[8] = {};
  if (file >> word && word == "cpu") {
    c.has_times = true;
    for (double& t : ticks) c.has_times &= bool(file >> t);
    for (const double t : ticks) c.total += t;
    c.steal = ticks[7];
    c.busy = c.total - ticks[3] - ticks[4] - ticks[7];
  }
  for (const fs::path& package : numbered(root_ / "sys/class/powercap", "intel-rapl:")) {
    if (std::ranges::count(package.filename().string(), ':') != 1) continue;  // a part of a package
    if (const auto microjoules = number_in(package / "energy_uj")) {
      c.joules += *microjoules * 1e-6;
      c.has_joules = true;
    }
  }
  for (const fs::path& cpu : numbered(root_ / "sys/devices/system/cpu", "cpu")) {
    if (const auto times = number_in(cpu / "thermal_throttle/core_throttle_count")) {
      c.throttles += *times;
      c.has_throttles = true;
    }
  }
  return c;
}

FrontierConditions ConditionsReader::sample() {
  FrontierConditions conditions;
  conditions.clock_mhz = mean_clock_mhz(root_);
  conditions.temperature_c = hottest_c(root_);
  const Counts now = count();
  if (before_) {
    const double total = now.total - before_->total, seconds = (now.ms - before_->ms) / 1000;
    if (now.has_times && before_->has_times && total > 0) {
      const double own = (now.own_s - before_->own_s) * double(sysconf(_SC_CLK_TCK));
      conditions.others_percent = 100 * std::max(now.busy - before_->busy - own, 0.0) / total;
      conditions.steal_percent = 100 * (now.steal - before_->steal) / total;
    }
    // The counter of energy starts again at 0 when it is full.
    if (now.has_joules && now.joules >= before_->joules && seconds > 0)
      conditions.power_w = (now.joules - before_->joules) / seconds;
    if (now.has_throttles) conditions.throttles = now.throttles - before_->throttles;
  }
  before_ = now;
  return conditions;
}

}  // namespace lightgrid::lab
