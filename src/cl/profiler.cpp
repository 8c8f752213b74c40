#include "cl/profiler.h"

#include <algorithm>

#include "cl/error.h"

namespace lightgrid {
namespace {

ClProfiler::Row& row_of(std::vector<ClProfiler::Row>& rows, const std::string& label) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.label == label; });
  return found != rows.end() ? *found : rows.emplace_back(ClProfiler::Row{label});
}

}  // namespace

cl::Event* ClProfiler::event(const std::string& label) {
  ++count_;
  ++row_of(counts_, label).launches;
  return timing_ ? &pending_.emplace_back(Timed{label, {}}).event : nullptr;
}

std::vector<ClProfiler::Row> ClProfiler::collect() {
  std::vector<Row> rows;
  try {
    for (const Timed& timed : pending_) {
      if (!timed.event()) continue;  // the call that should have filled it failed and reported that
      timed.event.wait();
      Row& row = row_of(rows, timed.label);
      ++row.launches;
      row.ms += 1e-6 * double(timed.event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                              timed.event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    }
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, "timing a launch");
  }
  pending_.clear();
  return rows;
}

int ClProfiler::count(const std::string& label) const {
  for (const Row& row : counts_)
    if (row.label == label) return row.launches;
  return 0;
}

}  // namespace lightgrid
