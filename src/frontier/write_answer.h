// The files of an answer.
#pragma once

#include <filesystem>
#include <vector>

#include "frontier/answer.h"

namespace lightgrid {

// frontier.json, frontier.csv, samples.csv, culling.csv, and a page index.html that loads nothing.
// Pictures that records name are looked for in `pictures` and copied into DIR/pictures if they are elsewhere;
// the page holds at most `page_bytes` of them.
void write_answer(const std::filesystem::path& folder, const FrontierAnswer& answer,
                  const std::vector<std::filesystem::path>& pictures, size_t page_bytes);

}  // namespace lightgrid
