// The baseline's time in each round of a sweep, and points' times over it.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "frontier/answer_steps.h"

namespace lightgrid::lab {

class RoundBaselines {
 public:
  // Takes the records of the front and of controls.
  explicit RoundBaselines(Records records);

  // For the point with these views: for each round that all of them have, the logarithms of the sum of the
  // views' times over sums of the baseline's, of one run per view each. A round has a baseline run for each
  // two points; those that count are the same for all points, so that they cancel between two of them, are
  // chosen by their places among the records, whatever their times are, and are others in the next round. One
  // that two points share may count twice, as do some where a round has fewer than three.
  LogTimes log_times(const Group& views) const;

 private:
  using Place = std::tuple<std::string, int, TimeBlock>;  // scene, view
  double ms_of(const Place& place, size_t series) const;
  std::map<Place, std::vector<double>> runs_;  // one a record, in their order
};

}  // namespace lightgrid::lab
