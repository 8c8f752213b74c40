// Culls a small frame under every setting in both kernel shapes, compares each grid with the oracle and
// prints a digest of all their bytes. oclgrind_test.cpp runs it under Oclgrind and with several numbers of
// threads.
#include <cstdio>

#include "shared/cull_tests.h"
#include "verify/check.h"
#include "verify/inputs.h"

using namespace lightgrid;
using namespace lightgrid::lab;
using namespace lightgrid::lab::verify;

namespace {

uint64_t digest = 0xcbf29ce484222325;  // FNV-1a

void add(uint32_t value) { digest = (digest ^ value) * 0x100000001b3; }

void add(const HostGrid& grid) {
  for (const glm::uvec2 cell : grid.cells) {
    add(cell.x);
    add(cell.y);
  }
  for (const uint32_t index : grid.indices) add(index);
}

}  // namespace

void digest_settings(Check& check, const CullView& view, size_t lights) {
  Random random(61);
  const verify::DepthImage depth = scattered_depth(view, random);
  const auto bounds = scattered_bounds(view, 16, random);
  const auto scattered = scattered_lights(view, lights, true, random);
  for (const CullerOptions& options : every_test()) add(check.grid(view, scattered, bounds, {options}));
  for (CullerOptions options : every_tile()) {
    for (int mode = 0; mode < 5; ++mode) {
      // Each combination is a kernel of its own: all modes for the first size of tile, the usual one for the
      // others.
      if (options.tile != 16 && DepthBoundsMode(mode) != CullerOptions().depth_bounds) continue;
      options.depth_bounds = DepthBoundsMode(mode);
      options.blend = mode == 1;
      add(check.pixels(view, scattered, depth, {options}));
    }
  }
}

// A part that takes Oclgrind only seconds: grids of one kernel shape alone.
void digest_of_shape(CullEngine& engine, KernelShape shape) {
  const CullView view = field_of_view(60, 37, 21);
  Random random(61);
  const verify::DepthImage depth = scattered_depth(view, random);
  const auto bounds = scattered_bounds(view, 16, random);
  const auto lights = scattered_lights(view, 24, true, random);
  for (const CullTest test : {CullTest::planes_aabb, CullTest::exact}) {
    CullerOptions options;
    options.cull_test = test;
    options.shape = shape;
    add(engine.cull(options, view, lights, bounds));
    if (test == CullTest::exact) options.depth_bounds = DepthBoundsMode::mask32;
    add(engine.cull_depth(options, view, lights, depth));
  }
}

// With "lanes" or "group": only that shape, small.
int main(int argc, char** argv) {
  const auto engine = device_engine("");
  Check check(*engine, 0);
  if (argc > 1) {
    digest_of_shape(*engine, std::string(argv[1]) == "lanes" ? KernelShape::lanes : KernelShape::group);
    std::printf("%016lx\n", (unsigned long)digest);
    return 0;
  } else {
    digest_settings(check, field_of_view(60, 64, 48), 70);
    digest_settings(
        check, view_through({.half_x = 4, .half_y = 3, .near = 0, .far = 100, .orthographic = true}, 33, 17),
        70);
  }
  const Outcome outcome = check.outcome();
  std::printf("%s %016lx %s\n", outcome.verdict == Verdict::pass ? "pass" : "fail", (unsigned long)digest,
              outcome.why.c_str());
  return outcome.verdict == Verdict::pass ? 0 : 1;
}
