// The files of an answer: docs/frontier_json.md.
#pragma once

#include <filesystem>

#include "frontier/answer.h"

namespace lightgrid {

// frontier.json, frontier.csv (one row a point and view: each record of `answer.part`), samples.csv (one row
// a run of such a row) and culling.csv (one row a round in which its culling was timed).
nlohmann::json to_json(const FrontierAnswer& answer);
std::string csv_text(const FrontierAnswer& answer);
std::string samples_csv_text(const FrontierAnswer& answer);
std::string cull_csv_text(const FrontierAnswer& answer);

// One self-contained HTML file made of frontier/page/*, parts of report/page/* and frontier.json. Pictures
// are those that records name (FrontierRecord::image) in `pictures`, in at most `most_picture_bytes` of text
// (page_pictures); without such files the page shows none.
std::string page_text(const FrontierAnswer& answer, const std::filesystem::path& pictures = {},
                      size_t most_picture_bytes = size_t(24) << 20);

// Writes all of these. Pictures that records name are looked for in `pictures` and copied into DIR/pictures
// if they are elsewhere; the page holds at most `page_bytes` of them.
void write_answer(const std::filesystem::path& folder, const FrontierAnswer& answer,
                  const std::vector<std::filesystem::path>& pictures, size_t page_bytes);

}  // namespace lightgrid
