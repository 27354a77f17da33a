#pragma once

#include <mutex>

namespace misfit::kernels {

/// Whoever calls CFITSIO has one of these meanwhile. No other thread calls it then, since builds of it need not be safe in
/// threads; and numbers have decimal points, whatever the locale of the program: CFITSIO remembers the first that it sees.
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
