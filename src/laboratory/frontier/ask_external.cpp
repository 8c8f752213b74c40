// A frame of another renderer: the request, and what is believed of the answer
// (docs/put_your_renderer_on_the_plane.md#a-command).
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/exr_picture.h"
#include "base/json_file.h"
#include "base/timer.h"
#include "frontier/points.h"

namespace lightgrid::lab {
namespace {

std::string in_one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text.substr(0, 500);
}

// Another renderer's answer to a request that took `asked_ms` by this program's clock.
struct FrameAnswer {
  double ms = 0;
  std::optional<double> device_ms, cpu_ms;
};

FrameAnswer frame_answer(const std::string& line, double asked_ms) {
  nlohmann::json parsed;
  try {
    parsed = parsed_json(line, 4);
  } catch (const Error& error) {
    throw machine_error("answer {}: {}", in_one_line(line.substr(0, 60)), error.what());
  }
  const JsonFields answer(parsed, "answer: ");
  if (answer.has("error")) throw machine_error("{}", in_one_line(answer.text("error")));
  const auto above_zero = [&](const char* key) {
    const double ms = answer.number(key);
    if (!(ms > 0 && std::isfinite(ms))) throw machine_error("answer: {}: {} is not above 0", key, ms);
    return ms;
  };
  const auto checked = [&](const char* key) {
    const double ms = above_zero(key);
    if (ms > asked_ms)
      throw machine_error("answer: {}: {} is more than the {:.3f} ms from the request to the answer", key, ms,
                          asked_ms);
    return ms;
  };
  FrameAnswer frame{.ms = checked("frame_ms"), .device_ms = {}, .cpu_ms = {}};
  if (answer.has("device_ms")) frame.device_ms = checked("device_ms");
  if (answer.has("cpu_ms")) frame.cpu_ms = above_zero("cpu_ms");  // on several cores more than asked_ms
  answer.check_fields({"frame_ms", "device_ms", "cpu_ms"});
  return frame;
}

}  // namespace

// Another renderer's frame of the view, in ms; 0 if it is refused.
double PointRun::ask(bool for_picture) {
  double ms = 0;
  attempt([&] {
    nlohmann::ordered_json request = {{"lightgrid_frame", 1},
                                      {"scene", (exported_.folder / "scene.glb").string()},
                                      {"name", exported_.name}};
    const std::string camera = camera_of(exported_, view_);
    request["camera"] = camera.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(camera);
    for (const auto& [key, radiance] :
         {std::pair{"ambient", exported_.ambient}, {"background", exported_.background}})
      request[key] = {radiance.r, radiance.g, radiance.b};
    request.update(view_json(view_));
    const std::filesystem::path picture = exported_.folder / (point_.external->name + ".exr");
    request["picture"] = for_picture ? nlohmann::ordered_json(picture.string()) : nullptr;
    std::error_code ignored;
    if (for_picture) std::filesystem::remove(picture, ignored);  // an older one must not pass for it
    const Timer timer;
    const std::string answer =
        external_->ask(request.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    asked_ms_ = timer.elapsed_ms();
    const FrameAnswer frame = frame_answer(answer, asked_ms_);
    ms = frame.ms;
    if (frame.device_ms) device_times_ = DeviceTimes{.device_ms = *frame.device_ms};
    cpu_ms_ = frame.cpu_ms;
    if (for_picture) mean_ = load_exr_picture(picture, view_.width, view_.height);
  });
  if (!refused_.empty()) external_.reset();
  return refused_.empty() ? ms : 0;
}

}  // namespace lightgrid::lab
