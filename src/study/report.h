// Writes a comparison as files: images, difference images, heat maps, results.json, index.html.
#pragma once

#include <filesystem>

#include "study/results.h"

namespace lightgrid {

// Into `folder`, made if needed: TECHNIQUE.png and .exr, TECHNIQUE.difference.png (log scale, against the
// reference row), TECHNIQUE.heat.png (lights listed per pixel), lit.heat.png (lights lit, where an oracle
// counted them), results.json and a self-contained index.html. The second row of a technique is named
// TECHNIQUE-2. A reference that is not a row has its picture there too. All heat maps share one scale. A row
// without an image or without counts goes without those files.
void write_report(const std::filesystem::path& folder, const CompareReport& report);

nlohmann::json to_json(const CompareReport& report);
std::string json_text(const CompareReport& report);  // what results.json holds

// A distinct name for each row: TECHNIQUE, and TECHNIQUE-2 and so on for its later rows.
std::vector<std::string> row_names(const CompareReport& report);

// The three most telling figures, one line each, for the terminal: time, image, lights per pixel. Fewer where
// a report lacks what a line needs.
std::vector<std::string> telling_figures(const CompareReport& report);

// One sentence: which technique is fastest without failing a gate (lost pairs, wrong pairs, NaN), and why.
std::string verdict(const CompareReport& report);

}  // namespace lightgrid
