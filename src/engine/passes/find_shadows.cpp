// Lists of lights in tiles, by the culler, of those lights alone whose shadows the plan calls for; then a ray
// for each pixel and listed light that may shade it, or with shadows=map a look at the light's shadow map.
// docs/shadows.md has the contract.
#include "passes/find_shadows.h"

#include <fmt/format.h>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>

#include "cl/transfer.h"
#include "passes/blended_layers.h"
#include "passes/frame_stages.h"
#include "passes/shadows/bands.h"
#include "passes/shadows/kept_pairs.h"
#include "passes/shadows/shadow_lights.h"
#include "passes/shadows/shadow_lists.h"
#include "passes/shadows/triangle_numbers.h"
#include "passes/shadows/view_light_cells.h"
#include "passes/shadows/view_shadow_maps.h"
#include "plan/settings/kernels.h"
#include "plan/settings/shadows.h"
#include "plan/settings/surfaces.h"
#include "renderer/upload/lights.h"
#include "shared/shadow_bits.h"
#include "shared/shadow_records.h"

namespace lightgrid {
namespace {

// Work-groups of one tile on a GPU, which share its lights: lists are of very different lengths.
constexpr size_t groups_a_tile = 2;

constexpr size_t min_bytes = 64;  // of a buffer

const Setting<bool> shadow_reuse{
    670,
    "shadow-reuse",
    "shadows are computed in each frame, or only if the camera, a light or a surface changed",
    {{"off", false}, {"on", true}},
    {.common = true, .shown_if_given = true}};

}  // namespace

// The receivers of an image: what it shows, and what its triangles' numbers lead to.
struct ReceiverImage {
  cl::Buffer numbers, depths;
  cl::Buffer triangle_instance, number_offsets;  // null: numbers are those of rays
  bool own_hides = true;                         // lights behind a receiver's own triangle
};

class ShadowBits : public PassCache {
 public:
  explicit ShadowBits(PassContext& work) : kernels_(work, "shadows") {}

  bool follow(PassContext&) override {
    followed_ = false;
    return true;
  }

  // Whether the bits of the frame before are this frame's too. The view's next frame must then not find them.
  bool unchanged(PassContext& work) {
    unchanged_ = work.plan.shadows.needed && work.plan.settings[shadow_reuse] &&
                 !work.plan.settings[setting::everything_on] && found_for_ &&
                 (followed_ || *found_for_ == shadow_inputs(work, scene(work)));
    if (unchanged_ && work.grid().samples > 1) hand_over_rays(work);
    return unchanged_;
  }

  size_t memory_bytes() const override {
    size_t bytes = lights_.bytes() + view_.bytes() + offsets_.bytes() + blended_offsets_.bytes() +
                   masks_.bytes() + rays_.bytes() + lists_.memory_bytes();
    if (scene_) bytes += scene_->memory_bytes();
    if (maps_) bytes += maps_->memory_bytes();
    if (cells_) bytes += cells_->memory_bytes();
    return bytes + first_entries_.bytes() + banded_.memory_bytes() + kept_.memory_bytes();
  }

  // No light is hidden anywhere: the table holds no tile, and all have its empty row.
  void clear(PassContext& work) {
    work.shadows.traced.clear();
    const size_t bytes = std::max(min_bytes, shadow_table_bytes(0, shadow_table_words(work.plan)));
    if (cleared_ == bytes) return;
    fill_buffer(*work.renderer.cl, "clearing shadows", at_least(work, work.shadows.tiles, bytes, GL_RG32UI),
                0, bytes);
    at_least(work, work.shadows.bits, min_bytes, GL_R32UI);
    lists_.clear();
    layers_ = {};
    cleared_ = bytes;
    bands_ = {};
    found_for_.reset();
    kept_.forget();
    hand_over(work, bytes, min_bytes);
  }

  // The first image is that of opaque surfaces; the others are layers of blended ones, if there are any.
  void find(PassContext& work, const VisibilityBuffer* visible, const DepthBuffer& depth,
            const cl::Buffer& numbers, const BlendedTriangles* blended, const BlendedLayers& layers) {
    found_for_.reset();
    layers_ = layers;
    if (band_ == 0) {
      cleared_ = 0;
      prepare(work, visible, blended);
      if (cells_) cells_->make(work, *scene_);
    }
    std::vector<ReceiverImage> images{{numbers, visible ? visible->pixel_depth().values : depth.values,
                                       visible ? visible->raster.triangle_instance : cl::Buffer(),
                                       visible ? offsets_.buffer() : cl::Buffer()}};
    for (size_t i = 0; i < layers.numbers.size(); ++i) {
      images.push_back({layers.numbers[i], layers.depths[i],
                        blended ? blended->raster.triangle_instance : cl::Buffer(),
                        blended ? blended_offsets_.buffer() : cl::Buffer(),
                        blended_casters(work.plan.settings) == BlendedCasters::opaque});
    }
    if (band_ == 0) {
      std::vector<cl::Buffer> depths;
      for (const ReceiverImage& image : images) depths.push_back(image.depths);
      lists_.list(work, depths);
      bands_ = lists_.bands(work, room_);
      if (bands_.bands.size() > 1)
        first_entries_.put(*work.renderer.cl, "uploading bands", bands_.first_entries);
      use_kernels(work, visible);
      if (maps_) maps_->draw(*scene_);
    }
    const size_t bit_bytes =
        std::max<size_t>(min_bytes, bands_.bands[band_].entries * shadow_entry_bytes(work.plan));
    const bool keeps = keeps_pairs(work);
    if (keeps) kept_.begin(work, images.size(), room_.table_bytes + bit_bytes);
    make_room(work, bit_bytes);
    if (keeps) kept_.compare(work, arguments_of(images[0]), !visible);
    launch(work, images, bands_.bands[band_]);
    if (keeps) kept_.end();
    if (bands_.bands.size() > 1)
      again_ = [this, images](PassContext& of, const ShadowBand& band) { launch(of, images, band); };
    hand_over(work, room_.table_bytes, bit_bytes);
    if (work.grid().samples > 1) hand_over_rays(work);
    if (work.plan.settings[shadow_reuse] && bands_.bands.size() == 1)
      found_for_ = shadow_inputs(work, *scene_);
  }

  void begin_bands() { band_ = 0; }

  bool next_band(PassContext& work, const ShadedImage& image) {
    if (bands_.bands.size() < 2) return false;
    if (band_ + 1 == bands_.bands.size()) {
      banded_.restore(work, image, std::span(bands_.bands).first(band_));
      return false;
    }
    banded_.keep(work, image, bands_.bands[band_++]);
    return true;
  }

  const RayScene& scene(PassContext& work) {
    scene_ = work.gpu.in_rays(work.plan.settings[setting::texels], blended_casters(work.plan.settings));
    return *scene_;
  }

  // image: 0, of opaque surfaces; or 1 + that of a layer.
  HostShadows read(PassContext& work, size_t image = 0) {
    ClDevice& device = *work.renderer.cl;
    HostShadows shadows;
    constexpr int side = HostShadows::side;
    shadows.tiles_x = (work.grid().width + side - 1) / side;
    if (image >= lists_.images() || lists_.pairs(image) == 0) {
      shadows.cells.resize(size_t(shadows.tiles_x) * size_t((work.grid().height + side - 1) / side));
      return shadows;
    }
    HostGrid grid = lists_.read(device, image);
    shadows.cells = std::move(grid.cells);
    shadows.indices = std::move(grid.indices);
    const size_t entry_bytes = shadow_entry_bytes(work.plan);
    const auto read = [&](auto& values) {
      values.resize(shadows.indices.size() * entry_bytes / sizeof values[0]);
      read_bands(work, shadows, image, entry_bytes, reinterpret_cast<std::byte*>(values.data()));
    };
    if (work.plan.shadows.bytes) {
      read(shadows.shares);
      shadows.bits = hidden_bits(shadows.shares);
    } else
      read(shadows.bits);
    return shadows;
  }

  std::vector<HostShadowLayer> read_layers(PassContext& work) {
    std::vector<HostShadowLayer> layers = read_fragments(work, layers_);
    for (size_t i = 0; i < layers.size(); ++i) layers[i].shadows = read(work, i + 1);
    return layers;
  }

  ShadowFigures figures(PassContext& work) {
    ShadowFigures f;
    f.bytes = lists_.bytes() + work.shadows.bytes() + kept_.kept_bytes();
    if (lists_.pairs() == 0) return f;
    f.unchanged = unchanged_;
    f.lights = size_t(std::ranges::count(work.plan.shadows.shadowed, 1));
    f.bands = bands_.bands.size();
    std::vector<uint32_t> rays(parts_);
    read_buffer(*work.renderer.cl, "counting rays", rays_.get(), rays.data(), rays.size() * sizeof rays[0]);
    if (maps_) {
      f.maps = f.lights;
      f.drawn = unchanged_ ? 0 : maps_->drawn_lights();
      f.kept = f.maps - f.drawn;
      f.halvings = maps_->atlas().halvings;
      f.bytes += maps_->atlas().bytes;
    }
    if (keeps_pairs(work)) f.tiles_kept = kept_.kept_tiles(*work.renderer.cl, lists_.tiles(), unchanged_);
    if (!unchanged_) f.rays = std::accumulate(rays.begin(), rays.end(), size_t(0));
    return f;
  }

 private:
  // Buffers only grow: where both would then be too large together, other views' needs have made them so.
  void make_room(PassContext& work, size_t bit_bytes) {
    ShadowMemory& shadows = work.shadows;
    if (std::max(shadows.tiles.bytes(), room_.table_bytes) + std::max(shadows.bits.bytes(), bit_bytes) +
            kept_.kept_bytes() >
        work.plan.settings[setting::shadow_memory]) {
      shadows.tiles = {};
      shadows.bits = {};
    }
    at_least(work, shadows.tiles, room_.table_bytes, GL_RG32UI);
    at_least(work, shadows.bits, bit_bytes, GL_R32UI);
  }

  // After the bands are known.
  bool keeps_pairs(const PassContext& work) const {
    const Settings& settings = work.plan.settings;
    return settings[shadow_reuse] && !settings[setting::everything_on] && KeptPairs::serve(settings) &&
           bands_.bands.size() == 1;
  }

  static ClArguments arguments_of(const ReceiverImage& image) {
    return {{"triangles", image.numbers},
            {"triangle_instance", image.triangle_instance},
            {"number_offsets", image.number_offsets},
            {"depths", image.depths}};
  }

  // The table and the bits of these tiles.
  void launch(PassContext& work, const std::vector<ReceiverImage>& images, const ShadowBand& band) {
    ClDevice& device = *work.renderer.cl;
    // Drawn lights serve all lights of a tile.
    const size_t groups_here = kernels_.lanes || picks_shadows(work.plan.settings) ? 1 : groups_a_tile;
    parts_ = lists_.tiles() * images.size() * groups_here;
    const cl::Buffer& rays = rays_.at_least(device, parts_ * sizeof(uint32_t));
    const cl::NDRange lanes(band.tiles), groups(band.tiles * SHADOW_TILE * SHADOW_TILE, groups_here);
    ClArguments before = maps_ ? maps_->arguments() + scene_->arguments() : arguments_of_rays(work);
    if (picks_by_masks(work)) before = ClArguments{{"triangle_masks", masks_.buffer()}} + before;
    ClArguments after;
    if (bands_.bands.size() > 1)
      after = {{"first_tile", cl_uint(band.first)}, {"first_entries", first_entries_.buffer()}};
    const bool keeps = keeps_pairs(work);
    for (size_t i = 0; i < images.size(); ++i) {
      const bool may_keep = i == 0 || (images[i].triangle_instance() && kept_.has_same_receivers());
      if (keeps) after = kept_.arguments(device, lists_.tiles() * images.size(), may_keep);
      kernels_.of("find_shadows")
          .launch(device, "find_shadows", kernels_.lanes ? lanes : groups,
                  kernels_.lanes ? cl::NDRange(1) : cl::NDRange(SHADOW_TILE * SHADOW_TILE, 1),
                  before + arguments_of(images[i]) +
                      ClArguments{{"cells", lists_.cells(i)},
                                  {"indices", lists_.indices(i)},
                                  {"lights", lights_.buffer()},
                                  {"shadow_view", view_.buffer()},
                                  {"view", work.cl_lights().view.buffer()},
                                  {"image", cl_uint(i)},
                                  {"first_entry", cl_uint(lists_.first_entry(i))},
                                  {"own_hides", cl_uint(images[i].own_hides)},
                                  {"tiles", work.shadows.tiles.buffer->cl_buffer()},
                                  {"bits", work.shadows.bits.buffer->cl_buffer()},
                                  {"rays", rays}} +
                      after);
    }
  }

  // Bits, or bytes, of all of an image's entries. Only the last of several bands has its own still: they are
  // found again.
  void read_bands(PassContext& work, const HostShadows& shadows, size_t image, size_t entry, std::byte* to) {
    ClDevice& device = *work.renderer.cl;
    constexpr const char* what = "reading shadows";
    const cl::Buffer& bits = work.shadows.bits.buffer->cl_buffer();
    if (bands_.bands.size() < 2) {
      return read_buffer(device, what, bits, to, shadows.indices.size() * entry,
                         lists_.first_entry(image) * entry);
    }
    std::vector<std::byte> of_band;
    for (const ShadowBand& band : bands_.bands) {
      again_(work, band);
      of_band.resize(band.entries * entry);
      read_buffer(device, what, bits, of_band.data(), of_band.size());
      for (size_t tile = band.first; tile < band.first + band.tiles; ++tile) {
        const glm::uvec2 cell = shadows.cells[tile];
        const size_t first = bands_.first_entries[image * lists_.tiles() + tile];
        std::memcpy(to + cell.x * entry, of_band.data() + first * entry, cell.y * entry);
      }
    }
  }

  cl::Buffer& at_least(PassContext& work, SharedTexture& shared, size_t bytes, GLenum format) {
    return shared.at_least(work.renderer, bytes, format, work.plan.opengl);
  }

  void hand_over(PassContext& work, size_t tile_bytes, size_t bit_bytes) {
    if (!work.plan.opengl) return;
    const SharedBuffer::Written written[] = {{&*work.shadows.tiles.buffer, tile_bytes},
                                             {&*work.shadows.bits.buffer, bit_bytes}};
    SharedBuffer::hand_to_gl(written);
  }

  ClArguments arguments_of_rays(PassContext& work) {
    return (cells_ ? cells_->arguments(*work.renderer.cl) : ClArguments()) + scene_->arguments();
  }

  // For kernels that shade other points than pixels' centres. In each frame: other views may have made other
  // light cells.
  void hand_over_rays(PassContext& work) {
    work.shadows.traced_defines =
        " -DSHADOWS_TRACED " + scene_->defines() + (cells_ ? " -DSHADOW_CELLS" : "");
    work.shadows.traced = arguments_of_rays(work) + ClArguments{{"number_offsets", offsets_.buffer()},
                                                                {"shadow_lights", lights_.buffer()},
                                                                {"shadow_view", view_.buffer()}};
  }

  // Brings everything up to the view, its lights and surfaces.
  void prepare(PassContext& work, const VisibilityBuffer* visible, const BlendedTriangles* blended) {
    const RayScene& rays = scene(work);
    const Settings& settings = work.plan.settings;
    if (settings[setting::shadows] == ShadowMethod::map) {
      if (!maps_) maps_.emplace(work);
      if (!followed_) maps_->look(work, rays, work.plan.shadows.shadowed, settings[shadow_reuse]);
    }
    if (followed_) return;
    if (picks_by_masks(work)) put_masks(work, rays);
    ClDevice& device = *work.renderer.cl;
    const std::vector<CullLight> lights = shadowed_lights(work, shining_lights(work));
    if (!ViewLightCells::serve(work, kernels_.lanes))
      cells_.reset();
    else if (!cells_)
      cells_.emplace();
    const std::vector<ShadowLight> records = shadow_light_records(work, lights, rays.origin());
    if (cells_) cells_->look(work, records, lights);
    if (settings[shadow_reuse]) kept_.look(work, rays, records);
    lists_.look(work, lights);
    if (visible) put_offsets(work, visible->instances, offsets_);
    if (blended) put_offsets(work, blended->instances, blended_offsets_);
    lights_.put(device, "uploading lights of shadows", records);
    view_.put(device, "uploading the view of shadows",
              std::vector<ShadowView>{shadow_view(work, rays.origin())});
    followed_ = true;
  }

  static bool picks_by_masks(const PassContext& work) {
    return picks_shadows(work.plan.settings) && work.plan.masks.needed;
  }

  // Instances keep their masks; their triangles' numbers change only when the tree is rebuilt.
  void put_masks(PassContext& work, const RayScene& rays) {
    if (masked_builds_ == rays.builds()) return;
    masked_builds_ = rays.builds();
    std::vector<uint32_t> masks(std::max(rays.triangles(), 1u));
    for (size_t i = 0; i < work.scene.instances.size(); ++i) {
      const auto first = masks.begin() + rays.first_triangle(i);
      const bool last = i + 1 == work.scene.instances.size();
      std::fill(first, last ? masks.end() : masks.begin() + rays.first_triangle(i + 1),
                mask_of(work.scene.instances[i]));
    }
    masks_.put(*work.renderer.cl, "uploading masks of triangles", masks);
  }

  void put_offsets(PassContext& work, std::span<const int> instances, UploadedBuffer& to) {
    std::vector<int32_t> offsets;
    uint32_t first = 0;
    for (const int i : instances) {
      offsets.push_back(int32_t(scene_->first_triangle(size_t(i)) - first));
      first += uint32_t(work.scene.meshes[size_t(work.scene.instances[size_t(i)].mesh)].indices.size() / 3);
    }
    to.put(*work.renderer.cl, "uploading numbers of triangles", offsets);
  }

  std::string defines_of(PassContext& work, const VisibilityBuffer* visible) const {
    const Settings& settings = work.plan.settings;
    std::string defines = scene_->defines();
    for (const char* define : shadow_defines(work.plan)) defines += fmt::format(" -D{}", define);
    if (soft_shadows(settings)) defines += fmt::format(" -DSHADOW_RAYS={}", settings[setting::shadow_rays]);
    if (picks_shadows(settings)) defines += fmt::format(" -DSHADOW_PICK={}", settings[setting::shadow_pick]);
    if (picks_by_masks(work)) defines += " -DSHADOW_MASKS";
    if (!visible) defines += " -DNUMBERED";
    if (shadow_light_count(work.plan) > 65536) defines += " -DINDEX_32";
    if (work.view.orthographic) defines += " -DORTHOGRAPHIC";
    if (kernels_.lanes && settings[setting::portable]) defines += " -DPORTABLE";
    if (maps_) defines += maps_->defines();
    if (cells_) defines += " -DSHADOW_CELLS";
    return defines;
  }

  // After the bands are known.
  void use_kernels(PassContext& work, const VisibilityBuffer* visible) {
    const bool is_new = kernels_.use(defines_of(work, visible) + (bands_.bands.size() > 1 ? " -DBANDS" : "") +
                                     (keeps_pairs(work) ? " -DKEPT" : ""));
    if (is_new || !keeps_pairs(work)) kept_.forget();
  }

  PassKernels kernels_;
  std::shared_ptr<RayScene> scene_;
  std::optional<ViewShadowMaps> maps_;
  std::optional<ViewLightCells> cells_;  // null: the tree has all rays
  ShadowLists lists_;
  BlendedLayers layers_;
  UploadedBuffer lights_, view_, offsets_, blended_offsets_, first_entries_, masks_;
  GrowingBuffer rays_;
  ShadowRoom room_;
  ShadowBands bands_;  // of the frame
  size_t band_ = 0;    // that is shaded
  std::function<void(PassContext&, const ShadowBand&)>
      again_;  // finds one of several bands of the last frame
  BandedImage banded_;
  KeptPairs kept_;          // with shadow-reuse
  int masked_builds_ = -1;  // RayScene::builds of masks_
  size_t parts_ = 0;        // counts of rays
  size_t cleared_ = 0;      // bytes of tiles in which nothing was found since they were cleared
  std::optional<ShadowInputs> found_for_;  // what the bits were found for, with shadow-reuse
  bool followed_ = false, unchanged_ = false;
};

namespace {

const cl::Buffer& triangle_numbers_in_cl(PassContext& work, const RayScene& rays) {
  auto pass = work.timer.pass("triangle_numbers", "gl");
  const TriangleImage drawn = draw_triangle_numbers(work, rays);
  SharedBuffer& copy = work.shared_samples("triangle numbers", 4);
  const size_t bytes = work.grid().values() * 4;
  work.renderer.pixel_copies.to_buffer({drawn.framebuffer, GL_COLOR_ATTACHMENT0, drawn.image}, GL_RED_INTEGER,
                                       GL_UNSIGNED_INT, work.grid(), copy.gl_buffer());
  copy.hand_to_cl(bytes);
  pass.moves(work.gpu.in_gl().geometry_bytes() + bytes, 2 * bytes);
  return copy.cl_buffer();
}

}  // namespace

void find_shadows(PassContext& work, PassCaches& caches, const VisibilityBuffer* visible,
                  const DepthBuffer& depth, const BlendedTriangles* blended) {
  if (!work.plan.shadows.light_reaches) return;
  ShadowBits& shadows = caches.shadow_bits.of(work);
  work.shadows.layer_count = 0;
  if (!work.plan.shadows.needed) return shadows.clear(work);
  const RayScene& rays = shadows.scene(work);
  const cl::Buffer& numbers = visible ? visible->triangles().numbers : triangle_numbers_in_cl(work, rays);
  if (!visible && work.plan.surfaces.blend) {
    work.shadows.first_triangles.assign(work.scene.instances.size(), 0);
    for (const int i : work.plan.surfaces.blended)
      work.shadows.first_triangles[size_t(i)] = rays.first_triangle(size_t(i));
  }
  const BlendedLayers layers = find_layers(work, caches.fragment_layers, blended, depth);
  auto pass = work.timer.pass("find_shadows", "cl");
  shadows.find(work, visible, depth, numbers, blended, layers);
  pass.moves(work.grid().pixels() * 8 + layers.bytes + rays.memory_bytes(), work.shadows.bytes());
}

bool shadows_are_unchanged(PassContext& work, Cached<ShadowBits>& cache) {
  return work.plan.shadows.light_reaches && cache.of(work).unchanged(work);
}

static void begin_bands(PassContext& work, PassCaches& caches) {
  if (work.plan.shadows.light_reaches) caches.shadow_bits.of(work).begin_bands();
}

// Shadows that take more memory than the setting shadow-memory allows are found in several bands of tiles,
// and the frame is shaded once for each. Each time the band's pixels of its image are kept.
static bool next_band(PassContext& work, PassCaches& caches, ShadedImage& image) {
  return work.plan.shadows.light_reaches && caches.shadow_bits.of(work).next_band(work, image);
}

// The frame gets shadows and their figures if its light loops read them.
static void add_readers(PassContext& work, PassCaches& caches, Frame& frame) {
  if (!work.plan.shadows.light_reaches) return;
  ShadowBits& shadows = caches.shadow_bits.of(work);
  if (!frame.lights_in_volume && !frame.shadows) frame.shadows = [&] { return shadows.read(work); };
  frame.blended_shadows = [&] { return shadows.read_layers(work); };
  frame.shadow_figures = [&, own = frame.shadow_figures] {
    ShadowFigures figures = shadows.figures(work);
    if (own) figures += own();
    return figures;
  };
}

extern const FrameStage shadow_stage{.begin = begin_bands, .shaded = next_band, .end = add_readers};

}  // namespace lightgrid
