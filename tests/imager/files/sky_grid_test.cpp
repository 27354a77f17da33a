#include "imager/files/sky_grid.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

BOOST_AUTO_TEST_SUITE(sky_grid)

namespace {

using namespace misfit::imager;

constexpr double degree = M_PI / 180, arcsec = degree / 3600;

const std::vector<ImageGeometry> images{
    {8, 6, 1e-6, {3.2, -0.2, "FK5"}},
    {7, 5, 1e-6, {3.2, -0.2, "ICRS"}},
    {101, 100, 5e-3, {6.2, 0.7, "FK5"}},
    {6, 9, 1e-5, {0.001, 1.2, "FK5"}, {0.1, -0.07}},
    {64, 65, 1e-4, {1.5, 90 * degree - 1e-3, "FK5"}},
    {9, 8, 1e-4, {1.5, 90 * degree, "ICRS"}},
    {9, 8, 1e-4, {4, -90 * degree, "FK4"}},
    {9, 8, 1e-4, {4, 0.5, "FK5"}, {}, 1.5},
};

/// The largest distance of a pixel from where `expected(row, column)` has it, pixels.
template <typename Expected>
double farthest(const GridMap& map, const ImageGeometry& g, const Expected& expected) {
  double most = 0;
  for (int row = 0; row < g.height; ++row)
    for (int column = 0; column < g.width; ++column) {
      const PixelPlace is = map(row, column), should = expected(row, column);
      most = std::max(most, std::hypot(is.column - should.column, is.row - should.row));
    }
  return most;
}

/// Rounding of cosines near 1, 2e-16, a few times over, in pixels.
double rounding(const ImageGeometry& g) {
  return 2e-15 / g.cell_rad + 1e-10;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_image_lies_on_its_own_grid) {
  for (const ImageGeometry& g : images)
    BOOST_TEST(farthest(GridMap(g, grid_of(g)), g, [](int row, int column) {
                 return PixelPlace{double(column), double(row)};
               }) < rounding(g));
}

BOOST_AUTO_TEST_CASE(pixels_move_with_the_reference_pixel) {
  for (const ImageGeometry& g : images)
    for (const auto& [right, up] : {std::pair(10.0, 0.0), {-3.0, 7.0}, {0.25, -1e4}}) {
      SkyGrid grid = grid_of(g);
      grid.reference_pixel.column += right;
      grid.reference_pixel.row += up;
      BOOST_TEST(farthest(GridMap(g, grid), g, [right = right, up = up](int row, int column) {
                   return PixelPlace{column + right, row + up};
                 }) < rounding(g) + 1e-11);
    }
}

BOOST_AUTO_TEST_CASE(directions_lie_as_far_from_the_reference_as_projections_are_defined) {
  const ImageGeometry g{61, 60, 1.0 / 32, {2, 0.4, "FK5"}};  // to 70 degrees along the axes, and beyond the horizon
  const auto radius = [](Projection projection, double psi) {
    switch (projection) {
      case Projection::sin:
        return std::sin(psi);
      case Projection::tan:
        return std::tan(psi);
      case Projection::stg:
        return 2 * std::tan(psi / 2);
      case Projection::arc:
        return psi;
      case Projection::zea:
        return 2 * std::sin(psi / 2);
    }
    return std::nan("");
  };
  for (const char* name : {"SIN", "TAN", "STG", "ARC", "ZEA"}) {
    SkyGrid grid = grid_of(g);
    grid.projection = projection_named(name).value();
    BOOST_TEST(projection_name(grid.projection) == name);
    const GridMap map(g, grid);
    for (int row = 0; row < g.height; ++row)
      for (int column = 0; column < g.width; ++column) {
        const DirectionCosines at = g.at(row, column);
        const PixelPlace place = map(row, column);
        const double sine = std::hypot(at.l, at.m);
        if (sine >= 1) {
          BOOST_TEST(std::isnan(place.column));
          continue;
        }
        const double stretch = sine > 0 ? radius(grid.projection, std::asin(sine)) / sine : 1;
        BOOST_TEST(std::abs(place.column - (grid.reference_pixel.column - stretch * at.l / g.cell_rad)) < 1e-9 * stretch);
        BOOST_TEST(std::abs(place.row - (grid.reference_pixel.row + stretch * at.m / g.cell_rad)) < 1e-9 * stretch);
      }
  }
  BOOST_TEST(!projection_named("SFL").has_value());
}

BOOST_AUTO_TEST_CASE(a_slant_adds_its_part_of_one_minus_n) {
  const ImageGeometry g{21, 20, 1.0 / 64, {2, 0.4, "FK5"}};
  SkyGrid grid = grid_of(g);
  grid.slant = {0.3, -1.2};
  const double rounded = rounding(g);
  BOOST_TEST(farthest(GridMap(g, grid), g, [&](int row, int column) {
               const double dropped = -n_minus_1(g.at(row, column)) / g.cell_rad;
               return PixelPlace{column - 0.3 * dropped, row - 1.2 * dropped};
             }) < rounded);
}

BOOST_AUTO_TEST_CASE(a_frame_that_is_turned_about_the_pole_only_counts_right_ascension_anew) {
  for (const ImageGeometry& g : images) {
    const double later = 0.7;
    SkyGrid grid = grid_of(g);
    grid.reference.ra_rad += later;
    const SkyDirection a{1, 0.2, "FK5"}, b{2, -0.3, "FK5"};
    const FrameRotation rotation =
        rotation_between({a, b}, {SkyDirection{a.ra_rad + later, a.dec_rad, ""}, {b.ra_rad + later, b.dec_rad, ""}});
    BOOST_TEST(farthest(GridMap(g, grid, rotation), g, [](int row, int column) {
                 return PixelPlace{double(column), double(row)};
               }) < rounding(g));
  }
}

BOOST_AUTO_TEST_CASE(the_other_side_of_the_sky_has_no_place) {
  const ImageGeometry g{8, 6, 1e-3, {3.2, -0.2, "FK5"}};
  SkyGrid grid = grid_of(g);
  grid.reference = {3.2 - M_PI, 0.2, "FK5"};
  for (const Projection projection : {Projection::sin, Projection::tan, Projection::arc, Projection::zea, Projection::stg}) {
    grid.projection = projection;
    BOOST_TEST(std::isnan(GridMap(g, grid)(g.centre_row(), g.centre_column()).column));
  }
}

BOOST_AUTO_TEST_CASE(a_pole_at_another_native_longitude_turns_the_axes) {
  // x' = R sin φ and y' = −R cos φ: where the celestial pole lies at φ, north is towards (sin φ, −cos φ).
  for (const double pole_deg : {180.0, 0.0, 90.0, -30.0, 211.5}) {
    SkyGrid grid = grid_of({9, 9, 1e-3, {1, 0.3, "FK5"}});
    const double sine = std::sin(pole_deg * degree), cosine = std::cos(pole_deg * degree);
    // Rows count up towards the native longitude of the pole, where north is.
    grid.step = {{{cosine * 1e-3, sine * 1e-3}, {sine * 1e-3, -cosine * 1e-3}}};
    set_pole(grid, pole_deg * degree);
    BOOST_TEST(upright_geometry(grid).off_pixels < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(the_grid_of_an_image_is_that_image) {
  for (const ImageGeometry& g : images) {
    if (g.pixel_aspect != 1) continue;
    const UprightGeometry upright = upright_geometry(grid_of(g));
    BOOST_TEST(upright.difference == "");
    BOOST_TEST(upright.off_pixels < rounding(g));
    BOOST_TEST((upright.geometry.width == g.width && upright.geometry.height == g.height));
    BOOST_TEST(upright.geometry.cell_rad == g.cell_rad);
    BOOST_TEST(std::abs(upright.geometry.centre.l - g.centre.l) < 1e-15);
    BOOST_TEST(std::abs(upright.geometry.centre.m - g.centre.m) < 1e-15);
    BOOST_TEST(upright.geometry.phase_centre.frame == g.phase_centre.frame);
  }
}

BOOST_AUTO_TEST_CASE(another_projection_is_as_far_from_an_image_as_its_farthest_corner) {
  for (const double cell_arcsec : {0.01, 0.1, 1.0, 10.0, 60.0})
    for (const int size : {16, 128, 1024}) {
      const ImageGeometry g{size, size, cell_arcsec * arcsec, {1, 0.3, "FK5"}};
      SkyGrid grid = grid_of(g);
      grid.projection = Projection::tan;
      const double sine = std::hypot(g.l(0), g.m(0));  // of the farthest corner
      const double moved = (std::tan(std::asin(sine)) - sine) / g.cell_rad;
      const UprightGeometry upright = upright_geometry(grid);
      BOOST_TEST(std::abs(upright.off_pixels - moved) < rounding(g) + 1e-6 * moved);
      BOOST_TEST(upright.difference == (moved > 1e-9 ? "its projection is TAN; expected SIN" : ""));
      const auto open = [&] { return geometry_on(grid, Grids::upright, g); };
      if (moved < same_place_pixels)
        BOOST_TEST(open().width == size);
      else
        BOOST_CHECK_THROW(open(), std::invalid_argument);
    }
}

BOOST_AUTO_TEST_CASE(no_pixel_lies_farther_from_the_geometry_of_a_grid_than_is_told) {
  const ImageGeometry g{65, 48, 20 * arcsec, {1, 0.3, "FK5"}, {3e-3, -2e-3}};
  const auto check = [&](const auto& change) {
    SkyGrid grid = grid_of(g);
    change(grid);
    const UprightGeometry upright = upright_geometry(grid);
    const double is = farthest(GridMap(upright.geometry, grid), g, [](int row, int column) {
      return PixelPlace{double(column), double(row)};
    });
    BOOST_TEST(is < upright.off_pixels * (1 + 1e-6) + rounding(g));
    BOOST_TEST(is > 0.3 * upright.off_pixels - rounding(g));  // two may lie in other directions
    BOOST_TEST((upright.difference == "") == (upright.off_pixels < 1e-9));
    return upright.off_pixels;
  };
  for (const double size : {1e-9, 1e-7, 1e-5}) {
    BOOST_TEST(check([&](SkyGrid& grid) { set_pole(grid, M_PI + size); }) > 30 * size);
    BOOST_TEST(check([&](SkyGrid& grid) { grid.step[0][1] += size * g.cell_rad; }) > 20 * size);
    BOOST_TEST(check([&](SkyGrid& grid) { grid.slant = {size, -3 * size}; }) > 0.01 * size);
    // Cells of other sizes, and a reference elsewhere, are an image's own.
    BOOST_TEST(check([&](SkyGrid& grid) { grid.step[1][1] *= 1 + size; }) < rounding(g));
    BOOST_TEST(check([&](SkyGrid& grid) {
                 for (auto& steps : grid.step)
                   for (double& step : steps) step *= 1 + size;
               }) < rounding(g));
    BOOST_TEST(check([&](SkyGrid& grid) { grid.reference_pixel.column += size; }) < rounding(g));
  }
}

BOOST_AUTO_TEST_CASE(what_no_image_has_is_named_with_its_value) {
  const ImageGeometry g{64, 48, 2 * arcsec, {1, 0.3, "FK5"}};
  const auto difference = [&](const auto& change) {
    SkyGrid grid = grid_of(g);
    change(grid);
    return upright_geometry(grid).difference;
  };
  const auto has = [](const std::string& text, const std::string& part) {
    BOOST_TEST_INFO(text);
    return text.find(part) != std::string::npos;
  };
  BOOST_TEST(has(difference([](SkyGrid& grid) { grid.step[0][0] *= -1; }), "mirrored"));
  BOOST_TEST(has(difference([](SkyGrid& grid) { grid.step[1][1] *= -1; }), "mirrored"));
  BOOST_TEST(has(difference([](SkyGrid& grid) { grid.step[1][1] *= 1.5; }), "2arcsec wide and 3arcsec high"));
  BOOST_TEST(has(difference([](SkyGrid& grid) { set_pole(grid, 168 * degree); }), "turned by -12 degrees"));
  BOOST_TEST(has(difference([](SkyGrid& grid) { set_pole(grid, 0); }), "180 degrees"));
  BOOST_TEST(has(difference([](SkyGrid& grid) { grid.slant = {0, 1e3}; }), "slanted by 0, 1000"));
  BOOST_TEST(has(difference([](SkyGrid& grid) { grid.reference.frame = "GALACTIC"; }), "in GALACTIC; expected ICRS"));
}

BOOST_AUTO_TEST_SUITE_END()
