#pragma once

#include <mutex>

namespace misfit::kernels {

/// Code that calls CFITSIO holds one of these during the call. It keeps other threads out of CFITSIO, whose builds need not be
/// thread-safe, and gives numbers decimal points, whatever the program's locale: CFITSIO remembers the first point it sees.
class CfitsioCall {
 public:
  CfitsioCall();
  CfitsioCall(const CfitsioCall&) = delete;
  CfitsioCall& operator=(const CfitsioCall&) = delete;
  ~CfitsioCall();

 private:
  std::lock_guard<std::mutex> lock_;
  void* before_;  ///< the thread's locale
};

}  // namespace misfit::kernels
