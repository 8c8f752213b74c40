// The page of a frontier: one self-contained HTML file made of frontier/page/*, parts of report/page/* and
// the answer.
#pragma once

#include <filesystem>
#include <string>

#include "frontier/answer.h"

namespace lightgrid {

// Loads nothing from elsewhere. Pictures are those that records name (FrontierRecord::image) in `pictures`
// (page_pictures.h), in at most `most_picture_bytes` of text; without such files the page shows none.
std::string page_text(const FrontierAnswer& answer, const std::filesystem::path& pictures = {},
                      size_t most_picture_bytes = size_t(24) << 20);

}  // namespace lightgrid
