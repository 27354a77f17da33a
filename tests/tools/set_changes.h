#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace misfit::tools::testing {

/// What tests do to simulated MeasurementSets of XX and YY, in their first channel where none is named. Apart because casacore
/// needs C++17.
void put_data(const std::string& set, std::size_t row, std::complex<float> value);  ///< in XX
void put_weight(const std::string& set, std::size_t row, float value);              ///< in XX
void put_weights(const std::string& set, float value);                              ///< in all of WEIGHT
void put_u(const std::string& set, std::size_t row, double u_m);
void flag_sample(const std::string& set, std::size_t row);                              ///< in XX
void flag_channel(const std::string& set, std::size_t channel, std::size_t first_row);  ///< from that row on
void flag_row(const std::string& set, std::size_t row);
void flag_all(const std::string& set);
void name_all(const std::string& set, const std::string& name);  ///< fields, telescopes, observers and antennas
/// Adds a field that points and is phased to a direction in J2000, and gives it the rows from `first_row` on, every second.
struct AddedField {
  std::string name;
  double ra_rad = 0;
  double dec_rad = 0;
  std::size_t first_row = 1;
};
void add_field(const std::string& set, const AddedField& field);
/// Where its antennas point, in J2000; where it is phased to stays as it is.
void point_field(const std::string& set, std::size_t field, double ra_rad, double dec_rad);
void forget_pointing(const std::string& set, std::size_t field);  ///< leaves an empty REFERENCE_DIR
/// Gives every second row a feed 1, whose beam points beside that of feed 0 by so much.
void add_feed(const std::string& set, double x_rad, double y_rad);
void name_telescope(const std::string& set, const std::string& name);
void set_dish_diameters(const std::string& set, double diameter_m);
void make_autocorrelation(const std::string& set, std::size_t row);
void scale_data(const std::string& set, float factor);
void scale_uvw(const std::string& set, double factor);

/// Copies a set with its rows in another order.
void shuffle_rows(const std::string& set, const std::string& copy, unsigned seed);

/// A set that this process has locked for writing, as one that flags or calibrates it does.
class LockedSet {
 public:
  explicit LockedSet(const std::string& set);
  ~LockedSet();

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

/// Makes a set of other correlations, given by casacore's codes, with data of 0 and weights of 1.
void store_correlations(const std::string& set, const std::vector<int>& types);

/// All of a column, [row][correlation].
std::vector<std::complex<float>> visibilities(const std::string& set, const std::string& column);

}  // namespace misfit::tools::testing
