// Models with Q, U and V.
#include <boost/test/unit_test.hpp>
#include <random>

#include "ms_io/model_writer.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(stokes_response)

using namespace testing;

namespace {

using casacore::Complex;
using Values = std::vector<std::complex<double>>;

/// Numbers of which single precision holds any sum and difference exactly.
StokesVisibilities polarised(const imager::SampleCoordinates& where) {
  std::mt19937 random(3);
  StokesVisibilities model;
  for (Values& plane : model.plane)
    for (std::size_t s = 0; s < where.samples(); ++s)
      plane.emplace_back(static_cast<int>(random() % 999) - 500, static_cast<int>(random() % 999) - 500);
  return model;
}

const std::vector<int> linear{9, 10, 11, 12}, circular{5, 6, 7, 8}, stokes{1, 2, 3, 4};

}  // namespace

BOOST_AUTO_TEST_CASE(every_correlation_gets_what_the_stokes_parameters_are_to_it) {
  const std::complex<double> i(0, 1);
  for (const std::vector<int>& types : {linear, circular, stokes, {12, 9}, {6}, {5, 8}}) {
    const SmallSet set;
    set.store_correlations(types);
    StokesVisibilities model;  // of all rows at once
    write_model(set.path(), {}, {"MODEL_DATA"}, [&](const auto& where) { return model = polarised(where); }, {});
    write_model(set.path(), {}, {"LEFT", "DATA"}, polarised, {});
    for (std::size_t r = 0; r < rows; ++r) {
      const auto cell = set.cell("MODEL_DATA", r), left = set.cell("LEFT", r), data = set.cell("DATA", r);
      for (std::size_t c = 0; c < channels; ++c) {
        const auto s = [&](std::size_t k) { return model.plane[k][r * channels + c]; };
        const std::map<int, std::complex<double>> expected = {{1, s(0)},
                                                              {2, s(1)},
                                                              {3, s(2)},
                                                              {4, s(3)},
                                                              {5, s(0) + s(3)},
                                                              {6, s(1) + i * s(2)},
                                                              {7, s(1) - i * s(2)},
                                                              {8, s(0) - s(3)},
                                                              {9, s(0) + s(1)},
                                                              {10, s(2) + i * s(3)},
                                                              {11, s(2) - i * s(3)},
                                                              {12, s(0) - s(1)}};
        for (std::size_t k = 0; k < types.size(); ++k) {
          const Complex value(expected.at(types[k]));
          BOOST_TEST((cell(k, c) == value && left(k, c) == data(k, c) - value));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(planes_that_are_not_given_count_as_zero) {
  const SmallSet set;
  set.store_correlations(linear);
  const auto only_i_and_u = [](const imager::SampleCoordinates& where) {
    StokesVisibilities model = polarised(where);
    model.plane[1].clear();
    model.plane[3].clear();
    return model;
  };
  const auto with_zeros = [](const imager::SampleCoordinates& where) {
    StokesVisibilities model = polarised(where);
    model.plane[1].assign(where.samples(), 0);
    model.plane[3].assign(where.samples(), 0);
    return model;
  };
  write_model(set.path(), {}, {"EMPTY"}, only_i_and_u, {});
  write_model(set.path(), {}, {"ZERO"}, with_zeros, {});
  for (std::size_t r = 0; r < rows; ++r) {
    BOOST_TEST(set.cell("EMPTY", r).tovector() == set.cell("ZERO", r).tovector(), boost::test_tools::per_element());
  }
}

BOOST_AUTO_TEST_CASE(planes_of_the_wrong_size_are_refused) {
  const SmallSet set;
  const auto short_v = [](const imager::SampleCoordinates& where) {
    StokesVisibilities model = polarised(where);
    model.plane[3].pop_back();
    return model;
  };
  BOOST_CHECK_THROW(write_model(set.path(), {}, {"MODEL_DATA"}, short_v, {}), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
