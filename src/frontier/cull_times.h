// How long points that differ in the cull test alone take to cull, run by run, for the intervals of
// break-evens.
#pragma once

#include <functional>
#include <vector>

#include "frontier/point_run.h"
#include "frontier/record_file.h"

namespace lightgrid {

struct PointOnView {
  std::reference_wrapper<PointRun> run;
  std::reference_wrapper<FrontierRecord> record;  // of `view`, open in the file
};

// Rounds in which each of the points that have such a partner draws one profiled frame of `view`, in
// alternating order: their culling is appended to `file` and to the records. Twelve rounds, as far as
// `seconds` allow; none if they do not allow six.
void measure_cull_times(const std::vector<PointOnView>& points, const View& view, double seconds,
                        RecordFile& file);

}  // namespace lightgrid
