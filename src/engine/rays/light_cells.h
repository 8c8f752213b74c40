// Lists of the triangles around point lights and in the way of directional ones, from which kernels answer
// shadow rays without the tree (kernels/rays/light_cells.h), to the same bits.
//
//   cells.forget_near(low, high);                   // where something moved
//   cells.make(rays, lights, limits);               // in each frame
//   cells.tables(lights), cells.arguments();        // for its kernels
//
// A light has lists once it and all in its range have rested for as many frames as the limits need. Before
// that, and where memory does not suffice, it has none, and kernels take the tree. Lists of lights that are
// gone stay while there is room for others. Errors as in rays/ray_scene.h, except that a device without
// memory for lists leaves lights without any.
#pragma once

#include <compare>
#include <map>
#include <span>
#include <vector>

#include "rays/block_pool.h"
#include "rays/ray_scene.h"
#include "shared/cull_settings.h"
#include "shared/light_cells.h"

namespace lightgrid {

// A point light's position relative to the rays' origin, metres, or the unit direction towards a directional
// light. A range below 0: it needs no lists.
struct CellLight {
  double x = 0, y = 0, z = 0, range_m = -1;
  bool directional = false;
  double axis_x = 0, axis_y = 0, axis_z = 0, cos_outer = -1;  // rays outside of this cone take the tree
  auto operator<=>(const CellLight&) const = default;
};

struct LightCellLimits {
  size_t bytes = 0;      // of all lists
  size_t triangles = 0;  // in the reach of lights that get lists, on average over the calls
};

class LightCells {
 public:
  // `device` and `programs` outlive it. shape: of the kernels that make lists. Kernels of both shapes read
  // them.
  LightCells(ClDevice& device, ProgramCache& programs, KernelShape shape = KernelShape::automatic)
      : device_(device),
        programs_(programs),
        lanes_(shape == KernelShape::automatic ? device.info().cpu : shape == KernelShape::lanes) {}

  // All triangles may have changed.
  void forget();
  // Triangles in this box changed; relative to the rays' origin.
  void forget_near(const glm::dvec3& low, const glm::dvec3& high);
  // Lists for those of the lights that rest since the last call, within the limits. The first call gives all
  // of them lists, however many triangles they have.
  void make(const RayScene& rays, std::span<const CellLight> lights, const LightCellLimits& limits);

  // The lists that each light has now.
  std::vector<LightCellTable> tables(std::span<const CellLight> lights) const;
  // LIGHT_CELL_ARGUMENTS after the tables.
  ClArguments arguments() const;
  size_t memory_bytes() const;

 private:
  struct Block {
    uint32_t unit = 0;
    size_t bytes = 0;
  };
  struct Lists {
    LightCellTable table{};
    LightCellJob job{};
    bool is_listed = false, is_gathered = false;
    uint32_t gathered = 0, entry_count = 0;  // entry_count: at first a guess
    Block fixed{}, entries{};
    size_t first_frame = 0, last_frame = 0, refused = 0;  // refused: value of frees_ when there was no room
  };
  using Waiting = std::vector<std::pair<const CellLight, Lists>*>;

  Waiting waiting_lights(std::span<const CellLight> lights, bool also_new);
  void gather(const RayScene& rays, Waiting& waiting);
  void list(const RayScene& rays, Waiting chosen);
  bool take(Block& block, size_t bytes);
  void shrink(Block& block, size_t bytes);
  void free(Lists& lists);
  bool has_taken(const CellLight& light, Lists& lists);
  void reserve(const Waiting& chosen);
  bool evict_oldest();
  std::vector<LightCellJob> jobs_of(Waiting& chosen);
  bool settle(const CellLight& light, const LightCellJob& job, Lists& lists);
  NamedKernel& kernel(const char* stem);
  // groups: of each job, on GPUs.
  void launch(const char* stem, size_t jobs, const ClArguments& arguments, size_t groups = 32);
  size_t workers(const std::vector<LightCellJob>& jobs) const;
  void launch_lanes(const RayScene& rays, const std::vector<LightCellJob>& jobs, const cl::Buffer& scratch);
  void launch_groups(const RayScene& rays, size_t jobs);
  void read_jobs(std::vector<LightCellJob>& jobs);
  void write_jobs(const std::vector<LightCellJob>& jobs);

  ClDevice& device_;
  ProgramCache& programs_;
  const bool lanes_;
  std::map<CellLight, Lists> lists_;
  std::map<std::string, NamedKernel> kernels_;
  BlockPool pool_;
  GrowingBuffer jobs_;
  size_t max_bytes_ = 0, frame_ = 0, frees_ = 1;
};

}  // namespace lightgrid
