// Absolute paths of this build's files. Only paths.cpp contains them: the objects of all other tests are the
// same in every checkout, and a compiler cache shares them.
#pragma once

namespace lightgrid {

extern const char* const source_folder;       // the checkout
extern const char* const test_output_folder;  // for images of failing tests; created by the writer
extern const char* const default_shared_folder;
extern const char* const lightgrid_program;
extern const char* const grid_digest_program;
extern const char* const no_opengl_library;  // support/no_opengl.cpp

}  // namespace lightgrid
