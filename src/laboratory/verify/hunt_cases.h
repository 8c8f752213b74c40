// The standing hunt in random cases of samples and of light indices: cases as those of the catalogue, made
// from a seed, until the time is up. `lightgrid verify --hunt MINUTES --cases`.
#pragma once

#include "scene/random.h"
#include "verify/check.h"
#include "verify/hunt.h"

namespace lightgrid::lab::verify {

// A class of such cases.
struct RandomCase {
  const char* name;
  void (*run)(Check&, Random&);
};
std::vector<RandomCase> random_sample_cases();
std::vector<RandomCase> random_light_index_cases();

struct CaseHuntTally {
  std::string name;                                        // name of the class
  uint64_t cases = 0, trials = 0, contacts = 0, lost = 0;  // as in Outcome
  uint64_t skipped = 0;                                    // the engine lacks what the class needs
  double seconds = 0;
  std::vector<uint64_t> failed;  // seeds
  std::string why;               // the first fault with its seed, or why cases were skipped
};

struct CaseHuntReport {
  std::string device;
  uint64_t seed = 0;
  double seconds = 0;
  std::vector<CaseHuntTally> classes;
  CaseHuntTally total() const;
  bool failed() const;
};

// Reads minutes, contacts, seed, filter and progress. Case i has the seed `seed` + i: a hunt of its class
// alone for one contact begins with it. Ends where a round of all classes was skipped. Throws as hunt() does.
// With `contacts` the report depends on the seed alone, except for its times.
CaseHuntReport hunt_cases(CullEngine& engine, const HuntOptions& options);

nlohmann::ordered_json to_json(const CaseHuntReport& report);

}  // namespace lightgrid::lab::verify
