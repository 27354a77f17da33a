#pragma once

#include <casacore/casa/Utilities/DataType.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ms_io/stored_bytes_internal.h"

namespace misfit::ms_io {

/// Bits that a value of one of casacore's DataType takes in a file; for a text, the bits of the length before it.
std::uint64_t bits_of(std::uint64_t data_type);

/// Reads a type; throws std::runtime_error where casacore has no such.
casacore::DataType read_type(ObjectReader& in);

/// How many values an array of a shape has; throws std::runtime_error where they cannot be in what is left.
double check_values(const ObjectReader& in, const std::vector<std::int64_t>& shape, casacore::DataType type);

/// Goes past a value, and past an array of them, which begins with its shape.
void skip_value(ObjectReader& in, casacore::DataType type);
void skip_array(ObjectReader& in, casacore::DataType type);

/// Reads a record, with those in it, as casacore does, and returns the names of the tables that it holds. Throws as
/// ObjectReader does, and std::runtime_error where it states types that no record has, over which casacore ends the program, or
/// records nested beyond any use.
std::vector<std::string> read_record(ObjectReader& in);

}  // namespace misfit::ms_io
