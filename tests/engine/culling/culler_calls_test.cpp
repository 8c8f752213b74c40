// The contract of LightCuller's calls: their order, their waits, and their errors.
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "base/error.h"
#include "culling/constants.h"
#include "culling/culled_grid.h"
#include "culling/projections.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

// Message of the Error that `call` throws; fails if it throws none, or another kind.
template <typename Call>
std::string refusal(ErrorKind kind, const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(int(error.kind()), int(kind)) << error.what();
    return error.what();
  } catch (const cl::Error& error) {
    ADD_FAILURE() << "cl::Error left the library: " << error.what();
    return "";
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

// 64 x 48 pixels, 4 x 3 tiles; the near plane determines the meaning of depth.
CullView view_with_near(double near_m) {
  return view_through(projection("", false, false, near_m, INFINITY), 64, 48);
}

const std::vector<float> same_depth(64 * 48, 0.01f);

// Nothing enqueued after it starts before it opens.
class Gate {
 public:
  explicit Gate(ClDevice& device) : opened_(device.context()) {
    const std::vector<cl::Event> events = {opened_};
    device.queue().enqueueBarrierWithWaitList(&events);
  }
  void open() { opened_.setStatus(CL_COMPLETE); }

 private:
  cl::UserEvent opened_;
};

std::vector<float> values_of(ClDevice& device, const cl::Buffer& buffer) {
  std::vector<float> values(buffer.getInfo<CL_MEM_SIZE>() / sizeof(float));
  device.queue().enqueueReadBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(float), values.data());
  return values;
}

struct Pending : testing::TestWithParam<KernelShape> {
  ClDevice device;
  ProgramCache programs{device};
  cl::Buffer depth{device.context(), CL_MEM_COPY_HOST_PTR, same_depth.size() * sizeof(float),
                   const_cast<float*>(same_depth.data())};

  // Bounds from a culler with nothing pending.
  std::vector<float> expected(const CullView& view) {
    LightCuller culler(device, programs, {.shape = GetParam()});
    culler.set_view(view);
    return values_of(device, culler.depth_bounds({depth}).opaque.values);
  }
};

TEST_P(Pending, CallsReadTheViewThatTheyWereMadeWith) {
  const CullView a = view_with_near(0.1), b = view_with_near(0.2);
  const std::vector<float> of_a = expected(a), of_b = expected(b);
  ASSERT_NE(of_a, of_b);
  LightCuller culler(device, programs, {.shape = GetParam()});
  culler.set_view(a);
  culler.depth_bounds({depth});
  const cl::Buffer kept(device.context(), CL_MEM_READ_WRITE, of_a.size() * sizeof(float));
  culler.set_view(b);
  culler.depth_bounds({depth});
  device.queue().finish();
  Gate gate(device);
  culler.set_view(a);
  const DepthBounds bounds = culler.depth_bounds({depth});
  device.queue().enqueueCopyBuffer(bounds.opaque.values, kept, 0, 0, of_a.size() * sizeof(float));
  culler.set_view(b);
  culler.depth_bounds({depth});
  gate.open();
  EXPECT_EQ(values_of(device, kept), of_a);
  EXPECT_EQ(values_of(device, bounds.opaque.values), of_b);
}

TEST_P(Pending, CallsOutliveTheCullerOrItsMove) {
  const CullView a = view_with_near(0.1), b = view_with_near(0.2);
  const std::vector<float> of_a = expected(a);
  for (const bool moved : {false, true}) {
    auto culler = std::make_unique<LightCuller>(device, programs, CullerOptions{.shape = GetParam()});
    culler->set_view(b);
    culler->depth_bounds({depth});
    device.queue().finish();
    Gate gate(device);
    culler->set_view(a);
    const cl::Buffer values = culler->depth_bounds({depth}).opaque.values;
    std::unique_ptr<LightCuller> other = moved ? std::make_unique<LightCuller>(std::move(*culler)) : nullptr;
    culler.reset();
    // its memory, again
    const std::vector<std::vector<char>> taken(64, std::vector<char>(sizeof(LightCuller), 0x7f));
    gate.open();
    EXPECT_EQ(values_of(device, values), of_a) << moved;
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Pending, testing::ValuesIn(kernel_shapes), [](const auto& info) {
  return info.param == KernelShape::lanes ? "lanes" : "group";
});

TEST(CullerCalls, BeforeSetViewAreRefusedByName) {
  LightCuller culler(test_device(), test_programs(), {});
  ClGridStorage storage(test_device());
  const TileBounds bounds{buffer_of(same_depth), DepthBoundsMode::minmax};
  const auto message_of = [](const auto& call) { return refusal(ErrorKind::input, call); };
  EXPECT_EQ(message_of([&] { culler.depth_bounds({buffer_of(same_depth)}); }),
            "light culler: set_view has to come before depth_bounds");
  EXPECT_THAT(message_of([&] { culler.bounds_of({}); }), HasSubstr("before bounds_of"));
  EXPECT_THAT(message_of([&] { culler.read_bounds(bounds); }), HasSubstr("before read_bounds"));
  EXPECT_THAT(message_of([&] { culler.read_inputs(bounds); }), HasSubstr("before read_inputs"));
  EXPECT_THAT(message_of([&] { culler.cull(bounds, storage); }), HasSubstr("before cull"));
}

TEST(CullerCalls, RefuseDepthBuffersThatDoNotCoverTheView) {
  LightCuller culler(test_device(), test_programs(), {.samples = 2});
  culler.set_view(view_with_near(0.1));
  const auto message_of = [&](const DepthInput& depth) {
    return refusal(ErrorKind::input, [&] { culler.depth_bounds(depth); });
  };
  EXPECT_THAT(message_of({}), HasSubstr("buffer of depth values is missing"));
  EXPECT_THAT(message_of({buffer_of(std::vector<float>(16))}), HasSubstr("64 bytes"));
  EXPECT_THAT(message_of({buffer_of(same_depth)}), HasSubstr("of 12288 bytes, fewer than the 24576"));
  const std::vector<float> two_samples(2 * same_depth.size(), 0.5f);
  EXPECT_THAT(message_of({buffer_of(two_samples), 64, 1, 0}), HasSubstr("row_pixels is 64"));
  EXPECT_THAT(message_of({buffer_of(two_samples), 64, 0, 1}), HasSubstr("fewer than the 25088"));
  EXPECT_THAT(message_of({buffer_of(two_samples), -64}), HasSubstr("row_pixels is -64"));
  EXPECT_THAT(message_of({buffer_of(two_samples), 0, -1, 0}), HasSubstr("x is -1"));
  EXPECT_THAT(message_of({buffer_of(two_samples), 0, 0, -1}), HasSubstr("y is -1"));
  // No wrap
  EXPECT_THAT(message_of({buffer_of(two_samples), 1 << 30, 0, 1 << 20}), HasSubstr("9007602981667328"));
  culler.depth_bounds({buffer_of(two_samples)});  // just enough
}

TEST(CullerCalls, RefuseBoundsOfAnotherViewAndMoreIntervalsThanTiles) {
  LightCuller culler(test_device(), test_programs(), {});
  culler.set_lights(std::vector<CullLight>(1));
  culler.set_view(view_with_near(0.1));
  ClGridStorage storage(test_device());
  const TileBounds small = culler.bounds_of(std::vector<DepthInterval>(12, {1, 2}));
  EXPECT_THAT(refusal(ErrorKind::input,
                      [&] {
                        culler.bounds_of(std::vector<DepthInterval>(13, {1, 2}));
                      }),
              HasSubstr("13 intervals for 12 tiles"));
  culler.set_view(view_through(projections()[0], 640, 480));
  for (const TileBounds& bounds : {small, TileBounds{}}) {
    EXPECT_THAT(refusal(ErrorKind::input, [&] { culler.cull(bounds, storage); }), HasSubstr("bounds"));
    EXPECT_THAT(refusal(ErrorKind::input, [&] { culler.read_bounds(bounds); }), HasSubstr("bounds"));
    EXPECT_THAT(refusal(ErrorKind::input, [&] { culler.read_inputs(bounds); }), HasSubstr("bounds"));
  }
}

// The view has the same size, so that lights would be lost without a word.
TEST(CullerCalls, RefuseBoundsOfAnotherViewOfTheSameSize) {
  const CullView made = view_with_near(0.1);
  CullView moved = made, turned = made, wider = made;
  moved.eye.x = 1;
  turned.view_from_world = glm::dmat4(0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1);
  wider.clip_from_view[0][0] *= 0.5;
  for (const DepthBoundsMode mode : {DepthBoundsMode::none, DepthBoundsMode::minmax}) {
    LightCuller culler(test_device(), test_programs(), {.depth_bounds = mode, .blend = true});
    culler.set_lights(std::vector<CullLight>(1));
    ClGridStorage storage(test_device());
    for (const CullView& view : {moved, turned, wider, view_with_near(0.2)}) {
      culler.set_view(made);
      const DepthBounds of_depth = culler.depth_bounds({buffer_of(same_depth)});
      const TileBounds given = culler.bounds_of(std::vector<DepthInterval>(12, {1, 2}));
      culler.set_view(view);
      for (const TileBounds& bounds : {of_depth.opaque, of_depth.blend, given}) {
        const auto expect_refused = [&](const auto& call) {
          EXPECT_THAT(refusal(ErrorKind::input, call), HasSubstr("bounds of another view"));
        };
        expect_refused([&] { culler.cull(bounds, storage); });
        expect_refused([&] { culler.read_bounds(bounds); });
        expect_refused([&] { culler.read_inputs(bounds); });
      }
    }
  }
}

TEST(CullerCalls, TakeBoundsOfTheirViewAsOftenAsIsWanted) {
  LightCuller culler(test_device(), test_programs(), {});
  ClGridStorage storage(test_device());
  const CullView view = view_with_near(0.1);
  culler.set_view(view);
  const TileBounds of_depth = culler.depth_bounds({buffer_of(same_depth)}).opaque,
                   given = culler.bounds_of(std::vector<DepthInterval>(12, {1, 2}));
  const auto entries = [&](const TileBounds& bounds) { return culler.cull(bounds, storage).index_count; };
  // Other lights; slices and z-bins; the view again after another one.
  culler.set_lights(std::vector<CullLight>(2, {{0, 0, -1.5}, 0.3}));
  const uint64_t listed = entries(given);
  EXPECT_GT(listed, 0u);
  CullView sliced = view;
  sliced.slice_edges = {1.4f};
  sliced.z_bin_edges = {1.2f, 1.6f};
  sliced.view_from_world[3] = {1, 2, 3, 1};  // not used
  culler.set_view(sliced);
  EXPECT_GT(entries(given), listed);
  EXPECT_NO_THROW(culler.cull(of_depth, storage));
  culler.set_view(view_with_near(0.2));
  culler.set_view(view);
  EXPECT_EQ(entries(given), listed);
  EXPECT_NO_THROW(culler.cull(of_depth, storage));
  // But not those that another view's have overwritten.
  culler.set_view(view_with_near(0.2));
  culler.depth_bounds({buffer_of(same_depth)});
  EXPECT_NO_THROW(culler.cull(of_depth, storage));
  culler.set_view(view);
  EXPECT_THAT(refusal(ErrorKind::input, [&] { culler.cull(of_depth, storage); }),
              HasSubstr("bounds of another view"));
  EXPECT_EQ(entries(given), listed);
}

TEST(CullerCalls, RefuseAnEyeThatIsNowhere) {
  LightCuller culler(test_device(), test_programs(), {});
  CullView view = view_with_near(0.1);
  view.eye.y = NAN;
  EXPECT_THAT(refusal(ErrorKind::input, [&] { culler.set_view(view); }), HasSubstr("eye[1] is nan"));
  view.eye = {0, 0, INFINITY};
  EXPECT_THAT(refusal(ErrorKind::input, [&] { culler.set_view(view); }), HasSubstr("eye[2] is inf"));
}

TEST(CullerCalls, RefuseMoreLightsThanKernelsCanCount) {
  LightCuller culler(test_device(), test_programs(), {});
  const CullLight one;
  EXPECT_THAT(refusal(ErrorKind::machine,
                      [&] {
                        culler.set_lights({&one, size_t(1) << 32});
                      }),
              HasSubstr("4294967296 lights"));
}

// A transfer that OpenCL refuses: the grid claims more bytes than its storage has.
TEST(CullerCalls, ThrowOpenClsErrorsAsOurs) {
  ClGridStorage storage(test_device());
  struct Small : ClGridStorage {
    using ClGridStorage::ClGridStorage;
    cl::Buffer& cells(size_t) override { return ClGridStorage::cells(64); }
  } small(test_device());
  LightGrid grid;
  grid.cells_x = 1000;
  grid.cell_bytes = 8000;
  EXPECT_THAT(refusal(ErrorKind::machine, [&] { read_grid(test_device(), grid, small); }),
              HasSubstr("clEnqueueReadBuffer failed with CL_INVALID_VALUE"));
  LightCuller culler(test_device(), test_programs(), {});
  culler.set_view(view_through(projections()[0], 640, 480));
  EXPECT_THAT(refusal(ErrorKind::machine, [&] { culler.cull(culler.bounds_of({}), small); }),
              HasSubstr("clEnqueueFillBuffer failed with CL_INVALID_VALUE"));
}

TEST(CullerCalls, CountInvalidDepthTilesOfTheLastDepthBounds) {
  std::vector<float> invalid = same_depth;
  invalid[0] = NAN;
  invalid[40] = 2;
  for (const KernelShape shape : kernel_shapes) {
    LightCuller culler(test_device(), test_programs(), {.shape = shape});
    culler.set_view(view_with_near(0.1));
    const cl::Buffer good = buffer_of(same_depth), bad = buffer_of(invalid);
    EXPECT_EQ(culler.invalid_depth_tiles(), 0u);
    for (int i = 0; i < 3; ++i) culler.depth_bounds({bad});
    EXPECT_EQ(culler.invalid_depth_tiles(), 2u);
    EXPECT_EQ(culler.invalid_depth_tiles(), 2u) << "asked again";
    culler.depth_bounds({good});
    EXPECT_EQ(culler.invalid_depth_tiles(), 0u);
    culler.depth_bounds({good});
    culler.depth_bounds({bad});
    EXPECT_EQ(culler.invalid_depth_tiles(), 2u);
  }
}

// The work before the masks ends only after a while.
struct SlowMasks : ClGridStorage {
  using ClGridStorage::ClGridStorage;
  cl::Buffer& masks(size_t bytes) override {
    if (!gate) gate.emplace(test_device());
    return ClGridStorage::masks(bytes);
  }
  std::optional<Gate> gate;
};

TEST(CullerCalls, CullWaitsForMasksToo) {
  LightCuller culler(test_device(), test_programs(), {.lists = GridLists::masks});
  culler.set_lights(std::vector<CullLight>(1));
  culler.set_view(view_with_near(0.1));
  const TileBounds bounds = culler.bounds_of(std::vector<DepthInterval>(12, {1, 2}));
  SlowMasks storage(test_device());
  std::atomic<bool> opened = false;
  std::thread opener([&] {
    while (!storage.gate) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    opened = true;
    storage.gate->open();
  });
  culler.cull(bounds, storage);
  EXPECT_TRUE(opened);
  opener.join();
}

}  // namespace
}  // namespace lightgrid
