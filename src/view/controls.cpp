#include "view/controls.h"

#include "base/error.h"

namespace lightgrid {

const std::array<const char*, 5>& map_names() {
  static const std::array<const char*, 5> names = {"picture", "listed", "lit", "lost", "difference"};
  return names;
}

SideMap parse_map(const std::string& name) {
  std::string known;
  for (size_t i = 0; i < map_names().size(); ++i) {
    if (name == map_names()[i]) return SideMap(i);
    known += (i ? ", " : "") + std::string(map_names()[i]);
  }
  throw input_error("\"{}\" is not a map; maps are {}", name, known);
}

}  // namespace lightgrid
