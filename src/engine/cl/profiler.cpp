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
  return timing_ ? &pending_.emplace_back(Pending{label, false, {}}).event : nullptr;
}

cl::Event* ClProfiler::copy_event(const std::string& label) {
  return timing_copies_ ? &pending_.emplace_back(Pending{label, true, {}}).event : nullptr;
}

std::vector<ClProfiler::Timed> ClProfiler::collect_each() {
  std::vector<Timed> all;
  try {
    for (const Pending& pending : pending_) {
      if (!pending.event()) continue;  // the call that should have filled it failed and reported that
      Timed& timed = all.emplace_back(Timed{pending.label, pending.copy});
      pending.event.wait();
      timed.ms = 1e-6 * double(pending.event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                               pending.event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    }
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, "timing a launch");
  }
  pending_.clear();
  return all;
}

std::vector<ClProfiler::Row> ClProfiler::collect() {
  std::vector<Row> rows;
  for (const Timed& timed : collect_each()) {
    Row& row = row_of(rows, timed.label);
    ++row.launches;
    row.ms += timed.ms;
  }
  return rows;
}

int ClProfiler::count(const std::string& label) const {
  for (const Row& row : counts_)
    if (row.label == label) return row.launches;
  return 0;
}

}  // namespace lightgrid
