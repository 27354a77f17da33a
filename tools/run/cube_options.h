#pragma once

#include <string>
#include <vector>

#include "imager/cube/channel_map.h"
#include "imager/plan/plan.h"
#include "ms_io/spectral_frame.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// Which planes of frequency an image has: one of the whole band, or those of a cube. Names and meaning are tclean's.
struct CubeOptions {
  std::string specmode = "mfs";          ///< or cube, cubedata, cubesource
  int nchan = -1;                        ///< planes; −1 = to the end of the data
  std::string start;                     ///< a channel, "3chan", "1.4GHz" or "20km/s"; empty = the first channel
  std::string chanwidth;                 ///< channels, "1MHz" or "2km/s"; empty = one channel
  std::string outframe = "LSRK";         ///< of cube, as ms_io::parse_spectral_frame() takes it, or REST
  std::string veltype = "radio";         ///< of `start` and `chanwidth`, or optical
  std::string restfreq;                  ///< of the line, for headers and velocities; empty = none
  std::string interpolation = "linear";  ///< or nearest
  bool perchanweightdensity = true;      ///< each plane's weights follow from its own samples; or from those of all

  bool is_cube() const { return specmode != "mfs"; }
};

/// FITS SPECSYS of the frame to which frequencies of the data are converted; empty: they stay as they are.
std::string spectral_frame(const CubeOptions& options);

void declare(CLI::App& command, CubeOptions& options);

/// Throws std::invalid_argument that names the option, its value and what was expected.
void check(const CubeOptions& options);

/// The frequency of --restfreq, which images of the whole band may have too; 0 where none is given. Throws as check() does.
double rest_frequency_hz(const CubeOptions& options);

/// The planes, of data with these windows in the frame of spectral_frame(); `data_frame` is the data's own frame, empty where
/// they have several. Channels count from 0 among the selected channels of the first window, or, "3chan", among all its
/// channels; that window gives the width and the direction of a channel. Velocities are radio's, c (1 − f/f_rest), or optical
/// ones, c (f_rest/f − 1): planes are then evenly spaced in these. Where --start is a velocity, planes go up in velocity; where
/// it is a frequency, up in frequency; else as channels do; a negative --chanwidth turns them about. Throws
/// std::invalid_argument where no plane holds data, a frequency is not positive, or --outframe REST is asked of other data,
/// std::runtime_error where channels have no width.
imager::CubeSampling cube_sampling(const CubeOptions& options, const std::vector<ms_io::SpectralWindow>& windows,
                                   const std::string& data_frame);

/// Which windows have no channel in a plane, and are left out; empty where all have. Throws std::invalid_argument where none
/// has.
std::string windows_left_out(const imager::SpectralAxis& axis, const std::vector<ms_io::SpectralWindow>& windows);

/// The decision on the planes, and on how data come into them.
imager::Decision axis_decision(const imager::CubeSampling& sampling);

}  // namespace misfit::tools
