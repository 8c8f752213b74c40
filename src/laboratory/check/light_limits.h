// Will this level's lights hold? Counts the lights of each view as engines do, and finds those that an
// engine would drop (docs/check.md). In double, without a device.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "check/engine_limits.h"
#include "scene/camera.h"
#include "scene/light_ranges.h"

namespace lightgrid::lab {

// The place that has too many lights, or the most: a view, an object of it, or a cell.
struct LimitPlace {
  size_t frame = 0;
  int instance = -1;      // number of a mesh: the object's first
  glm::ivec3 cell{-1};    // from the left, the bottom and the near plane
  size_t counted = 0;     // lights; of pool, entries
  const char* kind = "";  // "points" or "spots", where they count apart
};

struct DroppedLight {
  int light = 0;
  LimitPlace first;   // by frame
  size_t places = 0;  // views, objects of views or cells of views that lack it
};

struct LimitResult {
  const EngineLimit* limit = nullptr;
  size_t frames = 0, frames_over = 0;
  size_t most = 0;                    // the room of a place: the limit's; of pool that times the cells
  size_t places_over = 0;             // over all frames
  LimitPlace worst;                   // that with most lights, over the limit or not
  std::vector<LimitPlace> over;       // the worst place of each frame that has one
  std::vector<DroppedLight> dropped;  // by index
  std::vector<int> lost;              // lights that the view of the worst frame drops completely

  double holds_at = 0;  // how far ranges must shrink: a factor on all; 0: none that was tried

  bool holds() const { return places_over == 0; }
};

class LightCheck {
 public:
  // ranges: of the scene's lights; each is multiplied by range_factor.
  LightCheck(const std::vector<const EngineLimit*>& limits, const LightRanges& ranges,
             double range_factor = 1);

  // The next frame of a path. Point and spot lights without intensity or with a range of 0 count nowhere.
  void count(const Scene& scene, const View& view);

  std::vector<LimitResult> results() const;  // in the order of the limits

 private:
  LightRanges ranges_;
  double range_factor_;
  std::vector<std::unordered_map<int, size_t>> numbers_;  // numbers of each limit's dropped lights
  std::vector<LimitResult> results_;  // their lights in the order in which they were dropped
  size_t frame_ = 0;
};

// A glTF node's instances, one a primitive, are one object of an engine: those that follow one another with
// one name and one place. Index of the first instance, for each instance.
std::vector<int> objects_of(const Scene& scene);

// How a broken limit is drawn: techniques with settings (docs/capped_lists.md), as take_own_settings reads
// them.
struct LimitPicture {
  std::string every_light, limited;
  bool without_lost = false;  // limited: a scene without LimitResult::lost
  std::string note;           // how it differs from the engine's; may be empty
};
// None, with the reason, if neither settings nor a scene with fewer lights are like the limit.
std::optional<LimitPicture> limit_picture(const EngineLimit& limit, const Scene& scene, std::string& why);

}  // namespace lightgrid::lab
