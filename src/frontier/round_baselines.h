// The baseline's time in each round of a sweep, and points' times over it.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "frontier/answer_steps.h"

namespace lightgrid {

class RoundBaselines {
 public:
  // Of records of the front and of controls.
  explicit RoundBaselines(Records records);

  // Of a point, whose views these are: for each round that all of them have, the logarithm of the sum of the
  // views' times over the sum of the baseline's. A round has a baseline run for each two points; its time is
  // their median, so that one run's noise is not that of every point beside it.
  LogTimes log_times(const Group& views) const;

 private:
  using Place = std::tuple<std::string, int, TimeBlock>;  // scene, view
  std::map<Place, double> medians_;
};

}  // namespace lightgrid
