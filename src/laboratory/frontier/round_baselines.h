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

  // For the point with these views: for each round that all of them have, the logarithm of the sum of its
  // frames over the sum of as many frames of the baseline, over all views and for each view. A round has the
  // baseline's frames for each two points; those that count are the same for all points, so that they cancel
  // between two of them. They are chosen by their places among the records, whatever their times are, and are
  // others in the next round. `place`: other frames of the baseline, as far as there are.
  PointTimes times_of(const Group& views, size_t place = 0) const;

 private:
  using Place = std::tuple<std::string, int, TimeBlock>;  // scene, view
  double ms_of(const Place& place, size_t number) const;
  std::map<Place, std::vector<double>> rounds_;  // one a record, in their order
};

}  // namespace lightgrid::lab
