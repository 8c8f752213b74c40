#include "accuracy/oracle.h"
#include "c_api/handles.h"
#include "c_api/images.h"
#include "compare/contestants.h"
#include "plan/plan_changes.h"
#include "plan/settings/picture.h"

namespace lightgrid::app::c {
using namespace lab;
namespace {

std::shared_ptr<TechniqueRun> make_run(const lightgrid_view& v, const View& view) {
  return std::make_shared<TechniqueRun>(v.device->renderer(), *v.gpu, view, v.settings, *v.technique);
}

bool draws_bytes(const lightgrid_view& v) { return v.settings[setting::picture] == PictureFormat::bytes; }

// The run, for the scene as it now is.
TechniqueRun& follow(lightgrid_view& v) {
  const LoadedScene& scene = *v.scene->scene;
  if (v.run && v.shape == scene.shape() && v.time == scene.time()) return *v.run;
  v.scene = v.device->follow(v.scene->scene);
  v.drawn = false;
  if (!v.run || v.shape != scene.shape()) {
    v.run.reset();
    v.gpu = v.scene->gpu;
    v.run = make_run(v, v.view);
  } else {
    v.run->look(v.view, scene.changes_since(v.time));
  }
  v.shape = scene.shape();
  v.time = scene.time();
  return *v.run;
}

TechniqueRun& drawn(lightgrid_view& v) {
  const LoadedScene& scene = *v.scene->scene;
  if (!v.drawn || v.shape != scene.shape() || v.time != scene.time())
    throw wrong("view", "no frame of this camera and scene has been drawn");
  return *v.run;
}

}  // namespace

lightgrid_projection projection_of(const View& view) {
  lightgrid_projection out;
  for (int i = 0; i < 16; ++i) {
    out.clip_from_view[i] = view.clip_from_view[i / 4][i % 4];
    out.view_from_world[i] = view.view_from_world[i / 4][i % 4];
  }
  for (int i = 0; i < 3; ++i) out.eye[i] = view.eye[i];
  out.width = view.width;
  out.height = view.height;
  return out;
}

}  // namespace lightgrid::app::c

using namespace lightgrid;
using namespace lightgrid::app::c;

extern "C" {

lightgrid_status lightgrid_view_open(lightgrid_device* device, lightgrid_scene* scene, const char* technique,
                                     const char* const* settings, lightgrid_view** view) {
  return call([&] {
    lightgrid_view*& out = needed(view, "view");
    const std::shared_ptr<OpenDevice> on = needed(device, "device").device;
    const std::shared_ptr<LoadedScene> of = needed(scene, "scene").loaded;
    std::string name = technique ? technique : "";
    SceneChoice choice = of->choice;
    choice.set = words_of(settings);
    take_own_settings(name, choice.set);
    const Settings chosen = chosen_settings(choice);
    const Technique& found = technique_or_default(name, on->renderer());
    check_given_settings(chosen, {{&found, chosen}});
    const View& first = of->view();
    const Turn turn(*on);
    std::unique_ptr<lightgrid_view> made(new lightgrid_view{on, on->follow(of), &found, chosen, first});
    follow(*made);
    out = made.release();
  });
}

void lightgrid_view_close(lightgrid_view* view) { close(view); }

lightgrid_status lightgrid_view_look(lightgrid_view* view, const lightgrid_camera* camera, int32_t width,
                                     int32_t height) {
  return call([&] {
    lightgrid_view& v = needed(view, "view");
    parse_size(fmt::format("{}x{}", width, height));
    const View looked = make_view(
        camera ? camera_of(*camera) : v.scene->scene->camera(double(width) / height), width, height);
    const Turn turn(*v.device);
    TechniqueRun& run = follow(v);
    const bool frames_hold_memory = v.run.use_count() > 1;
    if (frames_hold_memory && looked.grid() != v.view.grid())
      v.run = make_run(v, looked);
    else
      run.look(looked);
    v.view = looked;
    v.drawn = false;
  });
}

lightgrid_status lightgrid_view_size(const lightgrid_view* view, int32_t* width, int32_t* height) {
  return call([&] {
    const View& of = needed(view, "view").view;
    needed(width, "width") = of.width;
    needed(height, "height") = of.height;
  });
}

lightgrid_status lightgrid_view_render(lightgrid_view* view, const lightgrid_image* image) {
  return call([&] {
    lightgrid_view& v = needed(view, "view");
    const bool bytes = draws_bytes(v) && image && image->format == LIGHTGRID_RGBA_U8;
    const lightgrid_image& to =
        checked(image, "image", bytes ? LIGHTGRID_RGBA_U8 : LIGHTGRID_RGBA_F32, v.view.width, v.view.height);
    const Turn turn(*v.device);
    TechniqueRun& run = follow(v);
    v.drawn = false;
    if (bytes)
      write_pixels(to, run.show_picture());
    else
      write_pixels(to, run.show_frame());
    v.drawn = true;
  });
}

lightgrid_status lightgrid_view_draw(lightgrid_view* view, lightgrid_image* image, lightgrid_frame** frame) {
  return call([&] {
    lightgrid_view& v = needed(view, "view");
    lightgrid_image& out = needed(image, "image");
    const Turn turn(*v.device);
    TechniqueRun& run = follow(v);
    v.drawn = false;
    std::unique_ptr<lightgrid_frame> made;
    if (frame) made.reset(new lightgrid_frame{v.device, v.scene, v.gpu, v.run});
    out = {nullptr, v.view.width, v.view.height, draws_bytes(v) ? LIGHTGRID_RGBA_U8 : LIGHTGRID_RGBA_F32};
    out.row_bytes = ptrdiff_t(out.width) * ptrdiff_t(pixel_bytes(out.format));
    if (draws_bytes(v))
      out.pixels = run.show_picture();
    else
      out.pixels = run.show_frame();
    v.drawn = true;
    if (frame) *frame = made.release();
  });
}

void lightgrid_frame_free(lightgrid_frame* frame) { close(frame); }

lightgrid_status lightgrid_view_depth(lightgrid_view* view, const lightgrid_image* depth) {
  return call([&] {
    lightgrid_view& v = needed(view, "view");
    const lightgrid_image& to = checked(depth, "depth", LIGHTGRID_R_F32, v.view.width, v.view.height);
    const Turn turn(*v.device);
    write_pixels(to, read_depth(drawn(v)).data());
  });
}

lightgrid_status lightgrid_view_listed(lightgrid_view* view, const lightgrid_image* counts) {
  return call([&] {
    lightgrid_view& v = needed(view, "view");
    const lightgrid_image& to = checked(counts, "counts", LIGHTGRID_R_U32, v.view.width, v.view.height);
    const Turn turn(*v.device);
    TechniqueRun& run = drawn(v);
    const ListedLights lists = listed_lights(run, read_depth(run));
    std::vector<uint32_t> of_pixels(v.view.grid().pixels());
    for (size_t i = 0; i < of_pixels.size(); ++i)
      of_pixels[i] = lists.count[lists.cell_of_pixel.empty() ? 0 : lists.cell_of_pixel[i]];
    write_pixels(to, of_pixels.data());
  });
}

lightgrid_status lightgrid_view_profile(lightgrid_view* view, char** json) {
  return call([&] {
    lightgrid_view& v = needed(view, "view");
    char*& out = needed(json, "json");
    const Turn turn(*v.device);
    TechniqueRun& run = follow(v);
    v.drawn = false;
    run.run_frame();
    run.run_profiled_frames();
    v.drawn = true;
    out = text_for_caller(json_text(RunResult{run.result()}));
  });
}

lightgrid_status lightgrid_project(const lightgrid_camera* camera, int32_t width, int32_t height,
                                   lightgrid_projection* projection) {
  return call([&] {
    lightgrid_projection& out = needed(projection, "projection");
    const Camera of = camera_of(needed(camera, "camera"));
    parse_size(fmt::format("{}x{}", width, height));
    out = projection_of(make_view(of, width, height));
  });
}

}  // extern "C"
