// Is told that a set does not exist.
#include <stdexcept>

#include "ms_io/measurement_set.h"

int main() {
  try {
    misfit::ms_io::MeasurementSet("no such set", {}, "DATA");
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 1;
}
