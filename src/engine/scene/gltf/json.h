// Prepares the JSON of a glTF file for tinygltf, which does not check everything.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/extras.h"

namespace lightgrid::gltf {

struct BufferEntry {
  std::string uri;  // empty: the binary chunk, or no bytes at all
  size_t byte_length = 0;
  bool fallback = false;  // EXT_meshopt_compression: its views are decoded from other buffers
};

struct ImageEntry {
  std::string name, uri;
  int view = -1;               // buffer view; -1: uri
  std::optional<Error> fault;  // thrown if the image is used
  // An image that is made of one of the file: green is its roughness, 1 - glossiness * alpha.
  struct Roughness {
    int image = 0;
    float glossiness = 1;
  };
  std::optional<Roughness> roughness = std::nullopt;
};

struct AnimationEntry {
  struct Sampler {
    int input = -1, output = -1;  // accessors; -1: absent
    std::string interpolation = "LINEAR";
  };
  struct Channel {
    int sampler = -1, node = -1;  // -1: absent
    std::string path;
    std::string pointer;  // KHR_animation_pointer
  };
  std::string name;
  std::vector<Sampler> samplers;
  std::vector<Channel> channels;
  std::optional<Error> fault;  // fault of its JSON, which then is not read to its end
};

struct PreparedJson {
  std::string text;  // for tinygltf: no buffers, images, animations, extras or unsupported extensions
  std::vector<BufferEntry> buffers;
  std::vector<ImageEntry> images;
  std::vector<AnimationEntry> animations;
  Extras extras;
  // tinygltf rejects indices without a buffer view, which Draco and sparse accessors may have: those
  // accessors get this index, one past the end of the file's own views.
  int absent_view = 0;
};

// Checks nesting, that collections are arrays of objects, and that every index is an integer in [0, 2^31).
// Numbers such as 3.0 become integers, and integers past 32 bits (which tinygltf would wrap) become doubles.
// Removes animations, buffers and images: tinygltf checks animations less than the rest, reads buffers and
// images all at once, keeps copies, requires exact file sizes, does not support fallback buffers and reads a
// view's bytes unchecked.
PreparedJson prepare_json(Reporter& report, std::string_view text);

bool is_supported_extension(std::string_view name);

// Returns whether a file that requires this extension looks the same without it: metadata, sound, physics,
// and extensions whose default is the file without them.
bool keeps_the_picture(std::string_view extension);

}  // namespace lightgrid::gltf
