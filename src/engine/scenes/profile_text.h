// Photometric files in memory.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <string>
#include <vector>

#include "scene/light_profiles.h"

namespace lightgrid {

struct ProfileText {
  std::vector<double> vertical, horizontal = {0};
  std::function<double(double, double)> candela;  // of both angles, in degrees
  int type = 1;
  double multiplier = 1, ballast = 1;
  std::string tilt = "TILT=NONE\n";

  std::string text() const {
    std::string out = fmt::format("IESNA:LM-63-2002\n[TEST]\n{}1 -1 {} {} {} {} 2 0 0 0\n{} 1 10\n{}\n{}\n",
                                  tilt, multiplier, vertical.size(), horizontal.size(), type, ballast,
                                  fmt::join(vertical, " "), fmt::join(horizontal, " "));
    for (const double h : horizontal) {
      for (const double v : vertical) out += fmt::format("{:.9g} ", candela(v, h));
      out += '\n';
    }
    return out;
  }
  std::vector<uint8_t> bytes() const {
    const std::string made = text();
    return {made.begin(), made.end()};
  }
  SharedTable table() const { return std::make_shared<const FileTable>(parse_profile(bytes())); }
};

inline std::vector<double> equal_angles(double first, double last, int steps) {
  std::vector<double> out;
  for (int i = 0; i <= steps; ++i) out.push_back(first + (last - first) * i / steps);
  return out;
}

}  // namespace lightgrid
