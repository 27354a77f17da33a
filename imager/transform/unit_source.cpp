#include "imager/transform/unit_source.h"

#include <algorithm>

#include "imager/numerics/parallel.h"
#include "imager/numerics/phasors.h"

namespace misfit::imager {

std::vector<std::complex<double>> unit_source(const SampleCoordinates& at, const PhasePosition& source, int threads) {
  constexpr std::size_t rows_a_piece = 1024;
  std::vector<std::complex<double>> visibility(at.samples(), 1);
  if (source.l == 0 && source.m == 0 && source.n_minus_1 == 0) return visibility;
  const std::size_t channels = at.channels();
  parallel_for((at.rows() + rows_a_piece - 1) / rows_a_piece, threads, [&](std::size_t p) {
    const std::size_t begin = p * rows_a_piece, end = std::min(begin + rows_a_piece, at.rows());
    std::vector<double> turns((end - begin) * channels), cosine(turns.size()), sine(turns.size());
    for (std::size_t row = begin, i = 0; row < end; ++row) {
      const double per_hz = turns_per_hz(&at.uvw_m[3 * row], source);
      for (std::size_t c = 0; c < channels; ++c, ++i) turns[i] = per_hz * at.frequency_hz[c];
    }
    phasors(turns.data(), static_cast<int>(turns.size()), cosine.data(), sine.data());
    for (std::size_t i = 0; i < turns.size(); ++i) visibility[begin * channels + i] = {cosine[i], sine[i]};
  });
  return visibility;
}

}  // namespace misfit::imager
