#include "rays/light_cells.h"

#include <algorithm>
#include <cmath>

#include "cl/transfer.h"

namespace lightgrid {
namespace {

constexpr uint32_t max_triangles = 1 << 18;  // in reach of a light with lists

// About 0.7 cells per triangle: the fastest frames in five scenes, or within their noise (docs/rays.md).
uint32_t cells_across(uint32_t triangles) {
  const long eighths = std::lround(std::sqrt(0.12 * triangles) / 8);
  return uint32_t(std::clamp(8 * eighths, 8L, 96L));
}

// Longer than the range by more than shading rounds, unless the eye is very far away: the tree then serves
// rays at the range's end.
float reach_of(const CellLight& light) {
  return float(1.002 * light.range_m + 1e-5 * (std::abs(light.x) + std::abs(light.y) + std::abs(light.z)));
}

LightCellTable table_of(const LightCellJob& job) {
  constexpr float longest = 0x1p46f;  // squared: dot products with edges' planes stay finite
  return {job.first_start, job.size, std::min(0.999f * job.reach_m * job.reach_m, longest)};
}

size_t start_count(uint32_t size) { return 6 * (size_t(size) * size + 1); }

}  // namespace

void GrowingPool::grow(ClDevice& device) {
  const size_t kept = std::exchange(kept_, used_);
  if (buffer_() && used_ <= bytes_) return;
  const size_t room = kept == 0 ? used_ : used_ + used_ / 4;
  const cl::Buffer grown = device_buffer(device, room);
  copy_buffer(device, "light cells: growing", buffer_, grown, kept);
  buffer_ = grown, bytes_ = room;
}

void LightCells::forget() {
  lists_.clear();
  for (GrowingPool* pool : {&starts_, &entries_, &triangles_}) pool->clear();
  is_new_ = true, is_full_ = false, erased_bytes_ = 0;
}

void LightCells::forget_near(const glm::dvec3& low, const glm::dvec3& high) {
  std::erase_if(lists_, [&](const auto& item) {
    const glm::dvec3 at(item.first.x, item.first.y, item.first.z);
    const double away = glm::length(at - glm::clamp(at, low, high));
    const glm::dvec3 farthest = glm::abs(at) + glm::max(glm::abs(low), glm::abs(high));
    // More than the builder's box tests allow for rounding.
    const double slack = 1e-4 * (farthest.x + farthest.y + farthest.z);
    const bool is_near = !(away > 1.01 * double(reach_of(item.first)) + slack);
    if (is_near) erased_bytes_ += item.second.bytes;
    return is_near;
  });
}

// Of lists that no light of this frame has.
size_t LightCells::dead_bytes() const {
  size_t bytes = erased_bytes_;
  for (const auto& [light, lists] : lists_) bytes += lists.last_frame == frame_ ? 0 : lists.bytes;
  return bytes;
}

// Those without lists that were there before, or all.
LightCells::Waiting LightCells::waiting_lights(std::span<const CellLight> lights, bool also_new) {
  Waiting waiting;
  for (const CellLight& light : lights) {
    if (!(light.range_m >= 0)) continue;
    const auto [at, is_new] = lists_.try_emplace(light);
    const bool is_seen = at->second.last_frame == frame_;
    at->second.last_frame = frame_;
    if (!at->second.is_listed && !is_seen && (also_new || !is_new)) waiting.push_back(&*at);
  }
  return waiting;
}

void LightCells::make(const RayScene& rays, std::span<const CellLight> lights,
                      const LightCellLimits& limits) {
  ++frame_, max_bytes_ = limits.bytes / 5 * 4;  // pools grow by a quarter more
  const bool all = std::exchange(is_new_, false);
  Waiting waiting = waiting_lights(lights, all);
  std::erase_if(lists_,
                [&](const auto& item) { return !item.second.is_listed && item.second.last_frame != frame_; });
  // Room of lists that are gone is not used again: once half of all room is theirs, all lists begin again.
  if (is_full_ && dead_bytes() > max_bytes_ / 2) {
    forget(), is_new_ = false;
    waiting = waiting_lights(lights, true);
  }
  if (!waiting.empty() && !is_full_) {
    gather(rays, waiting);
    std::erase_if(waiting, [](const auto* item) { return item->second.gathered > max_triangles; });
    // The heaviest first, so that no core waits for the last one.
    std::ranges::stable_sort(waiting, std::greater(), [](const auto* item) { return item->second.gathered; });
    size_t sum = 0;
    const auto fits = [&](const auto* item) { return (sum += item->second.gathered) <= limits.triangles; };
    if (!all && !waiting.empty())
      waiting.erase(std::find_if_not(waiting.begin() + 1, waiting.end(), fits), waiting.end());
    list(rays, waiting);
  }
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

void LightCells::launch(const char* stem, const RayScene& rays, size_t jobs, const ClArguments& pools) {
  NamedKernel& kernel = kernels_[stem];
  if (!kernel) kernel = NamedKernel(programs_, std::string("rays/cpu/") + stem, "");
  kernel.launch(device_, stem, cl::NDRange(jobs), cl::NDRange(1),
                rays.arguments() + ClArguments{{"jobs", jobs_.get()}} + pools);
}

// How many triangles each has in reach, where that is unknown.
void LightCells::gather(const RayScene& rays, Waiting& waiting) {
  std::vector<LightCellJob> jobs;
  for (const auto* item : waiting) {
    const CellLight& light = item->first;
    if (!item->second.is_gathered) jobs.push_back({light.x, light.y, light.z, reach_of(light)});
  }
  if (jobs.empty()) return;
  write_jobs(jobs);
  launch("gather_light_cells", rays, jobs.size(), {});
  read_jobs(jobs);
  size_t next = 0;
  for (auto* item : waiting)
    if (!std::exchange(item->second.is_gathered, true)) item->second.gathered = jobs[next++].gathered;
}

bool LightCells::has_room(size_t bytes) const {
  return starts_.used() + entries_.used() + triangles_.used() + bytes <= max_bytes_;
}

// For those of the lights whose lists will probably fit; the others leave `chosen`.
std::vector<LightCellJob> LightCells::take_triangles(Waiting& chosen) {
  constexpr size_t entries_per_triangle = 5;  // 4.4 in the scenes that were measured
  std::vector<LightCellJob> jobs;
  size_t expected = 0;
  std::erase_if(chosen, [&](const auto* item) {
    const CellLight& light = item->first;
    LightCellJob job{light.x, light.y, light.z, reach_of(light), item->second.gathered};
    job.size = cells_across(job.gathered);
    const size_t starts = start_count(job.size), entries = job.gathered * entries_per_triangle;
    if (!has_room(expected + job.gathered * sizeof(LightCellTriangle) + starts * sizeof(uint32_t) +
                  entries * sizeof(LightCellEntry)))
      return is_full_ = true;
    expected += entries * sizeof(LightCellEntry);
    job.first_triangle = triangles_.take(job.gathered, sizeof(LightCellTriangle));
    job.first_start = starts_.take(starts, sizeof(uint32_t));
    jobs.push_back(job);
    return false;
  });
  triangles_.grow(device_), starts_.grow(device_);
  return jobs;
}

// For as many of the jobs as there is room for; the others leave them.
void LightCells::take_entries(std::vector<LightCellJob>& jobs, const Waiting& chosen) {
  size_t kept = 0;
  for (size_t i = 0; i < jobs.size(); ++i) {
    LightCellJob job = jobs[i];
    Lists& lists = chosen[i]->second;
    lists.bytes = job.gathered * sizeof(LightCellTriangle) + start_count(job.size) * sizeof(uint32_t);
    if (!has_room(job.entries * sizeof(LightCellEntry))) {
      is_full_ = true;
      continue;
    }
    lists.bytes += job.entries * sizeof(LightCellEntry);
    job.first_entry = entries_.take(job.entries, sizeof(LightCellEntry));
    lists.table = table_of(job), lists.is_listed = true;
    jobs[kept++] = job;
  }
  jobs.resize(kept);
  entries_.grow(device_);
}

void LightCells::list(const RayScene& rays, Waiting& chosen) {
  std::vector<LightCellJob> jobs = take_triangles(chosen);
  if (!jobs.empty()) {
    write_jobs(jobs);
    launch("count_light_cells", rays, jobs.size(),
           {{"seen", triangles_.buffer()}, {"starts", starts_.buffer()}});
    read_jobs(jobs);
  }
  take_entries(jobs, chosen);
  if (jobs.empty()) return;
  write_jobs(jobs);
  launch("fill_light_cells", rays, jobs.size(),
         {{"seen", triangles_.buffer()}, {"starts", starts_.buffer()}, {"entries", entries_.buffer()}});
}

ClArguments LightCells::arguments() const {
  return {{"light_cell_starts", starts_.buffer()},
          {"light_cell_entries", entries_.buffer()},
          {"light_cell_triangles", triangles_.buffer()}};
}

size_t LightCells::memory_bytes() const {
  return starts_.bytes() + entries_.bytes() + triangles_.bytes() + jobs_.bytes();
}

}  // namespace lightgrid
