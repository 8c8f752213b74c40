// Views of the hunt with strange numbers in them, from bytes; none may cause a crash, a hang or an
// out-of-bounds read. Used by libFuzzer and by the deterministic test of ctest.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "shared/cull_tests.h"
#include "verify/check.h"
#include "verify/hunt_space.h"

namespace lightgrid::lab::verify {

class Bytes {
 public:
  Bytes(const uint8_t* data, size_t size) : data_(data), left_(size) {}
  bool empty() const { return left_ == 0; }

  template <typename T>
  T take() {
    T value{};
    const size_t size = std::min(sizeof(T), left_);
    std::memcpy(&value, data_, size);
    data_ += size;
    left_ -= size;
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

// Few settings, because each builds its own kernels; so do slices, blended surfaces and standard depth.
struct FuzzSetting {
  CullTest test;
  DepthBoundsMode mode;
  int tile, samples, index_bits;
  GridLists lists;
  bool portable;
  int slices;
  std::vector<HuntClass> classes;
};
inline const std::vector<FuzzSetting>& fuzz_settings() {
  using enum HuntClass;
  static const std::vector<FuzzSetting> all = {
      {CullTest::planes_aabb,
       DepthBoundsMode::minmax,
       16,
       1,
       0,
       GridLists::lists,
       false,
       1,
       {ordinary, narrowest, wide, off_centre, turned_far, scaled, spread, parked}},
      {CullTest::exact, DepthBoundsMode::mask32, 8, 1, 32, GridLists::masks, false, 4, {d16, blended}},
      {CullTest::sphere,
       DepthBoundsMode::halfz_modified,
       16,
       4,
       16,
       GridLists::lists,
       true,
       4,
       {d24, standard}},
      {CullTest::aabb,
       DepthBoundsMode::halfz,
       32,
       1,
       16,
       GridLists::masks,
       true,
       1,
       {orthographic, oblique}}};
  return all;
}

// Puts any bits in place of one number. of_view: the view's too, most of which is refused.
inline void make_strange(FuzzInput& in, Bytes& bytes, bool of_view) {
  const int kind = of_view ? bytes.up_to(15) : 3 + bytes.up_to(12);
  const auto any_of = [&](auto& items) { return bytes.take<uint16_t>() % items.size(); };
  if (kind == 0) {
    in.view.clip_from_view[bytes.up_to(3)][bytes.up_to(3)] = bytes.number(-1, 1);
  } else if (kind == 1) {
    in.view.eye[bytes.up_to(2)] = bytes.number(-1e7, 1e7);
  } else if (kind == 2 && !in.view.slice_edges.empty()) {
    in.view.slice_edges[any_of(in.view.slice_edges)] = float(bytes.number(0, 100));
  } else if (kind < 6) {
    DepthInterval& interval = in.bounds[any_of(in.bounds)];
    (bytes.up_to(1) ? interval.near : interval.far) = float(bytes.number(0, 100));
  } else if (kind < 10) {
    in.depth.values[bytes.take<uint32_t>() % in.depth.values.size()] = float(bytes.number(0, 1));
  } else {
    CullLight& light = in.lights[any_of(in.lights)];
    double* const numbers[] = {&light.position.x,  &light.position.y,  &light.position.z,  &light.radius_m,
                               &light.direction.x, &light.direction.y, &light.direction.z, &light.cos_outer};
    *numbers[bytes.up_to(7)] = bytes.number(-20, 20);
  }
}

// A view of the hunt whose class, setting and seed the first bytes choose, with a strange number for each of
// the records that follow.
inline FuzzInput fuzz_input(Bytes bytes) {
  const FuzzSetting& fuzzed = fuzz_settings()[bytes.up_to(3)];
  const HuntClass hunted = fuzzed.classes[bytes.take<uint8_t>() % fuzzed.classes.size()];
  HuntSetting setting{
      .slices = fuzzed.slices, .z_bins = bytes.up_to(1) ? 16 : 1, .spots = bytes.up_to(1) == 1};
  CullerOptions& o = setting.options;
  o.cull_test = fuzzed.test;
  o.depth_bounds = fuzzed.mode;
  o.tile = fuzzed.tile;
  o.samples = fuzzed.samples;
  o.index_bits = fuzzed.index_bits;
  o.lists = fuzzed.lists;
  o.portable = fuzzed.portable;
  const size_t lights = 1 + bytes.up_to(99);
  const uint64_t seed = bytes.take<uint64_t>();
  HuntView hunt = random_view(hunted, setting, seed);
  o.depth_format = hunt.format;
  o.blend = hunt.blended;
  FuzzInput in{o,
               hunt.view,
               cull_lights(random_contacts(hunt, setting, lights, Random::mix(seed)).lights),
               {},
               std::move(hunt.depth)};
  Random random(seed);
  for (size_t i = tile_count(in.view, o.tile); i > 0; --i)
    in.bounds.push_back(
        {float(between(random, hunt.near, hunt.far)), float(between(random, hunt.near, hunt.far))});
  const bool of_view = bytes.up_to(3) == 0;
  while (!bytes.empty()) make_strange(in, bytes, of_view);
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
inline std::string fuzz_once(CullEngine& engine, const uint8_t* data, size_t size, bool* refused = nullptr) {
  const FuzzInput in = fuzz_input(Bytes(data, size));
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

}  // namespace lightgrid::lab::verify
