#include "support/paths.h"

namespace lightgrid {

const char* const source_folder = LIGHTGRID_SOURCE_DIR;
const char* const test_output_folder = LIGHTGRID_TEST_OUTPUT_DIR;
const char* const default_shared_folder = LIGHTGRID_SHARED_DIR;
const char* const lightgrid_program = LIGHTGRID_PROGRAM;
const char* const grid_digest_program = LIGHTGRID_GRID_DIGEST;
const char* const no_opengl_library = LIGHTGRID_NO_OPENGL;

}  // namespace lightgrid
