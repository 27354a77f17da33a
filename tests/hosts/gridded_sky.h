#pragma once

#include <casacore/scimath/Mathematics/Gridder.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <random>
#include <stdexcept>

namespace misfit::testing {

using CasacoreBase = casacore::Gridder<casacore::Double, casacore::Complex>;

/// Pixels of a square image, in the middle of one of the FFT's size, and visibilities at places well inside the grid: the
/// transform between them directly, and by a gridder. Sums of many terms are in double precision; what casacore holds is
/// single.
class GriddedSky {
 public:
  int pixels;
  int fft_size;
  Eigen::MatrixXcd image;  ///< [l][m]
  Eigen::VectorXd u, v;    ///< cells from the centre of the grid

  static constexpr double units_per_cell = 0.5;  ///< of the positions that the gridder is called with

  /// Every pixel of size 1 with a random phase: the mean over all x, y of what single pixels do.
  static GriddedSky random_phases(int pixels, int fft_size, int visibilities) {
    GriddedSky sky(pixels, fft_size, visibilities);
    for (auto& pixel : sky.image.reshaped()) pixel = std::polar(1.0, 2 * M_PI * sky.part_(sky.generator_));
    return sky;
  }
  /// Sources of 1 to 2 Jy on some pixels.
  static GriddedSky points(int pixels, int fft_size, int visibilities) {
    GriddedSky sky(pixels, fft_size, visibilities);
    sky.image.setZero();
    for (int source = 0; source < 40; ++source) {
      const auto somewhere = [&] { return static_cast<Eigen::Index>(pixels * sky.part_(sky.generator_)); };
      const Eigen::Index l = somewhere(), m = somewhere();
      sky.image(l, m) = 1 + sky.part_(sky.generator_);
    }
    return sky;
  }

  casacore::IPosition shape() const { return casacore::IPosition(2, fft_size, fft_size); }
  casacore::Vector<double> scale() const { return casacore::Vector<double>(2, 1 / units_per_cell); }
  casacore::Vector<double> offset() const { return casacore::Vector<double>(2, static_cast<double>(fft_size / 2)); }
  casacore::Vector<double> position(Eigen::Index k) const {
    casacore::Vector<double> p(2);
    p[0] = u[k] * units_per_cell;
    p[1] = v[k] * units_per_cell;
    return p;
  }
  /// x of the pixels.
  Eigen::VectorXd x() const { return Eigen::VectorXd::LinSpaced(pixels, -(pixels / 2), (pixels - 1) / 2) / fft_size; }

  /// Visibilities of size 1 with random phases, that no image explains: their dirty image is alike everywhere.
  Eigen::VectorXcd noise() {
    return Eigen::VectorXcd::NullaryExpr(u.size(), [this] { return std::polar(1.0, 2 * M_PI * part_(generator_)); });
  }

  /// V = Σ I exp(2πi(ux + vy)).
  Eigen::VectorXcd visibilities() const { return (phasors(u) * image).cwiseProduct(phasors(v)).rowwise().sum(); }
  /// The same by degrid().
  Eigen::VectorXcd degridded(CasacoreBase& gridder) const {
    const Eigen::MatrixXcd at_cells = phasors(cells());
    const Eigen::MatrixXcf grid = (at_cells * corrected(image, gridder) * at_cells.transpose()).cast<std::complex<float>>();
    const casacore::Array<casacore::Complex> array = to_casacore(grid);
    Eigen::VectorXcd value(u.size());
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      casacore::Complex found;
      if (!gridder.degrid(array, position(k), found)) throw std::logic_error("a visibility is off the grid");
      value[k] = found;
    }
    return value;
  }

  /// Σ V exp(−2πi(ux + vy)) at all pixels.
  Eigen::MatrixXcd dirty(const Eigen::VectorXcd& visibility) const {
    return phasors(u).adjoint() * visibility.asDiagonal() * phasors(v).conjugate();
  }
  /// The same by grid().
  Eigen::MatrixXcd gridded(CasacoreBase& gridder, const Eigen::VectorXcd& visibility) const {
    casacore::Array<casacore::Complex> array(shape(), casacore::Complex(0));
    for (Eigen::Index k = 0; k < u.size(); ++k)
      if (!gridder.grid(array, position(k), casacore::Complex(visibility[k])))
        throw std::logic_error("a visibility is off the grid");
    const Eigen::Map<const Eigen::MatrixXcf> grid(array.data(), fft_size, fft_size);
    const Eigen::MatrixXcd at_cells = phasors(cells());
    return corrected(at_cells.adjoint() * grid.cast<std::complex<double>>() * at_cells.conjugate(), gridder);
  }

  /// The squared relative error that two axes of map error ℓ(x), at the pixels' x, leave of these pixels.
  double expected(const Eigen::VectorXd& map_error) const {
    const Eigen::MatrixXd power = image.cwiseAbs2();
    return (power.rowwise().sum() + power.colwise().sum().transpose()).dot(map_error) / power.sum();
  }

  static casacore::Array<casacore::Complex> to_casacore(const Eigen::MatrixXcf& matrix) {
    casacore::Array<casacore::Complex> array(casacore::IPosition(2, matrix.rows(), matrix.cols()));
    Eigen::Map<Eigen::MatrixXcf>(array.data(), matrix.rows(), matrix.cols()) = matrix;
    return array;
  }

 private:
  static constexpr double margin = 12;  ///< cells to the border: W/2 and more for every width

  GriddedSky(int size, int fft, int visibilities) : pixels(size), fft_size(fft), image(size, size) {
    const double reach = fft / 2.0 - margin;
    u = Eigen::VectorXd::NullaryExpr(visibilities, [&] { return reach * (2 * part_(generator_) - 1); });
    v = Eigen::VectorXd::NullaryExpr(visibilities, [&] { return reach * (2 * part_(generator_) - 1); });
  }

  Eigen::VectorXd cells() const { return Eigen::VectorXd::LinSpaced(fft_size, -(fft_size / 2), (fft_size - 1) / 2); }
  /// exp(2πiux): [u][x]
  Eigen::MatrixXcd phasors(const Eigen::VectorXd& at) const {
    return (std::complex<double>(0, 2 * M_PI) * (at * x().transpose())).array().exp();
  }
  Eigen::MatrixXcd corrected(const Eigen::MatrixXcd& of, CasacoreBase& gridder) const {
    Eigen::MatrixXcd result(pixels, pixels);
    const int corner = fft_size / 2 - pixels / 2;
    for (int l = 0; l < pixels; ++l)
      for (int m = 0; m < pixels; ++m)
        result(l, m) = of(l, m) / std::complex<double>(gridder.correct(casacore::IPosition(2, corner + l, corner + m)));
    return result;
  }

  std::mt19937_64 generator_{11};
  std::uniform_real_distribution<double> part_{0, 1};
};

template <typename A, typename B>
double relative_error(const A& found, const B& exact) {
  return (found - exact).norm() / exact.norm();
}

}  // namespace misfit::testing
