// The standing hunt for wrong shadows: random scenes, lights, views and sequences of frames until the time is
// up. `lightgrid verify --hunt MINUTES --shadow-pairs`.
#pragma once

#include "verify/hunt.h"
#include "verify/shadow_pairs.h"

namespace lightgrid::lab::verify {

struct ShadowHuntTally {
  std::string name;   // name of the class
  ShadowPairs pairs;  // `why`: the first wrong one, with its seed
  uint64_t views = 0;
  uint64_t refused = 0;            // scenes that the library refused
  uint64_t shapes_differ = 0;      // views for which the two kernel shapes wrote different bits
  uint64_t frames = 0, stale = 0;  // frames of sequences: drawn, and unlike a new renderer's
  double seconds = 0;
  std::vector<uint64_t> failed;  // seeds of scenes with a wrong pair, a refusal or a difference
  std::string refusal;           // the first one, or the first difference of shapes or frames
};

struct ShadowHuntReport {
  std::string device;
  uint64_t seed = 0;
  double seconds = 0;
  std::vector<ShadowHuntTally> classes;
  ShadowHuntTally total() const;
  bool failed() const;
};

// Reads minutes, contacts (decided pairs here), seed, filter and progress. Scene i has the seed `seed` + i: a
// hunt of its class alone for one contact begins with it. Throws as hunt() does. With `contacts` the report
// depends on the seed alone, except for its times.
ShadowHuntReport hunt_shadows(CullEngine& engine, const HuntOptions& options);

nlohmann::ordered_json to_json(const ShadowHuntReport& report);

}  // namespace lightgrid::lab::verify
