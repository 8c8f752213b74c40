// Blocks of a buffer, which grows up to a bound and keeps its contents.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "cl/buffers.h"

namespace lightgrid {

class BlockPool {
 public:
  static constexpr size_t unit_bytes = 64;

  // The block's first unit. None: there is no room.
  std::optional<uint32_t> take(size_t bytes);
  // A block of `bytes` keeps its first new_bytes.
  void shrink(uint32_t unit, size_t bytes, size_t new_bytes);
  void give_back_all();
  // Room for `bytes` more, or as much as max_bytes allows. False: it is as large as it may be, or can be on
  // this device. The queue may still read the buffer that it had.
  bool grow(ClDevice& device, size_t bytes, size_t max_bytes);

  const cl::Buffer& buffer() const { return buffer_; }
  size_t bytes() const { return size_t(units_) * unit_bytes; }

 private:
  void add_free(uint32_t first, uint32_t units);

  cl::Buffer buffer_;
  uint32_t units_ = 0;
  bool is_refused_ = false;            // by the device
  std::map<uint32_t, uint32_t> free_;  // first unit and number of units; none borders on another
};

}  // namespace lightgrid
