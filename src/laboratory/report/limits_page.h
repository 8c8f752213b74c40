// The page of `lightgrid check`: one self-contained HTML file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/log.h"

namespace lightgrid::lab {

struct PagePicture {
  std::string caption;
  size_t number = 0;             // in LimitsPage::pictures
  std::vector<glm::vec2> marks;  // rings: places in the picture from its upper left, 0 to 1
};

// A limit of an engine.
struct LimitSection {
  std::string title;
  bool holds = true;
  std::vector<std::string> sentences;
  std::string source;                 // URL
  std::vector<PagePicture> pictures;  // side by side
};

struct LimitsPage {
  std::string scene, view;  // headings
  double aspect = 1;        // width over height of the pictures
  std::string verdict;
  std::vector<Warning> warnings;
  std::vector<LimitSection> sections;
  std::vector<std::vector<uint8_t>> pictures;  // PNG, each once
};

// Failing limits first.
std::string limits_page(const LimitsPage& page);

}  // namespace lightgrid::lab
