// Which lights' shadows each tile of an image needs: lists by a culler of their own, for the image of opaque
// surfaces and for each layer of blended ones.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "culling/light_culler.h"
#include "passes/shadows/bands.h"

namespace lightgrid {

class ShadowLists {
 public:
  // After the view or the lights changed. lights: as shadowed_lights has them.
  void look(PassContext& work, const std::vector<CullLight>& lights);
  // Lists between the depths of each image's tiles. Throws Error(machine) past 2^32 pairs.
  void list(PassContext& work, std::span<const cl::Buffer> depths);
  void clear() { images_.clear(); }

  size_t images() const { return images_.size(); }  // 0: nothing was listed
  size_t tiles() const;                             // tiles of one image
  size_t pairs() const;                             // pairs of a tile and a light, of all images
  size_t bytes() const;                             // bytes of the lists
  size_t memory_bytes() const { return bytes() + (culler_ ? culler_->memory_bytes() : 0); }

  const cl::Buffer& cells(size_t image) {
    return images_[image]->storage.cells(images_[image]->grid.cell_bytes);
  }
  const cl::Buffer& indices(size_t image) {
    return images_[image]->storage.indices(images_[image]->grid.index_bytes);
  }
  size_t pairs(size_t image) const { return images_[image]->grid.index_count; }
  size_t first_entry(size_t image) const { return images_[image]->first_entry; }  // where there is one band
  HostGrid read(ClDevice& device, size_t image);

  // How the frame's shadows fit into memory, and how much of it a band takes. All images' shadows of a tile
  // are in the same band.
  ShadowBands bands(PassContext& work, ShadowRoom& room);

 private:
  struct Image {
    ClGridStorage storage;
    LightGrid grid{};
    size_t first_entry = 0;
    explicit Image(ClDevice& device) : storage(device) {}
  };

  std::optional<LightCuller> culler_;
  std::vector<CullLight> lights_;  // in the culler
  std::vector<std::unique_ptr<Image>> images_;
};

}  // namespace lightgrid
