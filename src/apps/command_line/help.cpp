#include "command_line/help.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <sstream>

#include <fmt/format.h>

namespace lightgrid::app {
namespace {

constexpr size_t name_columns = 28, min_width = 60, default_width = 100;

size_t width_of_output() {
  winsize size{};
  if (isatty(STDOUT_FILENO) && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    return std::max<size_t>(size.ws_col, min_width);
  return default_width;
}

// Lines of words, `first` before the text, which starts at `column` in each line.
std::string wrapped(const std::string& first, const std::string& text, size_t column, size_t width) {
  std::string out = first, margin(column, ' ');
  if (first.empty())
    out = margin;
  else if (first.size() + 2 > column)
    out += "\n" + margin;
  else
    out.resize(column, ' ');
  size_t at = column;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (at > column && at + 1 + word.size() > width) {
      out += "\n" + margin;
      at = column;
    }
    if (at > column) out += ' ', ++at;
    out += word;
    at += word.size();
  }
  return out + "\n";
}

struct Example {
  const char *call, *comment;
};

const std::map<std::string, std::vector<Example>>& examples() {
  static const std::map<std::string, std::vector<Example>> all = {
      {"render",
       {{"hall -o hall.png", "a built-in scene"},
        {"level.glb --look -o level.png", "your file, with shadows, smooth edges and a filmic curve"},
        {"hall -t visibility --frames 30", "the time of a frame"}}},
      {"compare",
       {{"level.glb", "three techniques: picture, time and error of each"},
        {"hall -t forward,forward_plus,visibility", "these three"},
        {"hall -t forward_plus --compare tile=8,16,32", "a technique with several values of a setting"}}},
      {"plan",
       {{"level.glb", "which effects the first view needs, and why"},
        {"hall -t visibility", "for one technique"},
        {"hall --json -", "as JSON on stdout"}}},
      {"capture",
       {{"hall -o frame", "depth, lights, view and light lists as files"},
        {"hall --lights 1000 -o frame", "with a thousand scattered lights"},
        {"hall --set tile=32 -o frame", "with larger tiles"}}},
      {"cull",
       {{"frame -o lists", "makes the lists of a captured frame"},
        {"frame -o lists --set cull-test=exact", "with another test"},
        {"frame --judge -o judged", "compares the lists of a frame, from any engine, with the oracle"}}},
      {"inspect",
       {{"hall --pixel 640,360", "the lights at one pixel, and why each is listed"},
        {"hall --pixel 640,360 -t clustered", "in another technique"},
        {"hall --pixel 640,360 --json -", "as JSON on stdout"}}},
      {"reference",
       {{"hall --size 640x360 -o hall.exr",
         "a picture in double precision, with the error bounds of each pixel"},
        {"level.glb --places 64 -o level.exr", "with less noise at edges"},
        {"level.glb --against mine.exr", "compares your renderer's picture of the same view"}}},
      {"info",
       {{"level.glb", "what the file has, and what lightgrid makes of it"},
        {"hall", "a built-in scene"},
        {"level.glb --json -", "as JSON on stdout"}}},
      {"scenes",
       {{"", "the built-in scenes"},
        {"--json -", "as JSON on stdout"},
        {"--json scenes.json", "as JSON into a file"}}},
      {"techniques",
       {{"", "what each technique does, and the settings that matter most"},
        {"--settings", "all settings, and which technique reads which"},
        {"--json -", "as JSON on stdout"}}},
      {"devices",
       {{"", "OpenCL devices and OpenGL backends, and the ones in use"},
        {"--device pocl", "which device a name chooses"},
        {"--json -", "as JSON on stdout"}}},
      {"bench",
       {{"--filter hall", "the kernels in frames of one scene"},
        {"level.glb", "the kernels in a frame of your file"},
        {"--tune", "finds and stores the fastest kernel sizes of this device"}}},
      {"verify",
       {{"", "all hard cases on all devices"},
        {"--filter depth/", "one group of cases"},
        {"--hunt 10", "ten minutes of random cases"}}},
      {"view",
       {{"hall", "a window"},
        {"level.glb --left forward --right visibility", "your file by two techniques"},
        {"hall --frames 1 --screenshot view.png", "one frame of the window as a file"}}},
      {"frontier",
       {{"level.glb --budget 10", "which setting is the fastest for which error, in ten minutes"},
        {"hall -t forward_plus,visibility --views 2", "two techniques, two views"},
        {"merge part1 part2 -o all", "one answer from several parts"}}},
      {"which",
       {{"level.glb", "the fastest setting whose picture is within a FLIP of 0.05"},
        {"hall --error 0.001 --seconds 60", "without a visible difference, in a minute"},
        {"hall -t forward_plus,clustered,visibility --changes",
         "three techniques, also with more lights and pixels"}}},
      {"golden",
       {{"record pictures hall", "stores hashes of a scene's pictures"},
        {"check pictures", "draws them again and compares"},
        {"check pictures --json -", "as JSON on stdout"}}},
      {"check",
       {{"level.glb", "which lights engines would drop"},
        {"level.glb --engine godot-mobile --html check.html", "one engine, as a page with pictures"},
        {"level.glb --shorten", "how far ranges must shrink until limits hold"}}},
      {"manual",
       {{"page > lightgrid.1", "the man page"},
        {"bash > lightgrid.bash", "completion for bash"},
        {"zsh > _lightgrid", "completion for zsh"}}},
  };
  return all;
}

}  // namespace

HelpFormatter::HelpFormatter() : width_(width_of_output()) { column_width(name_columns); }

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return wrapped("", app->get_description(), 0, width_);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return wrapped("  " + command->get_name(), command->get_description(), name_columns / 2, width_);
}

// The base class already prints an empty line between two headings.
std::string HelpFormatter::make_group(std::string heading, bool positional,
                                      std::vector<const CLI::Option*> options) const {
  std::string text = (positional || heading == "Options" ? "\n" : "") + heading + ":\n";
  for (const CLI::Option* option : options) text += make_option(option, positional);
  return text;
}

// Ranges of numbers are left out: an error names them.
std::string HelpFormatter::make_option(const CLI::Option* option, bool positional) const {
  std::string name = "  " + make_option_name(option, positional);
  if (option->get_items_expected_max() > 0) {
    const std::string type = option->get_type_name();
    name += type.starts_with("TEXT") ? " TEXT" : " N";
    if (!option->get_default_str().empty()) name += "=" + option->get_default_str();
  }
  return wrapped(name, option->get_description(), name_columns, width_);
}

std::string examples_in_help(const std::string& command) {
  const auto found = examples().find(command);
  if (found == examples().end()) return "";
  std::string text = "Examples:";
  for (const auto& [call, comment] : found->second)
    text += fmt::format("\n  # {}\n  lightgrid {}{}{}", comment, command, *call ? " " : "", call);
  return text;
}

}  // namespace lightgrid::app
