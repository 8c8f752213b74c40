#include "rays/block_pool.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "cl/transfer.h"

namespace lightgrid {
namespace {

uint32_t units_of(size_t bytes) {
  return uint32_t((bytes + BlockPool::unit_bytes - 1) / BlockPool::unit_bytes);
}

}  // namespace

std::optional<uint32_t> BlockPool::take(size_t bytes) {
  const uint32_t units = units_of(bytes);
  const auto at = std::ranges::find_if(free_, [&](const auto& range) { return range.second >= units; });
  if (at == free_.end()) return {};
  const auto [first, length] = *at;
  free_.erase(at);
  if (length > units) free_[first + units] = length - units;
  return first;
}

void BlockPool::add_free(uint32_t first, uint32_t units) {
  if (units == 0) return;
  auto at = free_.emplace(first, units).first;
  if (const auto next = std::next(at); next != free_.end() && first + units == next->first) {
    at->second += next->second;
    free_.erase(next);
  }
  if (at == free_.begin()) return;
  if (const auto before = std::prev(at); before->first + before->second == first) {
    before->second += at->second;
    free_.erase(at);
  }
}

void BlockPool::shrink(uint32_t unit, size_t bytes, size_t new_bytes) {
  const uint32_t kept = units_of(new_bytes);
  add_free(unit + kept, units_of(bytes) - kept);
}

void BlockPool::give_back_all() {
  free_.clear();
  add_free(0, units_);
}

bool BlockPool::grow(ClDevice& device, size_t bytes, size_t max_bytes) {
  const size_t most = std::min(max_bytes, size_t(UINT32_MAX / 16) * unit_bytes) / unit_bytes;
  if (is_refused_ || most <= units_) return false;
  const uint32_t units =
      uint32_t(std::min(most, std::max(size_t(units_) * 2, units_ + size_t(units_of(bytes)))));
  cl::Buffer grown;
  try {
    grown = device_buffer(device, units * unit_bytes);
  } catch (const Error&) {
    is_refused_ = true;
    return false;
  }
  if (units_) copy_buffer(device, "light cells: growing", buffer_, grown, this->bytes());
  buffer_ = grown;
  const uint32_t before = std::exchange(units_, units);
  add_free(before, units - before);
  return true;
}

}  // namespace lightgrid
