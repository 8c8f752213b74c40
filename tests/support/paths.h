// Where this build's files are, as absolute paths. Only paths.cpp holds them: the objects of all other tests are the
// same in every checkout, and a compiler cache shares them.
#pragma once

namespace lightgrid {

extern const char* const source_folder;       // the checkout
extern const char* const test_output_folder;  // for images that a failing test leaves; made by whoever writes there
extern const char* const default_shared_folder;
extern const char* const lightgrid_program;
extern const char* const grid_digest_program;

}  // namespace lightgrid
