#include "scene/listed_lights.h"

#include <unistd.h>

#include <numeric>

#include "base/error.h"

namespace lightgrid {

void place_lists(ListedLights& lists) {
  lists.first.clear();
  uint64_t entries = 0;
  for (const uint32_t count : lists.count) {
    lists.first.push_back(entries);
    entries += count;
  }
  const uint64_t memory = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGE_SIZE));
  if (entries > memory / 2 / sizeof(uint32_t)) {
    throw machine_error(
        "{} pairs of pixels and lights are more than this machine's memory holds; use fewer lights or a "
        "smaller --size",
        entries);
  }
  lists.indices.resize(entries);
}

ListedLights list_every_light(uint32_t count) {
  ListedLights lists{.first = {0}, .count = {count}};
  lists.indices.resize(count);
  std::iota(lists.indices.begin(), lists.indices.end(), 0u);
  return lists;
}

}  // namespace lightgrid
