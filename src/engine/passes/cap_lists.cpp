#include "passes/cap_lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "cl/launch.h"
#include "plan/settings/grid.h"
#include "plan/settings/model.h"
#include "renderer/pass_programs.h"
#include "renderer/upload/culler_input.h"
#include "renderer/upload/lights.h"
#include "scene/light_tree.h"
#include "shared/cull_constants.h"

namespace lightgrid {
namespace {

constexpr size_t cap_group = 64;
constexpr size_t sample_group = 32;  // GROUP in kernels/culling/gpu/sample_*.cl
// So that products with squared distances stay in the range of float (kernels/culling/cap_lists.cl).
constexpr double min_inverse = 1e-20, max_inverse = 1e20;

double over_intensity(double value, const ViewLight& light) {
  const glm::dvec3 i = largest_intensity(light);
  return value * std::clamp(1 / (i.r + i.g + i.b), min_inverse, max_inverse);
}

std::vector<cl_uint> ranks_by_distance(const std::vector<ViewLight>& lights) {
  std::vector<cl_uint> order(lights.size()), ranks(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {},
                           [&](cl_uint i) { return glm::dot(lights[i].position, lights[i].position); });
  for (size_t i = 0; i < order.size(); ++i) ranks[order[i]] = cl_uint(i);
  return ranks;
}

// The highest multiple of 4 bits that a rank below `count` needs.
cl_uint high_bits(size_t count) {
  cl_uint high = 0;
  while (size_t(16) << high < count) high += 4;
  return high;
}

cl_uint planes_of(DepthBoundsMode mode) {
  if (mode == DepthBoundsMode::halfz || mode == DepthBoundsMode::halfz_modified) return 4;
  return mode == DepthBoundsMode::mask32 ? 3 : 2;
}

}  // namespace

class ListCaps : public PassCache {
 public:
  explicit ListCaps(PassContext& work) : sampling_(work, "culling") {}
  size_t memory_bytes() const override {
    return lights_.bytes() + edges_.bytes() + params_.bytes() + nodes_.bytes() + leaves_.bytes() +
           eye_.bytes();
  }
  bool follow(PassContext&) override { return stale_ = true; }

  void cap(PassContext& work, const CullParams& tiles, const TileBounds& bounds, const ViewGrid& grid) {
    ClDevice& device = *work.renderer.cl;
    const Settings& s = work.plan.settings;
    const bool samples = samples_lists(s);
    std::string defines = grid.index_bits == 32 ? " -DINDEX_32" : "";
    if (samples)
      for (const char* define : light_table_defines(work.plan)) defines += fmt::format(" -D{}", define);
    else
      defines += fmt::format(" -DORDER={}", int(s[setting::list_cap_order]));
    NamedKernel& kernel = samples ? sampled("sample_lists", defines) : capped(work, defines);
    if (grid.index_count == 0) return;  // after the kernel is built, which other views need
    if (stale_) upload(work, tiles);
    stale_ = false;
    const size_t cells = grid.cell_bytes / sizeof(cl_uint2);
    ClArguments arguments = {{"cells", grid.storage->cells(grid.cell_bytes)},
                             {"indices", grid.storage->indices(grid.index_bytes)},
                             {"cell_count", cl_uint(cells)},
                             {"cap", cl_uint(s[setting::list_cap])}};
    if (samples)
      arguments = arguments +
                  ClArguments{{"seed", cl_uint(s[setting::list_seed])},
                              {"factors", grid.storage->factors(grid.factor_bytes)}} +
                  work.cl_lights().columns() + of_cells(bounds);
    if (s[setting::list_cap_order] == ListCapOrder::distance)
      arguments = arguments + ClArguments{{"high", high_bits(work.plan.lights.local.size())},
                                          {"ranks", lights_.buffer()}};
    if (s[setting::list_cap_order] == ListCapOrder::brightest)
      arguments =
          arguments + ClArguments{{"high", cl_uint(28)}, {"lights", lights_.buffer()}} + of_cells(bounds);
    if (samples) return launch_sampling(device, "cap_lists", kernel, cells, arguments);
    kernel.launch(device, "cap_lists", cl::NDRange((cells + cap_group - 1) / cap_group * cap_group),
                  cl::NDRange(cap_group), arguments);
  }

  void draw(PassContext& work, const CullParams& tiles, const TileBounds& bounds, const ViewGrid& grid) {
    ClDevice& device = *work.renderer.cl;
    const Settings& s = work.plan.settings;
    NamedKernel& kernel = sampled("sample_tree", fmt::format("-DCAP={}{}", s[setting::list_cap],
                                                             grid.index_bits == 32 ? " -DINDEX_32" : ""));
    if (stale_) upload(work, tiles);
    stale_ = false;
    const size_t cells = grid.cell_bytes / sizeof(cl_uint2);
    launch_sampling(device, "lists_of_tree", kernel, cells,
                    ClArguments{{"cells", grid.storage->cells(grid.cell_bytes)},
                                {"indices", grid.storage->indices(grid.index_bytes)},
                                {"cell_count", cl_uint(cells)},
                                {"seed", cl_uint(s[setting::list_seed])},
                                {"factors", grid.storage->factors(grid.factor_bytes)},
                                {"nodes", nodes_.buffer()},
                                {"lights", leaves_.buffer()},
                                {"leaves", cl_uint(leaf_count_)},
                                {"world_from_view", eye_.buffer()}} +
                        of_cells(bounds));
  }

 private:
  NamedKernel& capped(PassContext& work, const std::string& defines) {
    if (!kernel_ || defines != defines_)
      kernel_ = NamedKernel(*work.renderer.kernels, "culling/cap_lists", defines);
    defines_ = defines;
    return kernel_;
  }

  NamedKernel& sampled(const char* stem, const std::string& defines) {
    sampling_.use(defines);
    return sampling_.of(stem);
  }

  ClArguments of_cells(const TileBounds& bounds) {
    return {{"bounds", bounds.values},
            {"planes", planes_of(bounds.mode)},
            {"slice_edges", edges_.buffer()},
            {"p", params_.buffer()}};
  }

  // A cell for an item, or for a group of items.
  void launch_sampling(ClDevice& device, const char* label, NamedKernel& kernel, size_t cells,
                       const ClArguments& arguments) {
    const size_t items = sampling_.lanes ? cap_group : sample_group;
    const size_t all = sampling_.lanes ? (cells + items - 1) / items * items : cells * items;
    kernel.launch(device, label, cl::NDRange(all), cl::NDRange(items), arguments);
  }

  // Kept while lights rest; the eye is not.
  void upload_tree(PassContext& work) {
    ClDevice& device = *work.renderer.cl;
    if (tree_of_ != work.gpu.lights_version() || leaf_count_ == 0) {
      View world;
      world.view_from_world = glm::dmat4(1);
      const LightTree tree = light_tree(
          lights_in_view(work.scene, world, ranges_of(work.plan.settings), work.plan.lights.local));
      nodes_.put(device, "uploading a tree of lights", tree.nodes);
      leaves_.put(device, "uploading a tree of lights", tree.lights);
      leaf_count_ = tree.lights.size();
      tree_of_ = work.gpu.lights_version();
    }
    const glm::mat3 axes(glm::transpose(glm::dmat3(work.view.view_from_world)));
    eye_.put(device, "uploading the view",
             std::vector<glm::vec4>{glm::vec4(axes[0], 0), glm::vec4(axes[1], 0), glm::vec4(axes[2], 0),
                                    glm::vec4(glm::vec3(work.view.eye), 0)});
  }

  void upload(PassContext& work, const CullParams& tiles) {
    ClDevice& device = *work.renderer.cl;
    const FramePlan& plan = work.plan;
    const auto lights = [&] {
      return lights_in_view(work.scene, work.view, ranges_of(plan.settings), plan.lights.local);
    };
    if (plan.settings[setting::list_cap_order] == ListCapOrder::index) return;
    if (plan.settings[setting::list_cap_order] == ListCapOrder::distance)
      return lights_.put(device, "uploading ranks of lights", ranks_by_distance(lights()));
    if (plan.lists.light_tree) upload_tree(work);
    if (plan.settings[setting::list_cap_order] == ListCapOrder::brightest) {
      std::vector<cl_float4> uploaded;
      for (const ViewLight& light : lights()) {
        const glm::vec4 at(light.position, over_intensity(1, light));
        uploaded.push_back({{at.x, at.y, -at.z, at.w}});
      }
      lights_.put(device, "uploading lights to choose from", uploaded);
    }
    std::vector<float> edges = slice_edges(plan.settings[setting::slice_spacing], plan.lists.slices,
                                           plan.lists.near_m, plan.lists.far_m);
    edges.insert(edges.begin(), -FAR_AWAY);
    edges.push_back(FAR_AWAY);
    edges_.put(device, "uploading edges of slices", edges);
    params_.put(device, "uploading the view", std::vector<CullParams>{tiles});
  }

  NamedKernel kernel_;  // without random numbers
  std::string defines_;
  PassKernels sampling_;
  UploadedBuffer lights_, edges_, params_;
  UploadedBuffer nodes_, leaves_, eye_;  // buffers of the light tree
  size_t leaf_count_ = 0;
  int tree_of_ = 0;  // the version of its lights
  bool stale_ = true;
};

void cap_lists(PassContext& work, Cached<ListCaps>& cache, const CullParams& tiles, const TileBounds& bounds,
               ViewGrid& grid) {
  const bool samples = samples_lists(work.plan.settings);
  if (work.plan.settings[setting::list_cap] == 0 || (samples && !work.plan.lists.sampled)) return;
  if (samples) grid.factor_bytes = std::max<size_t>(grid.index_count, 1) * sizeof(cl_float);
  ListCaps& caps = cache.of(work);
  auto pass = work.timer.pass("cap_lists", "cl");
  caps.cap(work, tiles, bounds, grid);
  const size_t bytes = grid.cell_bytes + grid.index_bytes + grid.factor_bytes;
  pass.moves(bytes, bytes);
}

ViewGrid lists_of_tree(PassContext& work, Cached<ListCaps>& cache, const CullParams& tiles,
                       const TileBounds& bounds, SharedGridStorage& storage) {
  ListCaps& caps = cache.of(work);
  const FramePlan& plan = work.plan;
  ViewGrid grid;
  grid.storage = &storage;
  grid.cells_x = int(tiles.tiles_x);
  grid.cells_y = int(tiles.tiles_y);
  grid.slices = plan.lists.slices;
  const size_t cells = size_t(tiles.tiles_x) * tiles.tiles_y * size_t(plan.lists.slices);
  grid.index_count = cells * size_t(plan.settings[setting::list_cap]);
  grid.index_bits = plan.lights.index_bits;
  grid.cell_bytes = cells * sizeof(cl_uint2);
  grid.index_bytes = grid.index_count * size_t(plan.lights.index_bits / 8);
  grid.factor_bytes = grid.index_count * sizeof(cl_float);
  auto pass = work.timer.pass("lists_of_tree", "cl");
  caps.draw(work, tiles, bounds, grid);
  pass.moves(caps.memory_bytes(), grid.bytes());
  return grid;
}

void cap_list(const Settings& settings, const std::vector<ViewLight>& lights, const glm::dvec3& middle,
              std::vector<uint32_t>& list) {
  const size_t cap = size_t(settings[setting::list_cap]);
  if (cap == 0 || list.size() <= cap) return;
  if (settings[setting::list_cap_order] != ListCapOrder::index) {
    std::ranges::stable_sort(list, {}, [&](uint32_t i) {
      const glm::dvec3 away = lights[i].position - middle;
      const double distance2 = glm::dot(away, away);
      return settings[setting::list_cap_order] == ListCapOrder::distance
                 ? distance2
                 : over_intensity(distance2, lights[i]);
    });
  }
  list.resize(cap);
  std::ranges::sort(list);
}

}  // namespace lightgrid
