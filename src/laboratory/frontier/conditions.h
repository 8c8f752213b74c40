// The machine's state while rounds were timed, as far as Linux reports it: others' share of the processors,
// clocks, throttling, temperature, power. Unreadable values stay empty.
#pragma once

#include <filesystem>
#include <optional>

#include "base/timer.h"

namespace lightgrid::lab {

// Over the time since the sample before.
struct FrontierConditions {
  int process = 0;  // process number within the part
  // Per cent of the processors' time: other processes', and what a hypervisor gave to other machines.
  std::optional<double> others_percent, steal_percent;
  std::optional<double> clock_mhz;      // mean of the processors, at the sample
  std::optional<double> temperature_c;  // the hottest sensor, at the sample
  std::optional<double> power_w;        // power of the processor packages (RAPL)
  std::optional<double> throttles;      // how often a core was throttled
};

// Others took 5 % of the processors' time or more, or a hypervisor 1 %.
bool is_shared(const FrontierConditions& conditions);
bool is_throttled(const FrontierConditions& conditions);  // a core was throttled

class ConditionsReader {
 public:
  // `root`: the folder in which proc and sys lie.
  explicit ConditionsReader(std::filesystem::path root = "/");
  // The first one has no figure of a time.
  FrontierConditions sample();

 private:
  struct Counts {
    double total = 0, busy = 0, steal = 0;  // processor time, in ticks of all processors
    double own_s = 0, joules = 0, throttles = 0, ms = 0;
    bool has_times = false, has_joules = false, has_throttles = false;
  };
  Counts count() const;

  std::filesystem::path root_;
  Timer timer_;
  std::optional<Counts> before_;
};

}  // namespace lightgrid::lab
