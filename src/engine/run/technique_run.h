// Runs a technique on a view and measures it.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "passes/read_back.h"
#include "plan/settings/picture.h"
#include "run/frame_figures.h"
#include "techniques/technique.h"

namespace lightgrid {

// A technique with programs and buffers for a view. Several may exist side by side, so that comparisons run
// interleaved; they share the scene's memory if they are given the same GpuScene.
class TechniqueRun {
 public:
  // pool: images that runs share (RenderView); call draw_frame() before reading targets after other runs'
  // frames. Throws Error(machine), with a size that fits, if the memory does not suffice for a frame, or
  // after release() for its image and file_bytes per pixel in addition.
  TechniqueRun(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& settings,
               const Technique& technique, std::shared_ptr<TargetPool> pool = nullptr, int file_bytes = 0);
  // With its own GPU scene.
  TechniqueRun(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings,
               const Technique& technique);

  // Builds what frames of other views of the scene need: before a camera moves (RenderView::prepare).
  void prepare();
  // Another camera or size, for the frames that follow.
  void look(const View& view) {
    hide();
    view_.look(view);
  }
  // The same after the scene changed; its GpuScene is already updated.
  void look(const View& view, const SceneChanges& changes) {
    look(view);
    if (!changes.lights.empty()) view_.lights_changed();
  }

  // Other random numbers (RenderView::draw_random), for the frames that follow.
  void draw_random(uint32_t seed) { view_.draw_random(seed); }

  // One frame. Returns its time in ms, from the first draw until the host can read the image, or with
  // picture=bytes the picture, which is recorded unless `warmup`. image() and picture() are copies, which
  // that time does not count on an OpenCL device that is a CPU: there the host can read the original. With
  // picture=bytes it counts no copy of the image.
  double run_frame(bool warmup = false);
  // The same with picture=bytes for picture() alone: image() is then an older frame's.
  double run_picture(bool warmup = false);
  // The same for a caller that reads the pixels where they are, row 0 at the bottom: they stay until the next
  // frame, look(), prepare() or release(), and may be overwritten. At a size that stays, the memory is the
  // same in each frame. image() is then an older frame's.
  glm::vec4* show_frame();
  // The same with picture=bytes: RGBA.
  glm::u8vec4* show_picture();
  // One frame whose image stays on its device, for a window: frame().image. image() is then an older frame's.
  void draw_frame();
  // More frames with a wait after each pass, for pass times: up to five, or as many as fit in the time.
  void run_profiled_frames(double max_ms = 1000);

  // Frees what the next frame creates again (RenderView::release). All runs of a pool have to be released
  // before one of them draws again.
  void release();

  const Image& image() const { return image_; }
  // With picture=bytes: what srgb_bytes makes of the image, RGBA, row 0 at the bottom; else empty.
  const std::vector<glm::u8vec4>& picture() const { return picture_; }
  bool draws_bytes() const { return view_.plan.settings[setting::picture] == PictureFormat::bytes; }
  Image take_image() { return std::exchange(image_, {}); }    // image() is empty until the next run_frame()
  void reuse(Image&& memory) { image_ = std::move(memory); }  // for the next frame's image
  RenderView& view() { return view_; }
  const RenderView& view() const { return view_; }
  const Frame& frame() const { return frame_; }  // the last one
  const Technique& technique() const { return technique_; }
  bool limits_lists() const { return lightgrid::limits_lists(technique_, view_.plan.settings); }
  bool approximate() const { return is_approximate(technique_, view_.plan.settings); }
  const std::vector<double>& frame_ms() const { return frame_ms_; }  // times of recorded frames, in order

  FrameFigures result() const;

 private:
  void hide() {
    shown_.reset();
    shown_picture_.reset();
  }
  struct FrameTime {
    double ms = 0, cpu_ms = 0;
  };
  // Until it has been read: into shown_, into shown_picture_.
  FrameTime time_frame(const std::function<void()>& read);
  FrameTime time_image();
  FrameTime time_picture();
  double recorded(const FrameTime& time);  // its ms

  const Technique& technique_;
  std::unique_ptr<GpuScene> own_scene_;
  RenderView view_;
  bool drawn_ = false;  // or prepared
  Frame frame_;
  Image image_;
  std::vector<glm::u8vec4> picture_;
  std::optional<HostImage> shown_;
  std::optional<HostPicture> shown_picture_;
  std::vector<double> frame_ms_, frame_cpu_ms_;
};

}  // namespace lightgrid
