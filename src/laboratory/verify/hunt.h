// The standing hunt for lost lights: random views, settings and lights until the time is up. `lightgrid
// verify --hunt`.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "verify/hunt_space.h"

namespace lightgrid::lab::verify {

struct HuntOptions {
  double minutes = 1;
  uint64_t contacts = 0;  // 0: run until the time is up. Else: until this many are counted, whatever the time
  uint64_t seed = 1;
  std::string filter;         // a regular expression searched in class names; empty: all
  bool few_settings = false;  // as in HuntSetting, for tests
  size_t lights_a_view = 32768;
  int frames = 6;              // per sequence of the hunt of shadows; 0: it draws none
  std::filesystem::path save;  // folder for losing views; empty: not saved
  std::function<void(double done, const std::string& step)> progress;
};

struct HuntTally {
  std::string name;       // name of the class
  uint64_t contacts = 0;  // distinct (light, pixel) pairs that are certainly lit
  uint64_t lost = 0;      // those not listed
  uint64_t views = 0;
  uint64_t refused = 0;        // views inside the domain that the library refused
  uint64_t shapes_differ = 0;  // views for which the two kernel shapes made different grids
  double seconds = 0;
  double cpu_ns_each = 0;    // processor time a contact, over all threads: the median over the views, which
                             // excludes kernel builds
  std::string why, refusal;  // the first loss, the first refusal
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

// Throws Error(input) if the filter is no regular expression or matches no class. With `contacts` the report
// depends on the seed alone, except for its times.
HuntReport hunt(CullEngine& engine, const HuntOptions& options);

nlohmann::ordered_json to_json(const HuntReport& report);

}  // namespace lightgrid::lab::verify
