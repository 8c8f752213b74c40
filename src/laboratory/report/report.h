// Writes a comparison as files: images, difference images, heat maps, results.json, index.html.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "measures/results.h"
#include "report/view_pictures.h"

namespace lightgrid::lab {

// An answer to "which one?": a technique, its figure, why it, and how sure that is.
struct Choice {
  std::string what, name, figure, why, sure;
};

// One view of a report as its page shows it; without the report's own images and counts.
struct ReportView {
  CompareReport report;
  ReportPictures pictures;
  std::string verdict;
  std::vector<Choice> choices;
  std::vector<std::string> figures;
  std::string folder;  // folder of its pictures, below the report's; empty for a single view
};

// Writes into `folder`, created if needed: ROW.png, with `exr` also ROW.exr, ROW.difference.png (log scale,
// against the reference row), ROW.heat.png (lights listed per pixel), lit.heat.png (lights lit, if an oracle
// counted them), results.json and a self-contained index.html. ROW is the row's name as a file_stem. A
// reference that is not a row gets its picture too. All heat maps share one scale. Files for missing images
// or counts are omitted.
void write_report(const std::filesystem::path& folder, const CompareReport& report, bool exr = false);

// A comparison over several views on one page. Each view's pictures are written when it is added, into its
// own folder, and its images are then freed.
class ViewsReport {
 public:
  // `views` will be added. The page's pictures take at most `page_bytes` and are reduced in size if
  // necessary.
  ViewsReport(std::filesystem::path folder, size_t views, size_t page_bytes)
      : folder_(std::move(folder)), expected_(views), page_bytes_(page_bytes) {}

  const ReportView& add(CompareReport report);
  const std::vector<ReportView>& views() const { return views_; }
  std::vector<std::string> sentences() const;  // statements over all views (overview_sentences)
  std::string json_text() const;               // the text of results.json
  void write() const;                          // results.json, results.csv, index.html

 private:
  std::filesystem::path folder_;
  size_t expected_, page_bytes_;
  std::set<std::string> names_;
  std::vector<ReportView> views_;
};

nlohmann::json to_json(const std::vector<ReportView>& views);

// A distinct name for each row: its technique and, if it has several rows, the settings in which they differ:
// "forward_plus:tile=32". Rows that differ in none are NAME, NAME-2 and so on.
std::vector<std::string> row_names(const CompareReport& report);

std::string row_name(const CompareReport& report, const RunResult& row);  // one of the report's

// The same without the setting `key` and without numbers: one name for the rows that differ in it alone.
std::vector<std::string> row_names_without(const CompareReport& report, const std::string& key);

// A name as part of a file's name: characters that cause trouble in file systems or shells become "-".
std::string file_stem(const std::string& name);
std::vector<std::string> file_stems(const std::vector<std::string>& names);  // distinct

// The most telling figures, one line each, for the terminal: time, light, then the remarks. Fewer if the
// report lacks their data.
std::vector<std::string> telling_figures(const CompareReport& report);

// Lights per pixel, surfaces, faster techniques and what they cost, changes along a path.
std::vector<std::string> remarks(const CompareReport& report);

// An image is exact if its distance from the oracle is at most this multiple of the reference's own, at the
// same pixels. Both are granted a few float roundings (exact_floor, of the brightest channel).
inline constexpr double exact_factor = 1.5, exact_floor = 0x1p-22;
// The same without an oracle, and at pixels that it cannot shade: the greatest difference from the reference.
inline constexpr double exact_max_rel = 1e-5;

// Leaked and acned pairs, unless the technique says that its shadows are approximate.
uint64_t shadow_faults(const RunResult& row);
bool passes_gates(const RunResult& row);  // no lost pairs, no wrong pairs, no NaN, lists shaded; and it ran
bool is_exact(const ImageError& error);
// Passes, and its light is exact on its own surfaces (light_error) or was not compared. If every light was
// not drawn on these surfaces, its image is held against the reference's.
bool is_exact(const RunResult& row);

// Why lit pairs were lost, if that is by design: " by design (a pixel has room for 4 lights)".
std::string why_lost(const RunResult& row);

// One sentence: the fastest exact technique, and why.
std::string verdict(const CompareReport& report);

// The fastest exact technique, the fastest whose picture nobody can tell from every light's, and the exact
// one with least memory.
std::vector<Choice> choices(const CompareReport& report);

// The timed row of least median among those that `counts` accepts; null if there is none.
using RowTest = std::function<bool(const RunResult& row)>;
const RunResult* fastest(const CompareReport& report, const RowTest& counts);
const RunResult* fastest_exact(const CompareReport& report);

// The page of a comparison: one self-contained HTML file made of report/page/* and the figures. It loads
// nothing from elsewhere. Embeds results.json unchanged in <script id="results">, so that both have the same
// figures, and each distinct picture once. A single view is shown alone; several are shown one at a time,
// below the statements over all.
std::string report_page(const std::vector<ReportView>& views);

// The rows of several views as one table: a heading, then a line a row and view (docs/results_json.md,
// results.csv), with fields quoted as in RFC 4180. Unmeasured fields are empty.
std::string results_csv(const std::vector<ReportView>& views);

// Statements over all views, one sentence each: which technique is the fastest exact one in how many views
// and where; which are faster but lossy, and where; which of forward_plus and clustered is faster in which
// view, if both ran.
std::vector<std::string> overview_sentences(const std::vector<ReportView>& views);

// Which of the two is faster in which views; a technique counts by its fastest exact row. Empty if no view
// has both. No clear difference: the interval of the faster one's time relative to the other's contains 1.
std::string faster_where(const std::vector<ReportView>& views, const std::string& a, const std::string& b);

// For pages of one file, this one and the frontier's.
// Safe inside <script>: contains no "<", so no "</script>" either. JSON in, JSON of the same value out.
std::string script_json(const std::string& text);

// Replaces each {{name}} of the template, in order; inserted text is not scanned again.
std::string filled(std::string_view page, const std::map<std::string_view, std::string>& values);

}  // namespace lightgrid::lab
