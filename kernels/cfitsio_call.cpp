#include "kernels/cfitsio_call.h"

#include <clocale>

namespace misfit::kernels {
namespace {

std::mutex& mutex() {
  static std::mutex mutex;
  return mutex;
}

locale_t classic() {
  static const locale_t locale = newlocale(LC_ALL_MASK, "C", nullptr);
  return locale;
}

}  // namespace

CfitsioCall::CfitsioCall() : lock_(mutex()), before_(uselocale(classic())) {}

CfitsioCall::~CfitsioCall() {
  uselocale(static_cast<locale_t>(before_));
}

}  // namespace misfit::kernels
