// Techniques along a camera path: same pictures as at rest, no work twice, and flicker is detected.
#include "compare/moving.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>

#include <gmock/gmock.h>

#include "accuracy/oracle.h"
#include "measures/metrics.h"
#include "measures/path_changes.h"
#include "plan/settings/surfaces.h"
#include "scene/camera_path.h"
#include "scene/rig.h"
#include "scenes/builtin.h"
#include "support/render.h"
#include "support/small_scene.h"
#include "support/technique_tiers.h"

namespace lightgrid::lab {
namespace {

// A picture of a view that look() reached from another view equals that of a view created for it.
struct MovedView : testing::TestWithParam<const Technique*> {};

TEST_P(MovedView, DrawsWhatAViewOfItsOwnDraws) {
  Scene scene = find_builtin_scene("hall")->make();
  if (GetParam()->limited_lists) scene.lights.resize(12);
  const View start = make_view(choose_camera(scene, ""), 96, 54);
  TechniqueRun run(software_devices(), scene, start, {}, *GetParam());
  for (const View& view : camera_path(scene, start, "turn:5")) {
    run.look(view);
    run.run_frame();
    TechniqueRun own(software_devices(), scene, view, {}, *GetParam());
    own.run_frame();
    EXPECT_TRUE(compare_images(run.image(), own.image()).bit_identical);
  }
  const View larger = make_view(choose_camera(scene, ""), 101, 77);
  run.look(larger);
  run.run_frame();
  TechniqueRun own(software_devices(), scene, larger, {}, *GetParam());
  own.run_frame();
  ASSERT_EQ(run.image().width, 101);
  EXPECT_TRUE(compare_images(run.image(), own.image()).bit_identical);
}

LIGHTGRID_TECHNIQUES_OF_BOTH_TIERS(MovedView);

TEST(Moving, BuildsAndUploadsNothingOnceItMoves) {
  const Scene scene = small_scene().scene;
  std::vector<Contestant> contestants;
  for (const Technique* technique : techniques()) contestants.push_back({technique, {}});
  CompareOptions options{.frames = 1, .warmup = 0, .shaded_samples = 10};
  options.path = camera_path(scene, small_view(48, 32), "dolly:8");
  const CompareReport report =
      compare_techniques(software_devices(), scene, small_view(48, 32), contestants, options);
  for (const RunResult& row : report.rows) {
    ASSERT_TRUE(row.moving) << row.technique;
    EXPECT_EQ(row.moving->frames, 8u);
    EXPECT_EQ(row.moving->frame_ms.runs, 6);
    EXPECT_EQ(row.moving->over_resting.runs, row.moving->resting_ms.runs);
    EXPECT_GT(row.moving->over_resting.min, 0);
    EXPECT_EQ(row.moving->gl_programs, 0) << row.technique;
    EXPECT_EQ(row.moving->cl_programs, 0) << row.technique;
    EXPECT_EQ(row.moving->scene_bytes, 0u) << row.technique;
    EXPECT_EQ(row.moving->pairs.lost, 0u) << row.technique;
    if (own_surfaces(find_technique(row.technique), {})) continue;  // another image than forward's
    if (find_technique(row.technique).approximate) continue;
    // Sums in another order round to within 1e-5 (techniques/lidr_scenes.h); two frames may differ in
    // opposite directions.
    EXPECT_LT(row.moving->max_rel, 1e-5) << row.technique;
    EXPECT_LT(row.moving->temporal_max_rel, 2e-5) << row.technique;
  }
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)  // whose heap is another
size_t heap_bytes() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

// Three turns: the heap, which the software devices use too, holds the same at the same view of each.
TEST(Moving, HoldsNoMoreMemoryTheLongerThePath) {
  const Scene scene = small_scene().scene;
  const View start = small_view(48, 32);
  std::vector<View> path;
  for (int turn = 0; turn < 3; ++turn)
    for (const View& view : camera_path(scene, start, "turn:30")) path.push_back(view);
  GpuScene gpu(software_devices(), scene);
  for (const char* name : {"forward", "forward_plus", "deferred_tiled", "visibility"}) {
    TechniqueRun run(software_devices(), gpu, start, {}, find_technique(name));
    std::vector<RunResult> rows(1);
    std::vector<size_t> heap;
    heap.reserve(path.size());
    const PathMemory memory =
        run_along_path({&run}, run, {gpu, path, {}}, rows, [&](double) { heap.push_back(heap_bytes()); });
    ASSERT_EQ(heap.size(), 90u);
    for (const size_t view : {30, 40, 50}) EXPECT_LT(heap[view + 30], heap[view] + 10'000) << name;
    EXPECT_EQ(memory.frames, 45u);
    EXPECT_GT(memory.bytes, size_t(1) << 20);
    EXPECT_GT(memory.bytes_at_end, size_t(1) << 20);
  }
}
#endif

// Emissive, blended and masked surfaces enter and leave the view. What they need was built before the camera
// moved.
TEST(Moving, BuildsNothingForWhatEntersTheView) {
  Scene scene = find_builtin_scene("hall")->make();
  scene.lights.resize(12);
  const View start = make_view(choose_camera(scene, ""), 48, 27);
  const auto effects_in = [&](const View& view) {
    const FramePlan plan = plan_frame(scene, view, {}, find_technique("deferred_tiled").needs);
    return plan.surfaces.blend + plan.surfaces.base_lighting + plan.surfaces.mask;
  };
  const std::vector<View> around = camera_path(scene, start, "turn:12");
  const auto [fewest, most] = std::ranges::minmax_element(around, {}, effects_in);
  ASSERT_LT(effects_in(*fewest), effects_in(*most));
  const std::vector<View> path = {*fewest, *fewest, *most};
  {
    Renderer devices("", GlBackend::automatic);  // with no program of another test
    GpuScene gpu(devices, scene);
    std::vector<Contestant> contestants;
    for (const Technique* technique : techniques()) contestants.push_back({technique, {}});
    contestants.push_back({&find_technique("deferred_tiled"), {{setting::raster, RasterApi::opencl}}});
    for (const auto& [technique, settings] : contestants) {
      TechniqueRun run(devices, gpu, start, settings, *technique);
      std::vector<RunResult> rows(1);
      run_along_path({&run}, run, {gpu, path, {}}, rows, nullptr);
      EXPECT_EQ(rows[0].moving->gl_programs, 0) << technique->name;
      EXPECT_EQ(rows[0].moving->cl_programs, 0) << technique->name;
      EXPECT_EQ(rows[0].moving->scene_bytes, 0u) << technique->name;
    }
  }
  software_devices().gl->make_current();  // for the tests that follow
}

// The report has taken the runs' images by then: each frame of the path must bring new ones.
TEST(Moving, ErrorsAreThoseOfThePathsFrames) {
  const Scene scene = small_scene().scene;
  const std::vector<Contestant> contestants = {{&find_technique("forward"), {}},
                                               {&find_technique("deferred"), {{setting::buffer_bits, 8}}}};
  CompareOptions options{.frames = 1, .warmup = 0, .shaded_samples = 10};
  options.path = camera_path(scene, small_view(48, 32), "dolly:3");
  const CompareReport report =
      compare_techniques(software_devices(), scene, small_view(48, 32), contestants, options);
  EXPECT_GT(report.rows[1].error->max_rel, 1e-4);
  EXPECT_GT(report.rows[1].moving->max_rel, 1e-4);
  EXPECT_GT(report.rows[1].moving->rmse_rel, 1e-5);
  EXPECT_EQ(report.rows[0].moving->max_rel, 0);
}

// The pane leaves the view at the first turn of two and comes back with the second. Only forward_plus has a
// grid for it.
TEST(Moving, RecordsWhenThePlanChangedAndWhy) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  const View start = small_view(32, 32);
  CompareOptions options{.frames = 1, .warmup = 0, .shaded_samples = 10};
  for (int turn = 0; turn < 2; ++turn)
    for (const View& view : camera_path(s.scene, start, "turn:3")) options.path.push_back(view);
  const CompareReport report =
      compare_techniques(software_devices(), s.scene, start,
                         {{&find_technique("forward"), {}}, {&find_technique("forward_plus"), {}}}, options);
  const std::string pane = "material 2 \"glass\" on node 2 \"pane\"";
  const PlanChange left{1, "blend", false, "left: " + pane}, came{3, "blend", true, "came: " + pane},
      left_again{4, "blend", false, "left: " + pane};
  EXPECT_THAT(report.rows[0].moving->plan_changes, testing::ElementsAre(left, came, left_again));
  const std::vector<SharedPlanChange> shared = shared_plan_changes(report);
  ASSERT_EQ(shared.size(), 6u);
  for (size_t i = 0; i < 6; i += 2) {
    EXPECT_THAT(shared[i].rows, testing::ElementsAre(0, 1));
    EXPECT_EQ(shared[i + 1].change.effect, "blended light grid");
    EXPECT_EQ(shared[i + 1].change.frame, shared[i].change.frame);
    EXPECT_THAT(shared[i + 1].rows, testing::ElementsAre(1));
  }
  EXPECT_EQ(plan_changes_in_words(report),
            "the plan changed at 3 of 6 frames along the path; effects that came or left: 6");
}

// Deformed meshes, moved instances and lights: the picture equals that of a scene created in that state.
TEST(Moving, ASceneThatChangedIsDrawnAsOneThatWasMadeSo) {
  Scene scene = find_builtin_scene("hall")->make();
  scene.lights.resize(40);
  auto rig = std::make_shared<Rig>();
  for (int mesh = 0; mesh < int(scene.meshes.size()); ++mesh) rig->meshes.push_back({.mesh = mesh});
  scene.rig = rig;
  const View view = make_view(choose_camera(scene, ""), 96, 54);
  for (const char* technique :
       {"forward", "forward_plus", "deferred_tiled", "deferred", "forward_multipass", "visibility"}) {
    Scene moving = scene;
    GpuScene gpu(software_devices(), moving);
    TechniqueRun run(software_devices(), gpu, view, {}, find_technique(technique));
    run.run_frame();
    const Image before = run.image();
    SceneChanges changes;
    for (int i = 0; i < int(moving.meshes.size()); ++i) {
      Mesh& mesh = moving.meshes[i];
      mesh.bounds = {};
      for (glm::vec3& p : mesh.positions) {
        p += 0.1f * glm::sin(3.0f * glm::vec3(p.y, p.z, p.x));
        mesh.bounds.add(p);
      }
      changes.meshes.push_back(i);
    }
    moving.instances[0].world_from_object[3].y += 0.25;
    changes.instances = {0};
    for (int i = 0; i < 40; ++i) {
      moving.lights[i].position.x += 0.5;
      changes.lights.push_back(i);
    }
    gpu.update(changes);
    run.look(view, changes);
    run.run_frame();
    EXPECT_GT(compare_images(run.image(), before).max_rel, 0.01) << "nothing moved";
    TechniqueRun fresh(software_devices(), moving, view, {}, find_technique(technique));
    fresh.run_frame();
    // Clusters are cut by the shape at rest: if surfaces share a depth, a different one may be last.
    EXPECT_LT(compare_images(run.image(), fresh.image()).rmse, 1e-6) << technique;
    const LitPairs pairs = count_listed_pairs(run, read_depth(run));
    EXPECT_EQ(pairs.lost, 0u) << technique;
  }
}

int frames_drawn = 0;

// forward, but every second view is grey: run_along_path draws each four times.
Frame flicker(RenderView& v) {
  const Frame frame = find_technique("forward").render(v);
  const float grey[4] = {0.5f, 0.5f, 0.5f, 1};
  if (frames_drawn++ / 4 % 2) glClearNamedFramebufferfv(frame.image.framebuffer, GL_COLOR, 0, grey);
  return frame;
}

TEST(Moving, SeesFlicker) {
  const Technique flickers{.name = "flickers",
                           .summary = "flickers",
                           .source = "none",
                           .needs = {},
                           .settings = {},
                           .render = flicker};
  const Scene scene = small_scene().scene;
  GpuScene gpu(software_devices(), scene);
  const std::vector<View> path(8, small_view(32, 24));  // at rest: flicker is the only change
  TechniqueRun forward(software_devices(), gpu, path[0], {}, find_technique("forward"));
  TechniqueRun grey(software_devices(), gpu, path[0], {}, flickers);
  std::vector<RunResult> rows(2);
  run_along_path({&forward, &grey}, forward, {gpu, path, {}}, rows, nullptr);
  EXPECT_EQ(rows[0].moving->temporal_max_rel, 0);
  EXPECT_EQ(rows[0].moving->max_rel, 0);
  EXPECT_GT(rows[1].moving->temporal_rmse_rel, 0.01);
  EXPECT_GT(rows[1].moving->rmse_rel, 0.01);
}

}  // namespace
}  // namespace lightgrid::lab
