// The same bytes on every device, in every kernel shape, for any number of threads and far from the origin.
#include "raster/many_triangles.h"

namespace lightgrid {
namespace {

// A device of one thread, which takes clusters in other chunks.
TEST(Rasterizer, TheSameBytesWithOneThread) {
  std::vector<cl::Device> parts;
  const cl_device_partition_property one[] = {CL_DEVICE_PARTITION_BY_COUNTS, 1,
                                              CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
  try {
    raster_device().device().createSubDevices(one, &parts);
  } catch (const cl::Error&) {
    GTEST_SKIP() << "the device has no parts";
  }
  const cl::Context context(parts[0]);
  ClDevice single(parts[0], context, cl::CommandQueue(context, parts[0]));
  ASSERT_EQ(single.info().compute_units, 1);
  ProgramCache programs(single);
  const TriangleScene scene = many_triangles(5000, 500, 300, 8);
  const Drawn expected = drawn(scene);
  Rasterizer rasterizer(single, programs);
  set_scene(rasterizer, scene);
  EXPECT_TRUE(drawn_by(rasterizer, scene, single).same_image(expected));
}

TEST(RasterizerOnDevices, HasTheSameBytes) {
  const std::vector<ClDeviceInfo> devices = list_cl_devices();
  if (devices.size() < 2) GTEST_SKIP() << "there is one device";
  const TriangleScene scene = many_triangles(5000, 501, 299, 8);
  const Drawn expected = drawn(scene);
  for (size_t i = 0; i < devices.size(); ++i) {
    if (!why_not_the_same_bytes(devices[i]).empty()) continue;
    ClDevice device("#" + std::to_string(i));
    ProgramCache programs(device);
    Rasterizer rasterizer(device, programs);
    set_scene(rasterizer, scene);
    EXPECT_TRUE(drawn_by(rasterizer, scene, device).same_image(expected)) << devices[i].name;
  }
}

TEST(Rasterizer, TheSameBytesInEveryShape) {
  for (const TriangleScene& scene :
       {many_triangles(5000, 501, 299, 8), many_triangles(300, 130, 70, 9), many_triangles(400, 1, 1, 10)}) {
    const Drawn lanes = drawn(scene, {.shape = KernelShape::lanes});
    EXPECT_GT(lanes.covered(), lanes.triangles.size() / 5);
    for (const RasterOptions& options : {RasterOptions{.shape = KernelShape::lanes, .portable = true},
                                         RasterOptions{.shape = KernelShape::group},
                                         RasterOptions{.shape = KernelShape::group, .wide_atomics = false}}) {
      const Drawn other = drawn(scene, options);
      EXPECT_TRUE(other.same_image(lanes)) << int(options.shape) << options.portable << options.wide_atomics;
      EXPECT_EQ(other.counts.records, lanes.counts.records);
      EXPECT_EQ(other.counts.clusters, lanes.counts.clusters);
    }
  }
}

// A scene and an eye that move together by an exact amount give the same bits.
TEST(Rasterizer, TheSameBytesFarFromTheOrigin) {
  TriangleScene scene = many_triangles(500, 200, 150, 3);
  const Drawn here = drawn(scene);
  const glm::dvec3 far(double(1 << 22), -double(1 << 21), double(1 << 23));
  scene.camera.eye = far;
  for (RasterInstance& i : scene.instances) i.world_from_object[3] = glm::dvec4(far, 1);
  EXPECT_TRUE(drawn(scene).same_image(here));
}

}  // namespace
}  // namespace lightgrid
