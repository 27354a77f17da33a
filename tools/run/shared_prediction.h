#pragma once

#include <memory>

#include "ms_io/model_writer.h"

namespace misfit::tools {

/// Visibilities that ranks predict in turns: rank 0 reads where samples lie, sends blocks of them to the other ranks, which
/// have the same model, and writes the visibilities.
class SharedPrediction {
 public:
  /// `own` predicts on this rank. Both arguments are kept by reference.
  SharedPrediction(const imager::Ranks& ranks, const ms_io::Predict& own);
  ~SharedPrediction();

  /// On rank 0: predicts a block on whichever rank is free. As many threads as there are ranks may call it at a time.
  ms_io::StokesVisibilities predict(const imager::SampleCoordinates& where);
  /// On rank 0: the others stop following.
  void end();
  /// On the others: predicts what rank 0 sends, until it tells of the end.
  void follow();

 private:
  class FreeRanks;

  const imager::Ranks& ranks_;
  const ms_io::Predict& own_;
  std::unique_ptr<FreeRanks> free_;
};

}  // namespace misfit::tools
