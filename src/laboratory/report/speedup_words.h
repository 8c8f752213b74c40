// A comparison's answer in words: what makes a row faster, and the table of all contestants.
#pragma once

#include <string>
#include <vector>

#include "measures/results.h"

namespace lightgrid::lab {

// Mean of listed lights over the pixels with a surface; negative if not counted.
double listed_per_pixel(const CompareReport& report, const RunResult& row);
double pixels_with_surfaces(const CompareReport& report);
std::string lights_number(double value);  // "11.8", "237"

// The measured factors of speedup_of, the largest first: "7.53 times from shorter lists (11.8 lights per
// pixel instead of 237), 5.91 times from OpenCL instead of OpenGL". Says so where no rows isolate them, and
// what lists give in OpenCL if it is something else. Empty without a speed-up.
std::string speedup_in_words(const CompareReport& report, const RunResult& row);

// "OpenGL runs in software on this machine (llvmpipe): …"; empty elsewhere, and where no row draws in OpenGL.
std::string software_opengl_in_words(const CompareReport& report);

// For a terminal, a heading and a line per row: name, time with its spread, speed-up, exact or its error.
std::vector<std::string> contestants_table(const CompareReport& report);

}  // namespace lightgrid::lab
