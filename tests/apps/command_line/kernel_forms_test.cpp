// Each form of the CPU kernels (AVX-512, AVX2, plain OpenCL C) on whatever CPU this is: PoCL compiles for the
// instruction set that POCL_KERNELLIB_NAME names, or for the CPU's best where the CPU lacks it.
#include <gmock/gmock.h>

#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;

// Kernels without optimisation have the same bytes and the same warnings.
ProgramRun run_form(const std::string& form, const std::filesystem::path& cache,
                    const std::vector<std::string>& arguments) {
  return run_program(arguments,
                     {"POCL_KERNELLIB_NAME=" + form, "XDG_CACHE_HOME=" + cache.string(),
                      "LIGHTGRID_CL_CACHE=driver", "LIGHTGRID_CL_QUICK_BUILD=all", "LIGHTGRID_TUNED=off"});
}

bool chooses_form(const std::string& form, const char* cpu) {
  const TempFolder cache;
  return run_form(form, cache.path, {"devices"}).out.find(cpu) != std::string::npos;
}

// The names that PoCL gives its targets.
constexpr std::pair<const char*, const char*> forms[] = {
    {"avx512", "pthread-skylake-avx512"}, {"avx2", "pthread-haswell"}, {"sse2", "pthread-athlon64"}};

struct KernelForm : testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(KernelForm, PrintsNothingAtItsFirstStart) {
  const auto [form, cpu] = GetParam();
  if (!chooses_form(form, cpu)) GTEST_SKIP() << "no PoCL here that compiles for " << cpu;
  const TempFolder cache, output;
  const ProgramRun run = run_form(
      form, cache.path,
      {"compare", "spheres", "--size", "64x36", "--frames", "1", "--quiet", "-o", output.path / "out", "-t",
       "forward_plus,clustered,forward_plus_compute,light_prepass,visibility,voxel_lights,world_grid"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.err, "");
}

std::string image_of_form(const std::string& form, const std::filesystem::path& caches,
                          const std::string& scene, const std::string& technique) {
  const TempFolder output;
  const std::string image = output.path / "image.exr";
  const ProgramRun run =
      run_form(form, caches / form, {"render", scene, "--size", "96x54", "-t", technique, "-o", image});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.err, "");
  return file_bytes(image);
}

using Drawn = std::pair<const char*, const char*>;  // scene, technique

void expect_same_bytes(std::initializer_list<Drawn> pictures) {
  if (!chooses_form("avx2", "pthread-haswell") || !chooses_form("sse2", "pthread-athlon64"))
    GTEST_SKIP() << "no PoCL here that compiles for AVX2 and SSE2";
  const TempFolder caches;  // pictures share kernels
  for (const auto& [scene, technique] : pictures) {
    const std::string image = image_of_form("avx512", caches.path, scene, technique);
    EXPECT_THAT(image, HasSubstr("channels"));
    for (const char* form : {"avx2", "sse2"})
      EXPECT_TRUE(image_of_form(form, caches.path, scene, technique) == image)
          << scene << ' ' << technique << ' ' << form;
  }
}

TEST(KernelForms, DrawTheSameBytes) {
  expect_same_bytes({{"hall", "visibility"},
                     {"rooms", "visibility:samples=4,list-cap=8,list-cap-order=tree"},
                     {"spheres", "forward_plus_compute"}});
}

// Lists that are cut by other orders, and tiles of surfaces that OpenCL draws.
TEST(MoreKernelForms, DrawTheSameBytes) {
  expect_same_bytes({{"rooms", "visibility:list-cap=8"},
                     {"rooms", "visibility:list-cap=8,list-cap-order=sampled"},
                     {"spheres", "deferred_tiled:raster=opencl,samples=4"}});
}

INSTANTIATE_TEST_SUITE_P(Pocl, KernelForm, testing::ValuesIn(forms),
                         [](const auto& info) { return std::string(info.param.first); });

}  // namespace
}  // namespace lightgrid::app
