#include "rays/light_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "cl/transfer.h"

namespace lightgrid {
namespace {

constexpr uint32_t max_triangles = 1 << 18;  // in reach of a light with lists

constexpr size_t group_items = 256;  // of the kernels for GPUs

// Entries in a light's list, averaged over entries: with more the tree is faster (docs/rays.md).
float longest_list(bool directional, bool lanes) {
  return directional ? 256 : lanes ? std::numeric_limits<float>::infinity() : 128;
}

// About 0.7 cells per triangle: the fastest frames in five scenes, or within their noise (docs/rays.md). The
// triangles of a spot lie in the cells of its cone, a part of the cube.
uint32_t cells_across(const CellLight& light, uint32_t triangles) {
  const double part = light.directional ? 1 : std::clamp((1 - light.cos_outer) / 2, 0.01, 1.0);
  const long eighths = std::lround(std::sqrt((light.directional ? 0.72 : 0.12) * triangles / part) / 8);
  return uint32_t(std::clamp(8 * eighths, 8L, light.directional ? 256L : 96L));
}

// Longer than the range by more than shading rounds, unless the eye is very far away: the tree then serves
// rays at the range's end.
float reach_of(const CellLight& light) {
  if (light.directional) return std::numeric_limits<float>::infinity();
  constexpr double most = std::numeric_limits<float>::max();
  const double size = std::abs(light.x) + std::abs(light.y) + std::abs(light.z);
  return float(std::min(1.002 * light.range_m + 1e-5 * size, most));
}

LightCellJob job_of(const CellLight& light) {
  constexpr float most = std::numeric_limits<float>::max();
  LightCellJob job{light.x, light.y, light.z, light.directional ? 0.0 : 1.0, reach_of(light)};
  // Wider than the cone, so that few rays of shading's wider one take the tree.
  job.grid.top = float(light.cos_outer > -1 ? std::max(light.cos_outer - 2e-3, -1.0) : -2.0);
  const double axis[3] = {light.axis_x, light.axis_y, light.axis_z};
  std::ranges::copy(axis, job.grid.toward);
  std::ranges::fill(job.low, most);
  std::ranges::fill(job.high, -most);
  return job;
}

LightCellTable table_of(const LightCellJob& job) {
  constexpr float longest = 0x1p46f;  // squared: dot products with edges' planes stay finite
  const float most = job.w != 0 ? job.reach_m : job.extent_m / 2;
  return {job.first_start, job.size, std::min(0.999f * most * most, longest), job.first_triangle, job.grid};
}

// An axis of the grid over the box.
void lay_axis(const glm::dvec3& axis, const glm::dvec3& center, const glm::dvec3& half,
              const LightCellJob& job, float cells[4], float metres[3]) {
  const double width_m = std::max(2 * glm::dot(glm::abs(axis), half), 1e-6 * job.extent_m),
               per_m = job.size / width_m;
  const glm::vec3 across(axis * per_m);
  const glm::dvec3 back = glm::dvec3(across) / glm::dot(glm::dvec3(across), glm::dvec3(across));
  for (int k = 0; k < 3; ++k) {
    cells[k] = across[k];
    metres[k] = float(back[k]);
  }
  cells[3] = float(-per_m * glm::dot(axis, center) + 0.5 * job.size);
}

void lay_grid(LightCellJob& job) {
  const glm::dvec3 low(job.low[0], job.low[1], job.low[2]), high(job.high[0], job.high[1], job.high[2]),
      center = 0.5 * (low + high), half = high - center, toward(job.x, job.y, job.z),
      most = glm::max(glm::abs(low), glm::abs(high)), size = glm::abs(toward);
  job.extent_m = float(4 * (most.x + most.y + most.z) + 1e-30);
  glm::dvec3 other(0);
  other[size.x <= std::min(size.y, size.z) ? 0 : size.y <= size.z ? 1 : 2] = 1;
  const glm::dvec3 u = glm::normalize(glm::cross(toward, other)), v = glm::cross(toward, u);
  lay_axis(u, center, half, job, job.grid.u, job.metres_u);
  lay_axis(v, center, half, job, job.grid.v, job.metres_v);
  for (int k = 0; k < 3; ++k) job.grid.toward[k] = float(toward[k]);
  job.grid.top = float(glm::dot(toward, center) + glm::dot(size, half) + 0x1p-16 * job.extent_m);
}

size_t start_units(const CellLight& light, size_t size) {
  const size_t starts = (light.directional ? 1 : 6) * (size * size + 1);
  return (starts * sizeof(uint32_t) + BlockPool::unit_bytes - 1) / BlockPool::unit_bytes;
}

// Bytes for the starts of a light's cells and for its triangles.
size_t fixed_bytes(const CellLight& light, uint32_t triangles) {
  return start_units(light, cells_across(light, triangles)) * BlockPool::unit_bytes +
         triangles * sizeof(LightCellTriangle);
}

uint32_t entry_room(uint32_t entries) { return entries + 16; }
size_t entry_bytes(uint32_t entries) { return entry_room(entries) * sizeof(LightCellEntry); }

uint32_t max_entries(const std::vector<LightCellJob>& jobs) {
  return std::ranges::max_element(jobs, {}, &LightCellJob::entry_room)->entry_room;
}

// Allows for more rounding than the builder's box tests do.
bool is_near(const CellLight& light, const glm::dvec3& low, const glm::dvec3& high) {
  if (light.directional) return true;
  const glm::dvec3 at(light.x, light.y, light.z),
      far = glm::abs(at) + glm::max(glm::abs(low), glm::abs(high));
  const double away = glm::length(at - glm::clamp(at, low, high));
  return !(away > 1.01 * double(reach_of(light)) + 1e-4 * (far.x + far.y + far.z));
}

template <typename T>
uint32_t first_item(size_t unit) {
  return uint32_t(unit * BlockPool::unit_bytes / sizeof(T));
}

}  // namespace

void LightCells::shrink(Block& block, size_t bytes) {
  pool_.shrink(block.unit, block.bytes, bytes);
  block.bytes = bytes;
  ++frees_;
}

void LightCells::free(Lists& lists) {
  for (Block* block : {&lists.fixed, &lists.entries}) shrink(*block, 0);
}

void LightCells::forget() {
  lists_.clear();
  pool_.give_back_all();
  ++frees_;
}

void LightCells::forget_near(const glm::dvec3& low, const glm::dvec3& high) {
  for (auto at = lists_.begin(); at != lists_.end();) {
    if (is_near(at->first, low, high)) {
      free(at->second);
      at = lists_.erase(at);
    } else
      ++at;
  }
}

// Drops the lists that have been unused for longest. False: this frame uses all of them.
bool LightCells::evict_oldest() {
  const auto oldest = std::ranges::min_element(
      lists_, {}, [](const auto& item) { return item.second.is_listed ? item.second.last_frame : SIZE_MAX; });
  if (oldest == lists_.end() || !oldest->second.is_listed || oldest->second.last_frame == frame_)
    return false;
  free(oldest->second);
  lists_.erase(oldest);
  return true;
}

bool LightCells::take(Block& block, size_t bytes) {
  for (;;) {
    if (const auto unit = pool_.take(bytes)) {
      block = {*unit, bytes};
      return true;
    }
    if (bytes > max_bytes_ || (!pool_.grow(device_, bytes, max_bytes_) && !evict_oldest())) return false;
  }
}

// So that the pool need not grow again and again.
void LightCells::reserve(const Waiting& chosen) {
  size_t bytes = 0;
  for (const auto* item : chosen)
    bytes += fixed_bytes(item->first, item->second.gathered) + entry_bytes(item->second.entry_count);
  if (bytes) pool_.grow(device_, bytes, max_bytes_);
}

// The lights without lists; new lights only if also_new.
LightCells::Waiting LightCells::waiting_lights(std::span<const CellLight> lights, bool also_new) {
  Waiting waiting;
  for (const CellLight& light : lights) {
    if (!(light.range_m >= 0)) continue;
    const auto [at, is_new] = lists_.try_emplace(light);
    Lists& lists = at->second;
    if (is_new) lists.first_frame = frame_;
    const bool is_seen = std::exchange(lists.last_frame, frame_) == frame_;
    if (!lists.is_listed && !is_seen && (also_new || !is_new) && lists.refused != frees_)
      waiting.push_back(&*at);
  }
  return waiting;
}

void LightCells::make(const RayScene& rays, std::span<const CellLight> lights,
                      const LightCellLimits& limits) {
  const bool is_first = frame_++ == 0;
  max_bytes_ = limits.bytes;
  Waiting waiting = waiting_lights(lights, is_first);
  std::erase_if(lists_,
                [&](const auto& item) { return !item.second.is_listed && item.second.last_frame != frame_; });
  if (waiting.empty()) return;
  gather(rays, waiting);
  std::erase_if(waiting, [](const auto* item) { return item->second.gathered > max_triangles; });
  // The heaviest first, so that no core waits for the last one.
  std::ranges::stable_sort(waiting, std::greater(), [](const auto* item) { return item->second.gathered; });
  size_t sum = 0;
  const auto fits = [&](const auto* item) { return (sum += item->second.gathered) <= limits.triangles; };
  const auto is_early = [&](const auto* item) {
    return (frame_ - item->second.first_frame) * limits.triangles < item->second.gathered;
  };
  if (is_first)
    reserve(waiting);
  else if (std::erase_if(waiting, is_early); !waiting.empty())
    waiting.erase(std::find_if_not(waiting.begin() + 1, waiting.end(), fits), waiting.end());
  list(rays, waiting);
}

std::vector<LightCellTable> LightCells::tables(std::span<const CellLight> lights) const {
  std::vector<LightCellTable> tables;
  for (const CellLight& light : lights) {
    const auto at = lists_.find(light);
    tables.push_back(at == lists_.end() ? LightCellTable{} : at->second.table);
  }
  return tables;
}

void LightCells::write_jobs(const std::vector<LightCellJob>& jobs) {
  const size_t bytes = jobs.size() * sizeof(LightCellJob);
  write_buffer(device_, "light cells: jobs", jobs_.at_least(device_, bytes), jobs.data(), bytes);
}

void LightCells::read_jobs(std::vector<LightCellJob>& jobs) {
  read_buffer(device_, "light cells: jobs", jobs_.get(), jobs.data(), jobs.size() * sizeof(LightCellJob));
}

NamedKernel& LightCells::kernel(const char* stem) {
  NamedKernel& kernel = kernels_[stem];
  if (!kernel) kernel = NamedKernel(programs_, std::string(lanes_ ? "rays/cpu/" : "rays/gpu/") + stem, "");
  return kernel;
}

void LightCells::launch(const char* stem, size_t jobs, const ClArguments& arguments, size_t groups) {
  const cl::NDRange items = lanes_ ? cl::NDRange(jobs) : cl::NDRange(groups * group_items, jobs),
                    group = lanes_ ? cl::NDRange(1) : cl::NDRange(group_items, 1);
  kernel(stem).launch(device_, stem, items, group, arguments);
}

// Counts the triangles in reach of each light, once per light.
void LightCells::gather(const RayScene& rays, Waiting& waiting) {
  std::vector<LightCellJob> jobs;
  for (const auto* item : waiting) {
    if (!item->second.is_gathered) jobs.push_back(job_of(item->first));
  }
  if (jobs.empty()) return;
  write_jobs(jobs);
  launch("gather_light_cells", jobs.size(), rays.arguments() + ClArguments{{"jobs", jobs_.get()}});
  read_jobs(jobs);
  constexpr uint32_t entries_per_triangle = 6;  // 4.4 in the scenes that were measured
  size_t next = 0;
  for (auto* item : waiting) {
    Lists& lists = item->second;
    if (std::exchange(lists.is_gathered, true)) continue;
    lists.job = jobs[next++];
    lists.gathered = item->first.directional ? rays.triangles() : lists.job.gathered;
    lists.entry_count = std::min(lists.gathered, max_triangles) * entries_per_triangle;
  }
}

// Takes room for all of a light's lists, as far as their sizes are known.
bool LightCells::has_taken(const CellLight& light, Lists& lists) {
  if (lists.refused == frees_) return false;
  if (take(lists.fixed, fixed_bytes(light, lists.gathered)) &&
      take(lists.entries, entry_bytes(lists.entry_count)))
    return true;
  free(lists);
  lists.refused = frees_;
  return false;
}

// Jobs for the lights that there is room for. The other lights leave `chosen`.
std::vector<LightCellJob> LightCells::jobs_of(Waiting& chosen) {
  std::erase_if(chosen, [&](auto* item) { return !has_taken(item->first, item->second); });
  std::vector<LightCellJob> jobs;
  for (const auto* item : chosen) {
    const auto& [light, lists] = *item;
    LightCellJob job = lists.job;
    job.gathered = lists.gathered;
    job.size = cells_across(light, lists.gathered);
    if (light.directional) lay_grid(job);
    job.first_start = first_item<uint32_t>(lists.fixed.unit);
    job.first_triangle = lists.fixed.unit + uint32_t(start_units(light, job.size));
    job.first_entry = first_item<LightCellEntry>(lists.entries.unit);
    job.entry_room = entry_room(lists.entry_count);
    jobs.push_back(job);
  }
  return jobs;
}

// Gives back the room that was too much. Returns false if there was too little.
bool LightCells::settle(const CellLight& light, const LightCellJob& job, Lists& lists) {
  lists.entry_count = job.entries;
  if (entry_room(job.entries) > job.entry_room) {
    free(lists);
    return false;
  }
  if (job.list_length > longest_list(light.directional, lanes_)) {
    free(lists);
    lists.gathered = UINT32_MAX;
    return true;
  }
  shrink(lists.fixed,
         start_units(light, job.size) * BlockPool::unit_bytes + job.triangles * sizeof(LightCellTriangle));
  shrink(lists.entries, job.entries * sizeof(LightCellEntry));
  lists.table = table_of(job);
  lists.is_listed = true;
  return true;
}

// On CPUs a work-item takes light after light, and needs room to sort the entries of one.
size_t LightCells::workers(const std::vector<LightCellJob>& jobs) const {
  return std::min<size_t>(jobs.size(), device_.info().compute_units);
}

void LightCells::launch_lanes(const RayScene& rays, const std::vector<LightCellJob>& jobs,
                              const cl::Buffer& scratch) {
  const cl::Buffer next = device_buffer(device_, sizeof(uint32_t));
  fill_buffer(device_, "light cells: jobs", next, 0, sizeof(uint32_t));
  launch("list_light_cells", workers(jobs),
         rays.arguments() + ClArguments{{"jobs", jobs_.get()},
                                        {"job_count", cl_uint(jobs.size())},
                                        {"next_job", next},
                                        {"scratch", scratch},
                                        {"scratch_items", cl_ulong(max_entries(jobs))},
                                        {"pool", pool_.buffer()}});
}

void LightCells::launch_groups(const RayScene& rays, size_t jobs) {
  const ClArguments lists = {{"jobs", jobs_.get()}, {"pool", pool_.buffer()}}, all = rays.arguments() + lists;
  launch("store_light_cells", jobs, all);
  launch("list_light_cells", jobs, all + ClArguments{{"fill", cl_uint(0)}});
  launch("sum_light_cells", jobs, lists, 1);
  launch("list_light_cells", jobs, all + ClArguments{{"fill", cl_uint(1)}});
  launch("sort_light_cells", jobs, lists);
}

void LightCells::list(const RayScene& rays, Waiting chosen) {
  std::vector<LightCellJob> jobs = jobs_of(chosen);
  if (jobs.empty()) return;
  cl::Buffer scratch;
  try {
    if (lanes_) scratch = device_buffer(device_, workers(jobs) * max_entries(jobs) * sizeof(uint64_t));
  } catch (const Error&) {  // these lights keep the tree
    for (auto* item : chosen) free(item->second);
    for (auto* item : chosen) item->second.refused = frees_;
    return;
  }
  write_jobs(jobs);
  if (lanes_)
    launch_lanes(rays, jobs, scratch);
  else
    launch_groups(rays, jobs.size());
  read_jobs(jobs);
  Waiting again;
  for (size_t i = 0; i < jobs.size(); ++i)
    if (!settle(chosen[i]->first, jobs[i], chosen[i]->second)) again.push_back(chosen[i]);
  list(rays, std::move(again));
}

ClArguments LightCells::arguments() const {
  return {{"light_cell_starts", pool_.buffer()},
          {"light_cell_entries", pool_.buffer()},
          {"light_cell_triangles", pool_.buffer()}};
}

size_t LightCells::memory_bytes() const { return pool_.bytes() + jobs_.bytes(); }

}  // namespace lightgrid
