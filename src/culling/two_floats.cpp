#include "culling/two_floats.h"

namespace lightgrid {

TwoFloats two_floats(double number) {
  const float value = float(number);
  return {value, float(number - double(value))};
}

}  // namespace lightgrid
