#include "tools/drawing/picture_script.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <ostream>
#include <stdexcept>

#include "tools/base/numbers.h"
#include "tools/drawing/gnuplot.h"
#include "tools/drawing/picture_layout.h"
#include "tools/drawing/sky_marks.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;

/// All that the script is made from. Values of the stretch are in `unit`, offsets in the unit of `frame`.
struct Scene {
  const Picture& picture;
  const Sketch& sketch;
  Stretch stretch;
  ScaledUnit unit;
  SkyFrame frame;
  PictureLayout layout;

  double offsets_a_pixel() const { return frame.width() / layout.plot_width; }
};

Scene scene_of(const Picture& picture, const Sketch& sketch) {
  Stretch stretch = sketch.stretch;
  const ScaledUnit unit = scaled_unit(std::max(std::abs(stretch.low), std::abs(stretch.high)), picture.image->unit);
  for (double* limit : {&stretch.low, &stretch.high, &stretch.knee}) *limit /= unit.size;
  const imager::ImageGeometry& geometry = picture.image->geometry;
  return {picture, sketch, stretch, unit, sky_frame(geometry), {geometry.width, geometry.height}};
}

/// The shades as 32-bit floats, rows from south to north and columns from west to east, as gnuplot counts.
void write_shades(const fs::path& path, const Scene& scene) {
  const imager::Image& image = scene.sketch.reduced.image;
  std::vector<float> shades;
  shades.reserve(image.pixel.size());
  for (int row = 0; row < image.height; ++row) {
    for (int column = image.width - 1; column >= 0; --column)
      shades.push_back(static_cast<float>(scene.stretch(image.at(row, column) / scene.unit.size)));
  }
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(shades.data()), static_cast<std::streamsize>(shades.size() * sizeof(float)));
  if (!file.flush()) throw std::runtime_error("cannot write pictures in " + path.parent_path().string());
}

/// The outline of the mask in offsets, a line for each end of a side and an empty one between sides.
void write_mask(const fs::path& path, const Scene& scene) {
  const ReducedImage mask = reduce(*scene.picture.mask, picture_side);
  const double step = mask.block * scene.picture.image->geometry.cell_rad / scene.frame.unit.size;
  std::ofstream file(path);
  file.precision(12);
  for (const PixelSide& side : outline(mask.image))
    file << scene.frame.east - side.from_column * step << ' ' << scene.frame.south + side.from_row * step << '\n'
         << scene.frame.east - side.to_column * step << ' ' << scene.frame.south + side.to_row * step << "\n\n";
}

std::string beam_text(const imager::Beam& beam) {
  const ScaledUnit unit = angle_unit(beam.major_rad);
  return "beam " + significant(beam.major_rad / unit.size, 3) + " × " + significant(beam.minor_rad / unit.size, 3) + " " +
         unit.name + " at " + significant(beam.position_angle_rad * 180 / M_PI, 3) + "°";
}

std::vector<std::string> titles(const Scene& scene) {
  const imager::SkyImage& sky = *scene.picture.image;
  const imager::SkyDirection& centre = sky.geometry.phase_centre;
  std::string about = sky.has_beam ? beam_text(sky.beam) : "";
  if (sky.observation.frequency_hz > 0)
    about = significant(sky.observation.frequency_hz / 1e9, 5) + " GHz" + (about.empty() ? "" : ",  ") + about;
  if (scene.picture.mask != nullptr) about += about.empty() ? "mask in green" : ",  mask in green";
  return {scene.picture.title, "offsets from " + sexagesimal(centre) + " (" + centre.frame + ")", about};
}

void write_offset_axes(std::ostream& script, const Scene& scene) {
  const SkyFrame& frame = scene.frame;
  const auto label = [&](const char* direction, int pixels) {
    return (pixels < 250 ? "" : "offset ") + std::string(direction) + ", " + frame.unit.name;
  };
  write_axes(script, scene.layout, {'x', label("east", scene.layout.plot_width), frame.east, frame.west},
             {'y', label("north", scene.layout.plot_height), frame.south, frame.north});
}

/// Colours from the lowest shade to the highest; each palette's lightness tells values apart without hue too. In images without
/// noise all that is not 0 stands out.
const char* palette(const Scene& scene) {
  if (scene.picture.shades == Shades::brightness)
    return "0 '#000004', 1 '#1f0c48', 2 '#550f6d', 3 '#88226a', 4 '#bb3754', 5 '#e35933', 6 '#f98e09', 7 '#f9c932', 8 "
           "'#fcffa4'";
  const bool one_sign = scene.stretch.low == 0;
  if (scene.stretch.sparse)
    return one_sign ? "0 '#f7f7f7', 0.004 '#f7f7f7', 0.004 '#f0a582', 0.5 '#c23b3c', 1 '#4a0615'"
                    : "-1 '#041c3a', -0.5 '#2a6fb0', -0.004 '#8fc3de', -0.004 '#f7f7f7', 0.004 '#f7f7f7', 0.004 '#f0a582', "
                      "0.5 '#c23b3c', 1 '#4a0615'";
  return one_sign ? "0 '#f7f7f7', 1 '#fddbc7', 2 '#f4a582', 3 '#d6604d', 4 '#a3122a'"
                  : "-4 '#1b569f', -3 '#4393c3', -2 '#92c5de', -1 '#d1e5f0', 0 '#f7f7f7', 1 '#fddbc7', 2 '#f4a582', 3 "
                    "'#d6604d', 4 '#a3122a'";
}

ColourBar colour_bar(const Scene& scene) {
  const Stretch& stretch = scene.stretch;
  ColourBar bar{.palette = palette(scene),
                .low = stretch(stretch.low),
                .high = stretch(stretch.high),
                .ticks = stretch_ticks(stretch),
                .notes = {scene.unit.name, stretch.knee > 0 ? "asinh scale" : "linear scale"}};
  for (Tick& tick : bar.ticks) tick.value = stretch(tick.value);
  return bar;
}

/// A box of light paper below marks, so that they can be read whatever the image holds there.
struct Box {
  double east, west, south, north;
};

void write_paper(std::ostream& script, int tag, const Box& box) {
  script << "set object " << tag << " rectangle from " << box.east << ',' << box.south << " to " << box.west << ',' << box.north
         << " front fc rgb '#ffffff' fs solid 0.85 border lc rgb '#666666'\n";
}

/// The beam, unless it would take more than half of a side.
void write_beam(std::ostream& script, const Scene& scene) {
  const imager::SkyImage& sky = *scene.picture.image;
  const SkyFrame& frame = scene.frame;
  if (!sky.has_beam) return;
  const SkyOffset reach = beam_reach(sky.beam);
  const double pixel = scene.offsets_a_pixel();
  const double half_width = reach.east / frame.unit.size + 8 * pixel, half_height = reach.north / frame.unit.size + 8 * pixel;
  if (half_width > frame.width() / 4 || half_height > frame.height() / 4) return;
  const double east = frame.east - 10 * pixel - half_width, north = frame.south + 10 * pixel + half_height;
  write_paper(script, 1, {east + half_width, east - half_width, north - half_height, north + half_height});
  script << "set object 2 polygon";
  const char* word = " from ";
  for (const SkyOffset& at : beam_ellipse(sky.beam)) {
    script << word << east + at.east / frame.unit.size << ',' << north + at.north / frame.unit.size;
    word = " to ";
  }
  script << " front fc rgb '#222222' fs solid 1 border lc rgb '#222222'\n";
}

void write_scale_bar(std::ostream& script, const Scene& scene) {
  const SkyFrame& frame = scene.frame;
  const double pixel = scene.offsets_a_pixel();
  if (scene.layout.plot_width < 240 || scene.layout.plot_height < 160) return;
  const ScaleBar bar = scale_bar(frame.width() * frame.unit.size / 4);
  const double length = bar.length_rad / frame.unit.size;
  const double half_width = std::max(length / 2 + 12 * pixel, 70 * pixel);
  const double middle = frame.west + 10 * pixel + half_width, south = frame.south + 10 * pixel;
  write_paper(script, 3, {middle + half_width, middle - half_width, south, south + 50 * pixel});
  script << "set arrow 1 from " << middle + length / 2 << ',' << south + 12 * pixel << " to " << middle - length / 2 << ','
         << south + 12 * pixel << " heads size screen 0.006,90 front lw 2.5 lc rgb '#222222'\n"
         << "set label 6 " << gnuplot_quoted(bar.label) << " at " << middle << ',' << south + 33 * pixel
         << " center front font 'sans,15' tc rgb '#222222'\n";
}

}  // namespace

void write_picture_script(const Picture& picture, const fs::path& folder) {
  const imager::Image& pixels = picture.pixels != nullptr ? *picture.pixels : picture.image->image;
  const Sketch made = picture.sketch != nullptr ? *picture.sketch : sketch(pixels, picture.shades, picture_side);
  const Scene scene = scene_of(picture, made);
  write_shades(folder / "data", scene);

  std::ofstream script(folder / "script");
  write_beginning(script, scene.layout);
  write_titles(script, scene.layout, titles(scene));
  write_offset_axes(script, scene);
  write_colour_bar(script, scene.layout, colour_bar(scene));
  write_beam(script, scene);
  write_scale_bar(script, scene);
  const imager::Image& image = made.reduced.image;
  const double step = made.reduced.block * picture.image->geometry.cell_rad / scene.frame.unit.size;
  script << "plot 'data' binary array=(" << image.width << ',' << image.height << ") format='%float' origin=("
         << scene.frame.east - (image.width - 0.5) * step << ',' << scene.frame.south + step / 2 << ") dx=" << step
         << " dy=" << step << " with image";
  if (picture.mask != nullptr) {
    write_mask(folder / "mask", scene);
    script << ", 'mask' with lines lw 1.5 lc rgb '#18b877'";
  }
  script << "\nunset output\n";
}

}  // namespace misfit::tools
