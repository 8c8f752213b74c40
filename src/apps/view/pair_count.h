// The pairs of a pixel and a light of a side's last frame, counted by the oracle on other threads while the
// window goes on.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "accuracy/frame_shadows.h"
#include "frames/frame_file.h"
#include "oracle/lit_set.h"
#include "run/technique_run.h"

namespace lightgrid::app {

// The last frame of a side, copied from the devices, with the lights that it listed.
struct ListedFrame {
  lab::CapturedFrame frame;
  std::vector<ViewLight> lights;  // point and spot lights, in the lists' order
  ListedLights lists;
};
ListedFrame read_listed_frame(TechniqueRun& run);

// The choice of pairs to count.
struct CountChoice {
  size_t picture = 0;        // number of the side's
  std::optional<int> light;  // the only counted light of the scene; none: all but directional ones
  bool shadows = false;      // shadows hide lights, as in LitPairs
  bool operator==(const CountChoice&) const = default;
};

// One count at a time. Without shadows it takes about a second for a full picture and a thousand lights, with
// shadows about a million pairs a second and core.
class PairCount {
 public:
  // It outlives this.
  explicit PairCount(lab::SceneOcclusion& occlusion) : occlusion_(occlusion) {}
  ~PairCount() { leave_scene(); }
  PairCount(const PairCount&) = delete;

  // Starts the count of the run's last frame; nothing may be running.
  void start(TechniqueRun& run, const CountChoice& choice);
  bool running() const { return running_.valid(); }
  // The share of the pixels whose shadows are decided: 0 to 1.
  double progress() const { return job_ ? std::min(1.0, double(job_->tiles_done) / job_->tiles) : 0; }
  // The last count, if it is of this choice and done; else null, and a running one of another choice ends
  // soon. `wait`: waits for it.
  const lab::LitPairs* result(const CountChoice& choice, bool wait);
  // Ends what runs, and returns when it no longer reads the scene, which may then change.
  void leave_scene();

 private:
  struct Job {
    CountChoice choice;
    ListedFrame listed;
    std::vector<int> places;                   // in the scene, of listed.lights
    std::vector<int> directional;              // lights in the scene, counted besides where all lights are
    std::optional<lab::FrameShadows> shadows;  // if they are counted
    std::atomic<bool> stops = false;
    std::atomic<int> tiles_done = 0;
    int tiles = 1;
    std::mutex reads_scene;
  };
  static void count_light_alone(Job& job, const TechniqueRun& run);
  static std::optional<lab::LitPairs> count(Job& job, lab::SceneOcclusion& occlusion);

  lab::SceneOcclusion& occlusion_;
  std::shared_ptr<Job> job_;
  std::future<std::optional<lab::LitPairs>> running_;
  std::optional<lab::LitPairs> done_;
  CountChoice done_choice_;
};

}  // namespace lightgrid::app
