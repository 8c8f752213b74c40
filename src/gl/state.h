// The state of a context that passes change.
#pragma once

namespace lightgrid {

// Sets what passes enable, mask and bind back to what a new context has. A frame begins with it: what an exception in the
// middle of a pass left behind is not the next frame's.
void reset_gl_state();

}  // namespace lightgrid
