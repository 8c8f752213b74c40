#include "compare/comparison.h"

#include <algorithm>

#include "base/text.h"
#include "c_api/handles.h"
#include "c_api/images.h"
#include "report/report.h"

struct lightgrid_report {
  lightgrid::lab::CompareReport report;
  std::string json;
};

namespace lightgrid::app::c {
using namespace lab;
namespace {

int checked_whole(const std::string& name, const std::string& text, int least, int most) {
  const auto number = parse_number<int>(text);
  if (!number || *number < least || *number > most)
    throw input_error("{} {}: not a number from {} to {}", name, text, least, most).about(name);
  return *number;
}

void set_field(CompareChoice& choice, const std::string& assignment) {
  const size_t equals = std::min(assignment.find('='), assignment.size());
  const std::string name = assignment.substr(0, equals),
                    value = assignment.substr(std::min(assignment.size(), equals + 1));
  if (name == "frames") {
    choice.timing.frames = checked_whole(name, value, 1, 10000);
  } else if (name == "warmup") {
    choice.timing.warmup = checked_whole(name, value, 0, 10000);
  } else if (name == "flip") {
    choice.flip = checked_whole(name, value, 0, 1) == 1;
  } else if (name == "reference") {
    choice.reference = value;
  } else if (name == "compare") {
    choice.compare.push_back(value);
  } else if (name == "set") {
    choice.scene.set.push_back(value);
  } else {
    throw input_error(
        "{}: not NAME=VALUE with the name of a field; fields are frames, warmup, reference, flip, "
        "compare, set",
        assignment)
        .about(name);
  }
}

// True if a setting that a scene's warning advises was given: scenes are loaded without settings.
bool is_answered(const Warning& warning, const std::vector<std::string>& given) {
  const auto key_of = [](const std::string& setting) { return setting.substr(0, setting.find('=')); };
  return std::ranges::any_of(warning.settings, [&](const std::string& advised) {
    return std::ranges::find(given, key_of(advised), key_of) != given.end();
  });
}

}  // namespace
}  // namespace lightgrid::app::c

using namespace lightgrid;
using namespace lightgrid::app::c;

extern "C" {

lightgrid_status lightgrid_compare(lightgrid_device* device, lightgrid_scene* scene,
                                   const char* const* techniques, const char* const* fields,
                                   lightgrid_progress_function progress, void* user,
                                   lightgrid_report** report) {
  return call([&] {
    lightgrid_report*& out = needed(report, "report");
    OpenDevice& on = *needed(device, "device").device;
    LoadedScene& of = *needed(scene, "scene").loaded;
    CompareChoice choice;
    choice.scene = of.choice;
    for (const std::string& field : words_of(fields)) set_field(choice, field);
    choice.techniques = words_of(techniques);
    const std::vector<Contestant> all = contestants_of(choice);
    const View& view = of.view();
    const auto tell = [&](double done, const std::string& step) {
      if (progress && progress(done, step.c_str(), user) != 0) throw Cancelled();
    };
    const Turn turn(on);
    auto made = std::make_unique<lightgrid_report>();
    try {
      made->report = compare_view(on.renderer(), of.scene, view, choice.scene, choice,
                                  runnable(choice, all, on.renderer()), tell);
    } catch (...) {
      if (!choice.scene.camera_path.empty()) of.rebuilt();
      throw;
    }
    if (!choice.scene.camera_path.empty()) of.rebuilt();  // objects that moved along the path stay there
    std::vector<Warning> warnings = of.warnings;
    std::erase_if(warnings, [&](const Warning& w) { return is_answered(w, choice.scene.set); });
    add_distinct(warnings, made->report.warnings);
    made->report.warnings = std::move(warnings);
    made->json = json_text(made->report);
    out = made.release();
  });
}

void lightgrid_report_free(lightgrid_report* report) { delete report; }

const char* lightgrid_report_json(const lightgrid_report* report) {
  return report ? report->json.c_str() : nullptr;
}

lightgrid_status lightgrid_report_image(const lightgrid_report* report, size_t row,
                                        const lightgrid_image* image) {
  return call([&] {
    const CompareReport& from = needed(report, "report").report;
    if (row >= from.rows.size()) throw wrong("row", "{}: there are {} rows", row, from.rows.size());
    const Image& found = image_of(from, row);
    if (found.pixels.empty()) throw wrong("row", "{} has no image: {}", row, from.rows[row].refused);
    write_pixels(checked(image, "image", LIGHTGRID_RGBA_F32, found.width, found.height), found.pixels.data());
  });
}

lightgrid_status lightgrid_report_save(const lightgrid_report* report, const char* folder) {
  return call([&] {
    const std::string to = &needed(folder, "folder");
    write_report(to, needed(report, "report").report);
  });
}

}  // extern "C"
