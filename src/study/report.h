// Writes a comparison as files: images, difference images, heat maps, results.json, index.html.
#pragma once

#include <filesystem>

#include "study/results.h"

namespace lightgrid {

// Into `folder`, made if needed: TECHNIQUE.png and .exr, TECHNIQUE.difference.png (log scale, against the
// reference row), TECHNIQUE.heat.png (lights listed per pixel), results.json and a self-contained index.html.
// Two rows of one technique get distinct names by a number.
void write_report(const std::filesystem::path& folder, const CompareReport& report);

nlohmann::json to_json(const CompareReport& report);

// The three most telling figures, one line each, for the terminal.
std::vector<std::string> telling_figures(const CompareReport& report);

}  // namespace lightgrid
