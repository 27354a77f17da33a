#include "imager/numerics/instruction_set.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/numerics/instruction_set.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

/// The name is chosen among the sets as every loop is.
const char* name_of_target() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(name_of_target);

std::string instruction_set() {
  return HWY_DYNAMIC_DISPATCH(name_of_target)();
}

std::string highway_version() {
  return std::to_string(HWY_MAJOR) + '.' + std::to_string(HWY_MINOR) + '.' + std::to_string(HWY_PATCH);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
