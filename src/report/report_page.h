// The page of a comparison: one self-contained HTML file made of report/page/* and the figures.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace lightgrid {

// Loads nothing from elsewhere. Holds results.json as it is in <script id="results">, so that both tell the same
// figures, and each distinct picture once. One view is shown alone; of several, one at a time below what all say.
std::string report_page(const std::vector<ReportView>& views);

}  // namespace lightgrid
