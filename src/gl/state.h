// The context state that passes change.
#pragma once

namespace lightgrid {

// Resets everything that passes enable, mask and bind to the state of a new context. Each frame starts with
// it, so that an exception in the middle of a pass does not affect the next frame.
void reset_gl_state();

}  // namespace lightgrid
