// How many (pixel, light) pairs a captured frame's lists hold for each lit pair.
#pragma once

#include <string>
#include <vector>

#include "frames/frame_file.h"
#include "oracle/lit_set.h"
#include "plan/settings.h"

namespace lightgrid::lab {

LitBlocks find_lit_blocks(const CapturedFrame& frame);

struct AccuracyRow {
  std::string compared;  // "cull-test=exact tile=8"
  ListAccuracy accuracy;
};

std::string accuracy_line(const AccuracyRow& row);

// `settings` are those that were not compared.
std::string accuracy_json(const CapturedFrame& frame, const Settings& settings,
                          const std::vector<AccuracyRow>& rows);

}  // namespace lightgrid::lab
