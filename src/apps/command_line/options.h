// The options that every subcommand on a scene shares (docs/command_line.md).
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "command_line/command_line.h"
#include "run/scene_choice.h"

namespace lightgrid::app {

void add_scene_options(Subcommand& command, SceneChoice& choice);
void add_file_options(Subcommand& command, SceneChoice& choice);     // options of reading a glTF file
void add_view_options(Subcommand& command, SceneChoice& choice);     // all but scene, size and lights
void add_keep_option(Subcommand& command, std::string& keep);        // for commands with several --lights
void add_exposure_option(Subcommand& command, SceneChoice& choice);  // for commands that write pictures
void add_path_option(Subcommand& command, SceneChoice& choice);
void add_device_options(Subcommand& command, DeviceOptions& options);
void add_timing_options(Subcommand& command, TimingOptions& options);
// One technique; its own settings are for take_own_settings (compare/contestants.h).
void add_technique_option(Subcommand& command, std::string& technique, const std::string& what);

// Throws Error(input) if the file `path`, given by `option`, could not be created: its folder is missing, not
// a folder or not writable, or it is a folder itself. Call it before long work; "-" is always valid.
void check_output_file(const std::string& option, const std::filesystem::path& path);
// The same for several, each an option and its file, or none; at most one of them goes to stdout.
void check_output_files(std::initializer_list<std::pair<const char*, std::string>> files);

// Makes the folder, and does the work. If that throws, a folder that is new is removed with what was written
// into it.
int with_output_folder(const std::filesystem::path& folder, const std::function<int()>& work);

// Writes JSON text to a file, or to stdout for "-".
void write_json(const std::string& destination, const std::string& text);

}  // namespace lightgrid::app
