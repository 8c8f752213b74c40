#include "bench/bench_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/embedded.h"
#include "base/text.h"
#include "report/report.h"

namespace lightgrid::lab {
namespace {

std::string bar(const BenchRow& row, double longest_ms) {
  const double width = 100 * row.ms.median / longest_ms;
  const double limit = row.limit_ms ? std::min(100.0, 100 * *row.limit_ms / row.ms.median) : 0;
  return fmt::format("<div class=\"bar\" style=\"width:{:.2f}%\"><div style=\"width:{:.2f}%\"></div></div>",
                     width, limit);
}

std::string row_text(const BenchRow& row, double longest_ms) {
  const std::string compared =
      row.params.contains("compared") ? row.params["compared"].get<std::string>() : "";
  const bool has_limit = row.limit_ms && row.ms.min > 0;
  return fmt::format(
      "<tr><td>{}{}</td><td>{:.3g}</td><td>{:.3g}</td><td>{}</td><td>{}</td><td "
      "class=\"wide\">{}</td></tr>\n",
      xml_escaped(row.name),
      compared.empty() ? "" : " <span class=\"quiet\">" + xml_escaped(compared) + "</span>", row.ms.median,
      row.ms.min, has_limit ? fmt::format("{:.3g}", *row.limit_ms) : "",
      has_limit ? fmt::format("{:.0f} %", 100 * *row.limit_ms / row.ms.min) : "", bar(row, longest_ms));
}

// `first` to `last` have one case.
std::string section_text(const BenchRow* first, const BenchRow* last) {
  double longest_ms = 1e-9;
  for (const BenchRow* row = first; row != last; ++row) longest_ms = std::max(longest_ms, row->ms.median);
  std::string text = fmt::format(
      "<section>\n<h2>{}</h2>\n<div class=\"scrolls\"><table>\n<tr><th>kernel</th><th>median, ms</th>"
      "<th>min, ms</th><th>limit, ms</th><th>share</th><th class=\"wide\"></th></tr>\n",
      xml_escaped(first->case_name));
  for (const BenchRow* row = first; row != last; ++row) text += row_text(*row, longest_ms);
  return text + "</table></div>\n</section>\n";
}

}  // namespace

std::string bench_page(const BenchReport& report) {
  std::string sections;
  const BenchRow* const end = report.rows.data() + report.rows.size();
  for (const BenchRow* first = report.rows.data(); first != end;) {
    const BenchRow* const last =
        std::find_if(first, end, [&](const BenchRow& row) { return row.case_name != first->case_name; });
    sections += section_text(first, last);
    first = last;
  }
  return filled(embedded_file("report/page/bench.html"),
                {{"style", embedded_file("report/page/style.css")},
                 {"device", xml_escaped(report.device)},
                 {"verdict", xml_escaped(slowest_kernel_text(report.rows))},
                 {"sections", sections}});
}

}  // namespace lightgrid::lab
