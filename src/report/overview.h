// What a report over several views says of all of them.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace lightgrid {

// One sentence each: which technique is the fastest exact one in how many views and where; what is faster and lossy, and
// where; which of forward_plus and clustered is faster in which view, where both ran.
std::vector<std::string> overview_sentences(const std::vector<ReportView>& views);

// Which of the two is faster where; rows of one technique count by their fastest exact one. Empty where no view has
// both. No clear difference: the median of the faster is not below every run of the other.
std::string faster_where(const std::vector<ReportView>& views, const std::string& a, const std::string& b);

}  // namespace lightgrid
