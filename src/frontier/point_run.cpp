#include "frontier/point_run.h"

#include <new>

#include "base/error.h"
#include "base/timer.h"
#include "cl/error.h"
#include "frontier/errors.h"

namespace lightgrid {

template <typename Work>
void PointRun::attempt(const Work& work) {
  if (!refused_.empty()) return;
  try {
    work();
  } catch (const Error& error) {
    refused_ = error.what();
  } catch (const cl::Error& error) {
    refused_ = cl_machine_error(error).what();
  } catch (const std::bad_alloc&) {
    refused_ = "out of memory";
  }
  if (!refused_.empty()) run_.reset();
}

PointRun::PointRun(Renderer& renderer, GpuScene& gpu, const View& view, const ChosenPoint& point,
                   std::shared_ptr<TargetPool> pool)
    : point_(point) {
  attempt([&] {
    run_ = std::make_unique<TechniqueRun>(renderer, gpu, view, point.contestant.settings,
                                          *point.contestant.technique, std::move(pool));
  });
}

uint32_t PointRun::seed(int frame) const {
  return point_.contestant.settings.ranges.seed + uint32_t(frame_ * point_.frames + frame);
}

void PointRun::go_to_frame(int number) {
  frame_ = number;
  if (point_.frames > 1 || !has_random_ranges()) return;
  attempt([&] { run_->draw_ranges(seed(0)); });
}

void PointRun::look(const View& view) {
  attempt([&] { run_->look(view); });
}

double PointRun::draw() {
  double ms = 0;
  attempt([&] {
    const Timer timer;
    if (point_.frames == 1) {
      run_->run_frame(true);
    } else {
      for (int frame = 0; frame < point_.frames; ++frame) {
        run_->draw_ranges(seed(frame));
        run_->run_frame(true);
        if (frame == 0) mean_ = Image(run_->image().width, run_->image().height);
        const float weight = 1.0f / float(point_.frames);
        for (size_t i = 0; i < mean_.pixels.size(); ++i) mean_.pixels[i] += run_->image().pixels[i] * weight;
      }
    }
    ms = timer.elapsed_ms();
  });
  return ms;
}

void PointRun::draw_for_errors() {
  attempt([&] {
    PictureMoments moments;
    for (int frame = 0; frame < point_.frames; ++frame) {
      if (point_.frames > 1) run_->draw_ranges(seed(frame));
      run_->run_frame(true);
      if (point_.frames > 1) moments.add(run_->image());
    }
    if (point_.frames == 1) return;
    mean_ = moments.mean();
    deviation_ = moments.deviation();
  });
}

void PointRun::draw_first_frame() {
  attempt([&] {
    if (point_.frames > 1) run_->draw_ranges(seed(0));
    run_->run_frame(true);
  });
}

}  // namespace lightgrid
