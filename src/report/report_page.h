// The page of a comparison: one self-contained HTML file made of report/page/* and the figures.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace lightgrid {

// Loads nothing from elsewhere. Embeds results.json unchanged in <script id="results">, so that both have the
// same figures, and each distinct picture once. A single view is shown alone; several are shown one at a
// time, below the statements over all.
std::string report_page(const std::vector<ReportView>& views);

}  // namespace lightgrid
