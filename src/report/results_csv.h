// The rows of several views as one table, for spreadsheets and scripts.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace lightgrid {

// A heading, then a line a row and view (docs/results_json.md, results.csv), with fields quoted as in RFC
// 4180. Unmeasured fields are empty.
std::string results_csv(const std::vector<ReportView>& views);

}  // namespace lightgrid
