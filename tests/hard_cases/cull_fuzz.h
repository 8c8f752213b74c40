// Culling inputs from bytes; none may cause a crash, a hang or an out-of-bounds read. Used by libFuzzer and
// by the deterministic test of ctest.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "verify/check.h"

namespace lightgrid::verify {

class Bytes {
 public:
  Bytes(const uint8_t* data, size_t size) : data_(data), left_(size) {}
  bool empty() const { return left_ == 0; }

  template <typename T>
  T take() {
    T value{};
    const size_t size = std::min(sizeof(T), left_);
    std::memcpy(&value, data_, size);
    data_ += size, left_ -= size;
    return value;
  }
  int up_to(int most) { return take<uint8_t>() % (most + 1); }

  // Usually a plausible number, sometimes a special one, sometimes any bits.
  double number(double low, double high) {
    constexpr double inf = std::numeric_limits<double>::infinity(),
                     nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double special[] = {0,      -0.0, nan,   -nan, inf,   -inf,  1e-45, -1e-45,
                                  1e-310, 1e20, -1e20, 1e38, -1e38, 1e300, 1,     -1};
    const int kind = up_to(31);
    if (kind == 0) return take<double>();
    if (kind == 1) return take<float>();
    if (kind <= 4) return special[up_to(15)];
    return low + (high - low) * (take<uint16_t>() / 65535.0);
  }

 private:
  const uint8_t* data_;
  size_t left_;
};

struct FuzzInput {
  CullerOptions options;
  CullView view;
  std::vector<CullLight> lights;
  std::vector<DepthInterval> bounds;
  DepthImage depth;
};

// Sizes and settings in their range; every number may be anything.
inline FuzzInput fuzz_input(Bytes bytes) {
  FuzzInput in;
  // Few settings, because each builds its own kernels: four combinations. Slices and standard depth are
  // kernels of their own too.
  constexpr struct {
    CullTest test;
    DepthBoundsMode mode;
    DepthFormat format;
    int tile, samples, index_bits;
    GridLists lists;
    bool portable, blend, sliced;
    DepthOrder order;
  } kinds[] = {{CullTest::planes_aabb, DepthBoundsMode::minmax, DepthFormat::d32f, 16, 1, 0, GridLists::lists,
                false, false, false, DepthOrder::reversed},
               {CullTest::exact, DepthBoundsMode::mask32, DepthFormat::d16, 8, 1, 32, GridLists::masks, false,
                true, true, DepthOrder::standard},
               {CullTest::sphere, DepthBoundsMode::halfz_modified, DepthFormat::d24, 16, 4, 16,
                GridLists::lists, true, false, true, DepthOrder::reversed},
               {CullTest::aabb, DepthBoundsMode::halfz, DepthFormat::d32f, 32, 1, 16, GridLists::masks, true,
                true, false, DepthOrder::standard}};
  CullerOptions& o = in.options;
  const auto& kind = kinds[bytes.up_to(3)];
  o.cull_test = kind.test, o.depth_bounds = kind.mode, o.depth_format = kind.format, o.tile = kind.tile;
  o.samples = kind.samples, o.index_bits = kind.index_bits, o.lists = kind.lists;
  o.portable = kind.portable, o.blend = kind.blend;
  Lens lens;
  // One special number in a projection is usually refused, and nothing else is then tested.
  const bool strange_lens = bytes.up_to(3) == 0;
  const auto number = [&](double low, double high) {
    return strange_lens ? bytes.number(low, high) : low + (high - low) * (bytes.take<uint16_t>() / 65535.0);
  };
  lens.half_x = number(0.01, 3), lens.half_y = number(0.01, 3);
  lens.near = number(0.01, 1), lens.far = bytes.up_to(1) ? no_end : number(2, 1000);
  lens.shift_x = number(-1, 1), lens.shift_y = number(-1, 1);
  lens.orthographic = bytes.up_to(3) == 0, lens.order = kind.order;
  if (lens.orthographic && std::isinf(lens.far)) lens.far = 1000;
  in.view = view_through(lens, 1 + bytes.up_to(40), 1 + bytes.up_to(24));
  if (bytes.up_to(3) == 0)
    in.view = placed(in.view, {bytes.number(-1e7, 1e7), 0, 1}, bytes.number(-3, 3), bytes.number(-1, 1));
  float edge = 0;
  for (int slices = kind.sliced ? 1 + bytes.up_to(3) : 0; slices > 0; --slices)
    in.view.slice_edges.push_back(edge += float(1 + bytes.up_to(9)));
  edge = 0;
  for (int bins = bytes.up_to(7); bins > 0; --bins)
    in.view.z_bin_edges.push_back(edge += 0.1f * float(1 + bytes.up_to(99)));
  for (size_t i = tile_count(in.view, o.tile); i > 0; --i)
    in.bounds.push_back({float(bytes.number(0, 20)), float(bytes.number(5, 100))});
  in.depth.samples = kind.samples;
  for (int i = in.view.width * in.view.height * in.depth.samples; i > 0; --i)
    in.depth.values.push_back(bytes.up_to(7) ? float(bytes.take<uint8_t>()) / 255
                                             : float(bytes.number(0, 1)));
  while (!bytes.empty() && in.lights.size() < 100) {
    CullLight light;
    for (int axis = 0; axis < 3; ++axis) light.position[axis] = bytes.number(-20, 20);
    light.radius_m = bytes.number(0, 20);
    if (bytes.up_to(1)) {
      for (int axis = 0; axis < 3; ++axis) light.direction[axis] = bytes.number(-1, 1);
      if (bytes.up_to(7)) light.direction = glm::normalize(light.direction);
      light.cos_outer = bytes.number(-1, 1);
    }
    in.lights.push_back(light);
  }
  return in;
}

// Empty, or the position where a mask differs from its list.
inline std::string masks_differ(const HostGrid& grid) {
  if (grid.masks.empty()) return "";
  const size_t words = grid.masks.size() / grid.cells.size();
  for (size_t cell = 0; cell < grid.cells.size(); ++cell) {
    std::vector<uint32_t> named;
    for (uint32_t i = 0; i < 32 * words; ++i) {
      if (grid.masks[cell * words + i / 32] >> i % 32 & 1) named.push_back(i);
    }
    if (!std::ranges::equal(named, list_of(grid, cell)))
      return fmt::format("the mask of cell {} is not its list", cell);
  }
  return "";
}

// Every grid that the input's settings give, in one kernel shape: over given bounds, from depth, of blended
// surfaces.
inline std::vector<HostGrid> fuzz_grids(CullEngine& engine, const FuzzInput& in, KernelShape shape) {
  CullerOptions options = in.options;
  options.shape = shape;
  std::vector<HostGrid> grids = {engine.cull(options, in.view, in.lights, in.bounds),
                                 engine.cull_depth(options, in.view, in.lights, in.depth)};
  if (options.blend) grids.push_back(engine.cull_depth(options, in.view, in.lights, in.depth, true));
  return grids;
}

// Empty, or the fault. `refused`: the input was refused with one line, which is allowed.
inline std::string fuzz_once(CullEngine& engine, const FuzzInput& in, bool* refused = nullptr) {
  try {
    const std::vector<HostGrid> lanes = fuzz_grids(engine, in, KernelShape::lanes);
    const std::vector<HostGrid> group = fuzz_grids(engine, in, KernelShape::group);
    constexpr const char* names[] = {"over given bounds", "from depth on", "of blended surfaces"};
    for (size_t i = 0; i < lanes.size(); ++i) {
      for (const HostGrid* grid : {&lanes[i], &group[i]}) {
        for (const std::string& wrong : {malformed(*grid, in.lights.size()), masks_differ(*grid)})
          if (!wrong.empty()) return fmt::format("{}: {}", names[i], wrong);
        if (grid->z_bins.size() != (in.view.z_bin_edges.empty() ? 0 : in.lights.size()))
          return "a word of z-bins for each light";
      }
      if (lanes[i] != group[i]) return fmt::format("lanes and group differ {}", names[i]);
    }
  } catch (const Error&) {
    if (refused) *refused = true;
  }
  return "";
}

inline std::string fuzz_once(CullEngine& engine, const uint8_t* data, size_t size, bool* refused = nullptr) {
  return fuzz_once(engine, fuzz_input(Bytes(data, size)), refused);
}

}  // namespace lightgrid::verify
