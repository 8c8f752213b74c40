// The standing hunt for lost lights: random views, settings and lights until the time is up. `lightgrid verify --hunt`.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "verify/hunt_views.h"

namespace lightgrid::verify {

struct HuntOptions {
  double minutes = 1;
  uint64_t contacts = 0;  // 0: until the minutes are up. Else: until so many are counted, whatever the clock says
  uint64_t seed = 1;
  std::string filter;  // a regular expression that a class's name holds; empty: all
  bool few_settings = false;  // HuntSetting's: for tests
  size_t lights_a_view = 32768;
  std::filesystem::path save;  // where losing views go; empty: nowhere
  std::function<void(double done, const std::string& step)> progress;
};

struct HuntTally {
  std::string name;           // of the class
  uint64_t contacts = 0;      // distinct (light, pixel) pairs, certainly lit
  uint64_t lost = 0;          // of them, not listed
  uint64_t views = 0;
  uint64_t refused = 0;       // views that the library refused, although they are inside the domain
  uint64_t shapes_differ = 0; // views of which the two kernel shapes made different grids
  double seconds = 0;
  double cpu_ns_each = 0;     // processor time a contact, of all threads: the median over the views, which leaves out kernels' builds
  std::string why, refusal;   // the first loss, the first refusal
};

struct HuntReport {
  std::string device;
  uint64_t seed = 0;
  double seconds = 0;
  std::vector<HuntTally> classes;
  std::vector<std::string> saved;  // folders
  HuntTally total() const;
  bool failed() const;
};

// Throws Error(input) where the filter is no regular expression or no class has such a name. With `contacts` the report is the same for the same seed, but for its seconds.
HuntReport hunt(CullEngine& engine, const HuntOptions& options);

nlohmann::ordered_json to_json(const HuntReport& report);

}  // namespace lightgrid::verify
