// Statements over all views of a report.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace lightgrid {

// One sentence each: which technique is the fastest exact one in how many views and where; which are faster
// but lossy, and where; which of forward_plus and clustered is faster in which view, if both ran.
std::vector<std::string> overview_sentences(const std::vector<ReportView>& views);

// Which of the two is faster in which views; a technique counts by its fastest exact row. Empty if no view
// has both. No clear difference: the median of the faster is not below every run of the other.
std::string faster_where(const std::vector<ReportView>& views, const std::string& a, const std::string& b);

}  // namespace lightgrid
