#include "culling/culler_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "shared/cull_settings.h"

namespace lightgrid {
namespace {

void check_option(const char* name, int value, std::initializer_list<int> allowed) {
  if (std::ranges::find(allowed, value) != allowed.end()) return;
  throw input_error("culler options: {} is {}, not one of {}", name, value, fmt::join(allowed, ", "));
}

void check_row(const char* name, int value, int rows) {
  if (value < 0 || value >= rows)
    throw input_error("culler options: {} is {}, not from 0 to {}", name, value, rows - 1);
}

}  // namespace

void check_options(const CullerOptions& o) {
  check_row("cull_test", int(o.cull_test), int(std::size(cull_tests)));
  check_row("depth_bounds", int(o.depth_bounds), int(std::size(depth_bounds_modes)));
  check_option("shape", int(o.shape), {0, 1, 2});
  check_option("tile", o.tile, {8, 16, 32, 64});
  check_option("depth_format", int(o.depth_format), {0, 1, 2});
  check_option("samples", o.samples, {1, 2, 4, 8});
  check_option("lists", int(o.lists), {0, 1});
  check_option("index_bits", o.index_bits, {0, 16, 32});
  check_option("group_size", o.group_size, {0, 64, 128, 256, 512, 1024});
}

}  // namespace lightgrid
