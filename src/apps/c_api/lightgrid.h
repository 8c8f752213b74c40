/* lightgrid as a C library: scenes with very many lights rendered by each known technique, light lists,
 * visibility and measures of images. C99; docs/c_interface.md has the book's words for it,
 * docs/examples/render_c a whole program.
 *
 *   lightgrid_device* device;
 *   lightgrid_scene* scene;
 *   lightgrid_view* view;
 *   if (lightgrid_device_open(NULL, "auto", &device) || lightgrid_scene_load("hall", NULL, &scene) ||
 *       lightgrid_view_open(device, scene, NULL, NULL, &view) ||
 *       lightgrid_view_render(view, &image))
 *     fprintf(stderr, "%s\n", lightgrid_error_message());
 *
 * Errors. A function that returns lightgrid_status has done nothing if that is not LIGHTGRID_OK, and has set
 * what lightgrid_error_message() and lightgrid_error_field() return in this thread. Arguments are checked:
 * null where something is needed, sizes that do not fit, numbers that are not finite give LIGHTGRID_INPUT. A
 * pointer to freed memory, or to fewer values than its size says, cannot be noticed.
 *
 * Ownership. What a function writes through a pointer to a pointer is the caller's: a device, scene, view,
 * frame, lists or report until its own close or free function, a text until lightgrid_free. All of these take
 * null. They may go in any order: a view keeps its device and its scene alive. Memory that is handed in is
 * read or written during the call alone, never kept. A `const char*` that is returned belongs to the library.
 *
 * Threads. Any function may be called from any thread. Calls on one device, with its views, take turns; two
 * devices work at the same time, unless both draw with OpenGL, which takes turns within the process. A call
 * on a device with OpenGL leaves its thread without a current OpenGL context. A scene, lists or a report must
 * not be used in one thread while another one changes or frees it; views and comparisons use their scene. A
 * callback runs in the thread of its call, and may call nothing here but lightgrid_error_message,
 * lightgrid_error_field and lightgrid_free.
 *
 * The process. Nothing is printed (lightgrid_set_log), no environment variable set, no handler of signals
 * installed.
 *
 * Spaces and units. World space is right-handed, y up, metres; view space looks along -z. Angles are radians,
 * cones half-angles, colours linear. A matrix has 16 values, column after column, for column vectors (as
 * OpenGL and glTF). Depth is reversed in views: 1 at the near plane, 0 at the far one and where there is no
 * surface.
 *
 * Versions. Functions and structs of LIGHTGRID_0 stay as they are once lightgrid is 1.0; before that a minor
 * version may change them. */
#ifndef LIGHTGRID_H
#define LIGHTGRID_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/* INPUT: an argument or a file is wrong; the message names it, the field and the value. MACHINE: this machine
 * cannot do it, for want of a device or of memory; the message says what would help. CANCELLED: the progress
 * function asked for it. */
typedef enum lightgrid_status {
  LIGHTGRID_OK = 0,
  LIGHTGRID_INPUT = 2,
  LIGHTGRID_MACHINE = 3,
  LIGHTGRID_CANCELLED = 4
} lightgrid_status;

typedef struct lightgrid_device lightgrid_device; /* an OpenCL device, with or without an OpenGL context */
typedef struct lightgrid_scene lightgrid_scene;   /* meshes, materials, lights and cameras, in host memory */
typedef struct lightgrid_view lightgrid_view;     /* a scene on a device, drawn by one technique */
typedef struct lightgrid_frame lightgrid_frame;   /* keeps the memory of a view's image */
typedef struct lightgrid_lists lightgrid_lists;   /* a light grid, in host memory */
typedef struct lightgrid_report lightgrid_report; /* a comparison's results and images */

/* The loaded library: "0.1.0, commit 15179abf". */
const char* lightgrid_version(void);

/* The message of this thread's last failure, until its next one; one line, never null. */
const char* lightgrid_error_message(void);
/* Its subject: an argument ("image.row_bytes", "lights[3].radius_m"), a field ("light-radius"), a
 * setting ("tile") or a field of a file; empty if the message is about nothing that has a name. */
const char* lightgrid_error_field(void);

/* Frees a text. */
void lightgrid_free(char* text);

/* Notes and warnings about scenes and techniques, one line each, for the whole process; null: they are
 * dropped, as at first. `line` is valid during the call. Calls do not overlap, and may come from any thread.
 */
typedef void (*lightgrid_log_function)(int is_warning, const char* line, void* user);
/* From now on; `user` is handed to each call. */
void lightgrid_set_log(lightgrid_log_function function, void* user);

/* Called before each kernel that this process compiles for its first time on this machine, with the number of
 * such kernels so far and of those known to be needed; with 0 and 0 when none is left. Later processes load
 * these kernels from disk. For the whole process; null: no calls, as at first. Calls do not overlap, and may
 * come from any thread. */
typedef void (*lightgrid_compiling_function)(int kernels, int total, void* user);
/* From now on; `user` is handed to each call. */
void lightgrid_set_compiling(lightgrid_compiling_function function, void* user);

/* A table as JSON: "techniques" (with all settings, as `lightgrid techniques --json`), "scenes" (names and
 * summaries), "fields" (of scenes), "measures", "devices" (OpenCL's), or "warnings": [{"text", "settings",
 * "command"}] of this thread's last call that returned a status, other than of this function. settings:
 * "KEY=VALUE" each, with which the warning would not come; command: null. Reports hold their own. */
lightgrid_status lightgrid_describe(const char* table, char** json);

/* ---- Images: rows of pixels in the caller's memory ---- */

/* The contents of a pixel. */
typedef enum lightgrid_format {
  LIGHTGRID_RGBA_F32 = 0, /* four floats: linear light, alpha is coverage */
  LIGHTGRID_R_F32 = 1,    /* one float */
  LIGHTGRID_R_U32 = 2,    /* one uint32_t */
  LIGHTGRID_RGB_U8 = 3,   /* three bytes, sRGB */
  LIGHTGRID_RGBA_U8 = 4   /* four bytes, sRGB, the last one 255 */
} lightgrid_format;

/* Row 0 is the bottom row. An image that begins with its top row in memory has `pixels` at its last row and
 * negative row_bytes; nothing is copied for that. */
typedef struct lightgrid_image {
  void* pixels;            /* start of row 0 */
  int32_t width, height;   /* pixels, 1 or more */
  lightgrid_format format; /* as the function that takes the image says */
  ptrdiff_t row_bytes; /* from a row to the one above it; at least a row's pixels, or at most minus that */
} lightgrid_image;

/* The exposure, in stops, at which the logarithmic mean of the luminances becomes 0.18, to half a stop.
 * RGBA_F32. */
lightgrid_status lightgrid_exposure(const lightgrid_image* image, double* stops);
/* The picture of a PNG file: 2^stops times the linear values, the tone map, the sRGB curve. From RGBA_F32 to
 * RGB_U8. */
lightgrid_status lightgrid_srgb(const lightgrid_image* image, double stops, const lightgrid_image* picture);
/* .png: what lightgrid_srgb makes; .exr: the linear values. RGBA_F32. */
lightgrid_status lightgrid_save(const char* path, const lightgrid_image* image, double stops);
/* A measure of how far `image` is from `reference`, by its name: see lightgrid_describe("measures").
 * "flip_mean" (HDR-FLIP over exposures that follow from the reference) is NaN where half of the reference or
 * more is black. RGBA_F32. */
lightgrid_status lightgrid_measure(const lightgrid_image* image, const lightgrid_image* reference,
                                   const char* measure, double* value);
/* HDR-FLIP of each pixel, 0 (no visible difference) to 1. RGBA_F32 and RGBA_F32 to R_F32. pixels_per_degree:
 * 0 for 67. */
lightgrid_status lightgrid_flip(const lightgrid_image* image, const lightgrid_image* reference,
                                double pixels_per_degree, const lightgrid_image* map);

/* ---- Devices ---- */

/* `name`: a part of the OpenCL device's name, or "#2"; null or empty: a GPU if there is one, else the first.
 * `opengl`: "auto", "egl", "osmesa", or "none": OpenCL alone, which is enough for `visibility`, techniques
 * with raster=opencl, lists and rasterising. */
lightgrid_status lightgrid_device_open(const char* name, const char* opengl, lightgrid_device** device);
void lightgrid_device_close(lightgrid_device* device);
/* The OpenCL device's name, and the OpenGL renderer's, empty without one; valid as long as the device. Null
 * of null. */
const char* lightgrid_device_name(const lightgrid_device* device);
const char* lightgrid_device_opengl(const lightgrid_device* device);

/* ---- Scenes ---- */

/* A null-terminated array of "NAME=VALUE" is named `fields` here, or null for none. Those of a scene are the
 * command line's options of that name: size, lights, camera, lights-file, light-radius, ambient,
 * environment, shadows, virtual-lights, virtual-from, virtual-nearest, seed, brdf, time, exposure, files,
 * image-memory, texture-size, light-motion, camera-path (docs/command_line.md). */

/* `name`: a built-in scene, or the path of a .gltf or .glb file. */
lightgrid_status lightgrid_scene_load(const char* name, const char* const* fields, lightgrid_scene** scene);
/* An empty scene, for the functions below; `name` is for messages and reports. Fields apply at the first
 * view. */
lightgrid_status lightgrid_scene_create(const char* name, const char* const* fields, lightgrid_scene** scene);
void lightgrid_scene_free(lightgrid_scene* scene);

/* 8-bit RGBA, row 0 is v = 0. is_srgb: 1 for colours, 0 for data. */
lightgrid_status lightgrid_scene_add_texture(lightgrid_scene* scene, int32_t width, int32_t height,
                                             const uint8_t* rgba, int is_srgb, int32_t* number);

/* glTF's alphaMode: alpha is ignored, cuts off, or is the share that covers what is behind. */
typedef enum lightgrid_alpha {
  LIGHTGRID_OPAQUE = 0,
  LIGHTGRID_MASK = 1,
  LIGHTGRID_BLEND = 2
} lightgrid_alpha;

/* glTF's material. Maps are numbers of textures, or -1. */
typedef struct lightgrid_material {
  float base_color[4];                    /* linear, and alpha; 0 to 1 */
  float metallic, roughness;              /* 0 to 1 */
  float emissive[3];                      /* radiance, linear */
  float ior;                              /* index of refraction; 0: all is reflected */
  float clearcoat, clearcoat_roughness;   /* 0 to 1; clearcoat 0: no coat */
  lightgrid_alpha alpha;                  /* how alpha is read */
  float alpha_cutoff;                     /* with LIGHTGRID_MASK: what is below is not there */
  float normal_scale, occlusion_strength; /* strengths of the maps */
  int32_t double_sided, unlit;            /* 0 or 1 */
  int32_t base_color_map, metallic_roughness_map, normal_map, occlusion_map, emissive_map; /* or -1 */
} lightgrid_material;
/* White, rough metal, opaque, without maps: glTF's defaults. */
void lightgrid_default_material(lightgrid_material* material);
/* Writes its number, which meshes name: 0 for the first. */
lightgrid_status lightgrid_scene_add_material(lightgrid_scene* scene, const lightgrid_material* material,
                                              int32_t* number);

/* A list of triangles, counter-clockwise from the front. */
typedef struct lightgrid_mesh {
  const float* positions;  /* 3 a vertex */
  const float* normals;    /* 3 a vertex, or null: flat ones */
  const float* uv;         /* 2 a vertex, or null */
  const float* colors;     /* 4 a vertex, linear, or null */
  size_t vertex_count;     /* length of each of the arrays above */
  const uint32_t* indices; /* 3 a triangle, each below vertex_count */
  size_t index_count;      /* a multiple of 3 */
  int32_t material;        /* its number */
} lightgrid_mesh;
/* Writes its number, which instances name: 0 for the first. Without an instance it is not drawn. */
lightgrid_status lightgrid_scene_add_mesh(lightgrid_scene* scene, const lightgrid_mesh* mesh,
                                          int32_t* number);

/* world_from_object: affine; null: none. */
lightgrid_status lightgrid_scene_add_instance(lightgrid_scene* scene, int32_t mesh,
                                              const double* world_from_object, int casts_shadow,
                                              int32_t* number);
/* Moves one, also between frames of views. */
lightgrid_status lightgrid_scene_move_instance(lightgrid_scene* scene, int32_t instance,
                                               const double* world_from_object);

/* The directions in which a light shines. */
typedef enum lightgrid_light_type {
  LIGHTGRID_POINT = 0,
  LIGHTGRID_SPOT = 1,
  LIGHTGRID_DIRECTIONAL = 2,
  LIGHTGRID_VIRTUAL = 3 /* a virtual point light: emits with the cosine from its direction */
} lightgrid_light_type;

/* In world space. */
typedef struct lightgrid_light {
  double position[3];                   /* except for directional lights */
  float direction[3];                   /* for spots, directional and virtual lights; any length above 0 */
  float color[3];                       /* linear, times intensity */
  float intensity;                      /* candela, or lux of a directional light */
  float radius_m;                       /* where its light ends; infinite: nowhere */
  float inner_cone_rad, outer_cone_rad; /* for a spot: full light inside, none outside; equal: a hard edge */
  float source_radius_m;                /* radius of its sphere, for soft shadows; below 0: the setting's */
  float nearest_m;                      /* only for a virtual light */
  lightgrid_light_type type;            /* the default: LIGHTGRID_POINT */
  int32_t casts_shadow;                 /* 0 or 1 */
  uint32_t groups;                      /* lights instances that share a bit */
} lightgrid_light;
/* A white point light of one candela at the origin, without a range, a shadow or groups of its own. */
void lightgrid_default_light(lightgrid_light* light);
/* In place of all lights that the scene has. The next frame of each view has them; equally many of the same
 * types in the same order cost least. */
lightgrid_status lightgrid_scene_set_lights(lightgrid_scene* scene, const lightgrid_light* lights,
                                            size_t count);
/* Writes up to `capacity` lights, and how many there are to `count`. lights may be null if capacity is 0. */
lightgrid_status lightgrid_scene_get_lights(lightgrid_scene* scene, lightgrid_light* lights, size_t capacity,
                                            size_t* count);
/* Sets properties of a light, of those that lights files have besides the members of lightgrid_light: an object
 * as JSON, such as {"groups": ["kitchen", 7]}. Properties stay with the number of a light. Paths are relative to
 * the working directory. */
lightgrid_status lightgrid_scene_set_light_properties(lightgrid_scene* scene, size_t light, const char* json);
/* Writes the properties that differ from the default, as such an object, to be freed with lightgrid_free. */
lightgrid_status lightgrid_scene_get_light_properties(lightgrid_scene* scene, size_t light, char** json);
/* Radiance from all sides, and of pixels without a surface; three floats each, or null: as it is. */
lightgrid_status lightgrid_scene_set_ambient(lightgrid_scene* scene, const float* ambient,
                                             const float* background);

/* A view of the world, of any size in pixels. */
typedef struct lightgrid_camera {
  double world_from_view[16]; /* rigid; looks along its -z, y up */
  double fov_y_rad;           /* for a perspective camera */
  double half_height_m;       /* for an orthographic camera */
  double near_m, far_m;       /* far may be infinite in perspective */
  int32_t orthographic;       /* 0 or 1 */
} lightgrid_camera;
/* One of the scene's by name or number, or "eye:x,y,z,target:x,y,z,fov:degrees,near:metres"; null or empty:
 * the one that the scene's field `camera` chose, else the program's own choice for an image of this width
 * over height. */
lightgrid_status lightgrid_scene_camera(lightgrid_scene* scene, const char* which, double aspect,
                                        lightgrid_camera* camera);

/* ---- Views: a scene seen by one camera, drawn by one technique ---- */

/* `technique`: NAME or NAME:KEY=VALUE,…; null: forward_plus, or visibility without OpenGL. `settings`:
 * KEY=VALUE each, as --set. The camera and the size are those of the scene's fields. */
lightgrid_status lightgrid_view_open(lightgrid_device* device, lightgrid_scene* scene, const char* technique,
                                     const char* const* settings, lightgrid_view** view);
void lightgrid_view_close(lightgrid_view* view);
/* Another camera (null: the scene's) and size for the frames that follow. */
lightgrid_status lightgrid_view_look(lightgrid_view* view, const lightgrid_camera* camera, int32_t width,
                                     int32_t height);
lightgrid_status lightgrid_view_size(const lightgrid_view* view, int32_t* width, int32_t* height);
/* Draws a frame into an image of the view's size: RGBA_F32, or with the setting picture=bytes also RGBA_U8:
 * what lightgrid_srgb makes of it at the scene's exposure, made on the device. */
lightgrid_status lightgrid_view_render(lightgrid_view* view, const lightgrid_image* image);
/* Draws a frame and writes to `image` where the library has it, in place of copying it: RGBA_F32, or with the
 * setting picture=bytes RGBA_U8; row 0 at the bottom, rows without gaps. It is the memory of an OpenCL device
 * that is a CPU, if that shaded the frame, and otherwise the view's own copy. The caller may read and write
 * it until the next call of lightgrid_view_draw, _render, _profile, _look or _close with this view. `frame`,
 * unless null, gets a handle that keeps the memory: until it is freed, also after those calls, the memory can
 * be read, but after another frame of the view it may show that one. A view draws into the same memory as
 * long as its size and what its scene consists of stay. */
lightgrid_status lightgrid_view_draw(lightgrid_view* view, lightgrid_image* image, lightgrid_frame** frame);
void lightgrid_frame_free(lightgrid_frame* frame);
/* The last frame's depth of opaque surfaces (R_F32), and number of lights in each pixel's list (R_U32). */
lightgrid_status lightgrid_view_depth(lightgrid_view* view, const lightgrid_image* depth);
lightgrid_status lightgrid_view_listed(lightgrid_view* view, const lightgrid_image* counts);
/* The last frame's figures, with the times of its passes, for which it draws up to five more: what
 * `lightgrid render --json` writes, without the exposure. */
lightgrid_status lightgrid_view_profile(lightgrid_view* view, char** json);

/* ---- Light lists and visibility, for renderers of one's own ---- */

/* A view as renderers have it. */
typedef struct lightgrid_projection {
  double clip_from_view[16];  /* depth from zero to one, reversed or (for lists) standard */
  double view_from_world[16]; /* rigid; its translation is not used */
  double eye[3];              /* world */
  int32_t width, height;      /* pixels */
} lightgrid_projection;
/* That of a camera for an image of this size: reversed depth. */
lightgrid_status lightgrid_project(const lightgrid_camera* camera, int32_t width, int32_t height,
                                   lightgrid_projection* projection);

/* The lights that may reach the surfaces of each tile, as `lightgrid cull` finds them. `depth`: R_F32, of the
 * projection's size; null: needs the setting depth-bounds=none. `technique` (null: forward_plus) decides
 * whether there are slices and z-bins. Lights are numbered without directional ones, which are in no list. */
lightgrid_status lightgrid_cull(lightgrid_device* device, const lightgrid_projection* projection,
                                const lightgrid_image* depth, const lightgrid_light* lights, size_t count,
                                const char* technique, const char* const* settings, lightgrid_lists** lists);
void lightgrid_lists_free(lightgrid_lists* lists);

/* Valid as long as the lists. Cells are x fastest, then y from the bottom, then slice. */
typedef struct lightgrid_grid {
  int32_t cells_x, cells_y, slices, tile; /* tile: pixels a side */
  const uint32_t* cells;                  /* two a cell: the first of its indices, and how many */
  size_t cell_count;                      /* cells_x * cells_y * slices */
  const uint32_t* indices;                /* indices of lights, ascending in each cell */
  size_t index_count;                     /* total of all lists */
  const uint32_t* masks;    /* with grid-lists=masks: a bit a light, in mask_words words a cell; else null */
  size_t mask_words;        /* a cell */
  const uint32_t* z_bins;   /* with z-bins: a word a light; else null */
  size_t z_bin_count;       /* lights, or 0 */
  const float* slice_edges; /* metres, slices - 1 of them */
} lightgrid_grid;
/* Gives the contents of the lists; nothing is copied. */
lightgrid_status lightgrid_lists_get(const lightgrid_lists* lists, lightgrid_grid* grid);

/* The number of the nearest opaque triangle at each pixel (R_U32; 0xffffffff: none) and its depth (R_F32);
 * either may be null. Triangles are counted over instances in their order, and in each over its mesh's
 * indices. The depth of the projection is reversed. The bytes are the same on every device. */
lightgrid_status lightgrid_rasterize(lightgrid_device* device, lightgrid_scene* scene,
                                     const lightgrid_projection* projection, const lightgrid_image* triangles,
                                     const lightgrid_image* depth);

/* ---- Comparisons: techniques side by side, held against every light at every pixel and the oracle ---- */

/* Called after each step with the share that is done, 0 to 1, and the next step's name. Any value but 0 ends
 * the comparison with LIGHTGRID_CANCELLED. */
typedef int (*lightgrid_progress_function)(double done, const char* step, void* user);

/* The scene's view by each of the techniques ("NAME:KEY=VALUE,…", null-terminated; null: the command line's).
 * Fields: frames, warmup, reference, flip (1 or 0), and set and compare, which may be repeated; as `lightgrid
 * compare` has them. Without OpenGL techniques that need it are an error if they are named, and left out
 * otherwise. */
lightgrid_status lightgrid_compare(lightgrid_device* device, lightgrid_scene* scene,
                                   const char* const* techniques, const char* const* fields,
                                   lightgrid_progress_function progress, void* user,
                                   lightgrid_report** report);
void lightgrid_report_free(lightgrid_report* report);
/* The text of results.json (docs/results_json.md): the tree of all results. Valid as long as the report. Null
 * of null. */
const char* lightgrid_report_json(const lightgrid_report* report);
/* The image of one of its "rows": RGBA_F32. */
lightgrid_status lightgrid_report_image(const lightgrid_report* report, size_t row,
                                        const lightgrid_image* image);
/* Everything that `lightgrid compare -o` writes: index.html, results.json, results.csv, pictures. */
lightgrid_status lightgrid_report_save(const lightgrid_report* report, const char* folder);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
