#include "study/bench/kernel_costs.h"

#include <map>

namespace lightgrid {
namespace {

using Formula = KernelCost (*)(const KernelWork&);

constexpr double interval_bytes = 8, cell_bytes = 8, sphere_bytes = 16;
constexpr double sphere_test_flops = 40;  // planes and AABB of one light and one cell

// Compulsory traffic: each input and output once, as if caches held the rest. Tests: one of each light against each
// bin where bins walk all lights, and one for each entry that is listed.
const std::map<std::string, Formula>& formulas() {
  static const std::map<std::string, Formula> table = {
      {"depth_bounds", [](const KernelWork& w) { return KernelCost{4.0 * w.pixels + interval_bytes * w.tiles, 8.0 * w.tiles}; }},
      {"cull_bins_count",
       [](const KernelWork& w) {
         return KernelCost{sphere_bytes * w.lights + interval_bytes * w.tiles + cell_bytes * w.bins,
                           sphere_test_flops * w.lights};
       }},
      {"cull_bins_fill",
       [](const KernelWork& w) {
         return KernelCost{sphere_bytes * w.lights + interval_bytes * w.tiles + cell_bytes * w.bins,
                           sphere_test_flops * w.lights};
       }},
      {"cull_tiles_count",
       [](const KernelWork& w) {
         return KernelCost{(interval_bytes + cell_bytes) * w.tiles, sphere_test_flops * w.indices};
       }},
      {"cull_tiles_fill",
       [](const KernelWork& w) {
         return KernelCost{(interval_bytes + cell_bytes) * w.tiles + w.index_bytes, sphere_test_flops * w.indices};
       }},
      {"scan_counts", [](const KernelWork& w) { return KernelCost{2 * cell_bytes * (w.tiles + w.bins), 0.0}; }},
  };
  return table;
}

}  // namespace

std::optional<KernelCost> kernel_cost(const std::string& label, const KernelWork& work) {
  const auto found = formulas().find(label);
  if (found == formulas().end()) return {};
  return found->second(work);
}

}  // namespace lightgrid
