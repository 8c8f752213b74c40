#include "scene/listed_lights.h"

#include <numeric>

namespace lightgrid {

ListedLights list_every_light(uint32_t count) {
  ListedLights lists{.first = {0}, .count = {count}};
  lists.indices.resize(count);
  std::iota(lists.indices.begin(), lists.indices.end(), 0u);
  return lists;
}

}  // namespace lightgrid
