// Combinations of techniques and settings, chosen by text. Error(input) names the field and its value.
#pragma once

#include <string>
#include <vector>

#include "bench/bench.h"
#include "compare/compare.h"

namespace lightgrid::lab {

// Every combination of the values in the comparisons ("KEY=A,B"), applied to `base`; `base` alone if there
// are none. Throws Error(input) past `most` combinations.
std::vector<BenchContestant> contestants_of(const Settings& base, const std::vector<std::string>& comparisons,
                                            size_t most);

// The same for settings that culling reads. Throws Error(input) for others, whose values would all run the
// same.
std::vector<BenchContestant> culling_contestants(const Settings& base,
                                                 const std::vector<std::string>& comparisons, size_t most);

// Items of a list of techniques, split at its commas, each over `common`: "forward", "forward_plus:tile=32",
// "cull-test=aabb"; an item with "=" and without a name before a colon is another setting of the name before
// it, and "all" is every technique. Throws Error(input) for a setting that a technique does not read.
std::vector<Contestant> named_contestants(const std::vector<std::string>& items, const Settings& common);

// Takes one technique as it stands in a list: leaves its name, and appends its settings to `set`. Nothing is
// given if it is empty. Throws Error(input) for several techniques.
void take_own_settings(std::string& technique, std::vector<std::string>& set);

struct GivenFor {
  bool grid = false;  // a light grid is built whatever the technique: it reads the settings of culling
  bool casts = true;  // a light of the scene may cast shadows
};
// Throws Error(input) for a setting given in `common` that changes nothing in any of the contestants.
void check_given_settings(const Settings& common, const std::vector<Contestant>& contestants,
                          const GivenFor& where = {});

// techniques: a list split at its commas, such as "forward", "forward_plus:tile=32", "cull-test=aabb"; an
// item with "=" and without a name before a colon is another setting of the name before it. comparisons:
// "KEY=A,B", applied to each technique that reads KEY. Throws Error(input) for a setting that a technique
// does not read, a KEY or a given setting that none reads, and for different BRDFs, since one reference image
// cannot serve both.
std::vector<Contestant> chosen_contestants(const std::vector<std::string>& techniques, const Settings& common,
                                           const std::vector<std::string>& comparisons);

}  // namespace lightgrid::lab
