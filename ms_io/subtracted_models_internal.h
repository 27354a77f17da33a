#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <string>
#include <vector>

#include "ms_io/model_witness_internal.h"
#include "ms_io/model_writer.h"

namespace misfit::ms_io {

/// A model that a complete run subtracted from some of the data of a column.
struct SubtractedModel {
  std::string model;      ///< a fingerprint; "-" where it is not known
  std::string selection;  ///< a fingerprint of the rows, channels and coordinates
  std::string command;    ///< that subtracted it, as people are told, with its selection
};

/// The models that the data of a column lack, the first first, as a file `misfit_subtracted_<COLUMN>` in the folder of each
/// table that holds the rows says; casacore knows nothing of it. None where another program has written all of the column
/// since.
std::vector<SubtractedModel> subtracted_models(const casacore::MeasurementSet& set, const std::string& column);

/// Replaces the record of `column`; without models the record is removed. A record holds until another program changes all
/// witnesses, or for ever where there are none. Throws std::runtime_error that names the file.
void write_subtracted_models(const casacore::MeasurementSet& set, const std::string& column,
                             const std::vector<SubtractedModel>& models, const std::vector<Witness>& witnesses);

/// "the model of misfit predict --subtract --model a.fits has already been subtracted from CORRECTED_DATA of `path`".
std::string lacks_already(const std::string& path, const std::string& column, const SubtractedModel& model);

}  // namespace misfit::ms_io
