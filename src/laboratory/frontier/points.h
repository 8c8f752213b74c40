// The points of a frontier: techniques with settings. By default a star around the defaults: each technique
// as it is, then one setting at a time.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "compare/compare.h"
#include "frontier/export.h"
#include "frontier/external.h"
#include "frontier/external_process.h"
#include "frontier/record.h"
#include "plan/settings/model.h"
#include "run/frames.h"

namespace lightgrid::lab {

struct ChosenPoint {
  Contestant contestant;
  int frames = 1;  // averaged, each with other random numbers
  std::string label;
  std::shared_ptr<const ExternalRenderer> external = nullptr;  // another renderer; no contestant then

  bool runs() const { return !external || external->runs(); }
};

ChosenPoint external_point(std::shared_ptr<const ExternalRenderer> renderer);

// `techniques` as compare's -t, or empty: the default points, of which those that need OpenGL are left out
// without it. `truth`: where lights of the scene cast, what points are held to; the default points then vary
// shadows, and their samples of spheres if the truth's lights are such. `vary`: "KEY=V1,V2": each technique
// that reads KEY with each value, one key at a time; "frames=1,4,16": averaged frames of random points
// (is_random). Duplicates are dropped. Throws Error(input) that names what is wrong.
std::vector<ChosenPoint> chosen_points(const std::vector<std::string>& techniques,
                                       const std::vector<std::string>& vary, const Settings& common,
                                       bool opengl, const std::optional<FrontierTruth>& truth = {});

// The default points of families of lights (families.h): techniques of each kind of lists, each as it is,
// with farther ranges, without any and with far light; and what only visibility has. Those that need OpenGL
// are left out without it.
std::vector<ChosenPoint> family_points(const Settings& common, bool opengl);

// The point with which each other is measured in turn: forward_plus as it is or, without OpenGL, visibility.
// `text`: another one, NAME[:KEY=VALUE,…]; empty: these. Throws Error(input) if it is not one point.
ChosenPoint baseline_point(const Settings& common, bool opengl, const std::string& text = "");

// "visibility:range=cutoff,cutoff=0.05": what differs from the defaults and has an effect.
std::string label_of(const Contestant& contestant, int frames);

// Infinite or random ranges, or far light: the picture has light beyond the lights' ranges.
bool adds_light(const ChosenPoint& point);

FrontierPoint described(const std::string& scene, const ChosenPoint& point);

// Returns whether timed frames end with the bytes of a display (picture=bytes): on GPUs, where reading back
// floats can take half of a frame. On CPUs the host reads the floats where they are.
bool times_bytes(const Renderer& renderer);

// Random numbers of frames are independent, or continue from frame to frame as a renderer's do: those of
// sampled lists then complement each other.
enum class NumbersOfFrames { independent, in_a_row };

// A point that runs: a technique's frames, or the mean of several with other random numbers; or another
// renderer's process.
class PointRun {
 public:
  // Refused at once if the technique cannot run. `exported`: the scene, for another renderer.
  PointRun(Renderer& renderer, GpuScene& gpu, const View& view, const ChosenPoint& point,
           std::shared_ptr<TargetPool> pool, const ExportedScene* exported = nullptr);

  const ChosenPoint& point() const { return point_; }
  const std::string& refused() const { return refused_; }  // empty: it runs
  TechniqueRun& run() { return *run_; }                    // not of another renderer
  double asked_ms() const { return asked_ms_; }            // another renderer's last answer took as long

  void look(const View& view, const SceneChanges& changes = {});  // as TechniqueRun::look
  // One picture: all of its frames, each with random numbers of its own where there are any, read back and
  // averaged. Milliseconds; 0 if refused. A refusal is kept. `clock`: measures the same picture
  // (device_times()).
  // With a clock a picture of one frame ends with its bytes where times_bytes() says so, and image() is an
  // older one.
  double draw(DeviceClock* clock = nullptr);
  // The times of the last draw() with a clock; empty too if that clock has none, or the point is refused.
  const std::optional<DeviceTimes>& device_times() const { return device_times_; }
  // The processor time of this process in the last draw(); empty for another renderer.
  std::optional<double> cpu_ms() const { return cpu_ms_; }
  // The picture drawn last; and of an averaged one how far its frames scatter.
  const Image& image() const { return point_.frames > 1 || point_.external ? mean_ : run_->image(); }
  double deviation() const { return deviation_; }
  // Draws as draw() does, and computes deviation(), which takes time; of another renderer, image().
  // Milliseconds of another renderer's frame, otherwise 0.
  double draw_for_errors();
  // The first of its frames alone; nothing of another renderer, which draws one before each that it times.
  void draw_first_frame();
  // Gives up what it holds, as if it could not run.
  void refuse(const std::string& why);
  // For the frame of that number: random numbers, if there are any, are others in each.
  void go_to_frame(int number, NumbersOfFrames numbers = NumbersOfFrames::independent);
  bool has_random_ranges() const {
    return point_.contestant.settings[setting::range] == LightRange::stochastic;
  }
  // Random ranges or lists: no two frames are alike.
  bool is_random() const;

 private:
  void attempt(const std::function<void()>& work);
  // `add`: of averaged ones. timed: image() need not be there.
  void draw_frames(bool timed, const std::function<void(const Image& image)>& add);
  void draw_one(bool timed);
  uint32_t seed(int frame) const;
  double ask(bool for_picture);

  ChosenPoint point_;
  std::unique_ptr<TechniqueRun> run_;
  std::string refused_;
  Image mean_;
  double deviation_ = 0;
  std::optional<DeviceTimes> device_times_;
  std::optional<double> cpu_ms_;
  int frame_ = 0;
  NumbersOfFrames numbers_ = NumbersOfFrames::independent;

  std::unique_ptr<ExternalProcess> external_;
  ExportedScene exported_;
  View view_;  // for another renderer
  double asked_ms_ = 0;
};

}  // namespace lightgrid::lab
