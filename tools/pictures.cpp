#include "tools/pictures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "tools/gnuplot.h"
#include "tools/numbers.h"
#include "tools/stretch.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;

/// The plot area's longer side, screen pixels, and the room around it.
constexpr int plot_side = 640;
constexpr int margin_left = 92;
constexpr int margin_right = 170;
constexpr int margin_top = 78;
constexpr int margin_bottom = 70;

/// The shades as 32-bit floats, rows from south to north and columns from west to east, as gnuplot counts.
void write_shades(const fs::path& path, const imager::Image& image, const Stretch& stretch, double unit) {
  std::vector<float> shades;
  shades.reserve(image.pixel.size());
  for (int row = 0; row < image.height; ++row) {
    for (int column = image.width - 1; column >= 0; --column)
      shades.push_back(static_cast<float>(stretch(image.at(row, column) / unit)));
  }
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(shades.data()), static_cast<std::streamsize>(shades.size() * sizeof(float)));
  if (!file.flush()) throw std::runtime_error("cannot write pictures in " + path.parent_path().string());
}

std::string subtitle(const imager::SkyImage& sky) {
  const imager::SkyDirection& centre = sky.geometry.phase_centre;
  std::string text = sexagesimal(centre) + " (" + centre.frame + ")";
  if (sky.observation.frequency_hz > 0) text += "   " + significant(sky.observation.frequency_hz / 1e9, 5) + " GHz";
  if (sky.has_beam) {
    const ScaledUnit unit = angle_unit(sky.beam.major_rad);
    text += "   beam " + significant(sky.beam.major_rad / unit.size, 3) + " × " +
            significant(sky.beam.minor_rad / unit.size, 3) + " " + unit.name;
  }
  return text;
}

/// The offsets from the phase centre that an image covers, borders of its outermost pixels included, in `unit`.
struct Frame {
  ScaledUnit unit;
  double east, west, south, north;
};
Frame frame_of(const imager::ImageGeometry& geometry) {
  const ScaledUnit unit = angle_unit(std::max(geometry.width, geometry.height) * geometry.cell_rad);
  const double half = geometry.cell_rad / 2;
  return {.unit = unit,
          .east = (geometry.l(0) + half) / unit.size,
          .west = (geometry.l(geometry.width - 1) - half) / unit.size,
          .south = (geometry.m(0) - half) / unit.size,
          .north = (geometry.m(geometry.height - 1) + half) / unit.size};
}

/// The beam to scale in the lower left corner, as the lines of a gnuplot data block.
std::string beam_outline(const imager::Beam& beam, const Frame& frame) {
  const double inset =
      0.03 * std::max(frame.east - frame.west, frame.north - frame.south) + beam.major_rad / 2 / frame.unit.size;
  const double sine = std::sin(beam.position_angle_rad);
  const double cosine = std::cos(beam.position_angle_rad);
  std::ostringstream lines;
  for (int step = 0; step <= 72; ++step) {
    const double angle = step * std::numbers::pi / 36;
    const double along = beam.major_rad / 2 * std::cos(angle) / frame.unit.size;
    const double across = beam.minor_rad / 2 * std::sin(angle) / frame.unit.size;
    lines << frame.east - inset + along * sine - across * cosine << ' ' << frame.south + inset + along * cosine + across * sine
          << '\n';
  }
  return lines.str();
}

void colour_bar(std::ostream& script, const Stretch& stretch, const std::string& unit, double width) {
  script << "set cbrange [" << stretch(stretch.low) << ':' << stretch(stretch.high) << "]\nset cbtics (";
  const char* comma = "";
  for (const Tick& tick : stretch_ticks(stretch)) {
    script << comma << gnuplot_quoted(tick.label) << ' ' << stretch(tick.value);
    comma = ", ";
  }
  const std::string kind =
      stretch.knee > 0 ? ", asinh stretch, linear below " + significant(stretch.knee, 2) : ", linear stretch";
  script << ")\nset label 3 " << gnuplot_quoted(unit + kind) << " at screen " << 1 - 20 / width
         << ", graph 0.5 rotate by 90 center\n";
}

/// Draws a picture, with its data in "data" and its result in "png".
void script_picture(std::ostream& script, const Picture& picture, const fs::path& folder) {
  const imager::SkyImage& sky = *picture.image;
  Stretch stretch = choose_stretch(sky.image);
  const ScaledUnit unit = scaled_unit(std::max(std::abs(stretch.low), std::abs(stretch.high)), sky.unit);
  for (double* limit : {&stretch.low, &stretch.high, &stretch.knee}) *limit /= unit.size;
  const ReducedImage reduced = reduce(sky.image, stretch.sparse ? plot_side / 3 : plot_side);
  write_shades(folder / "data", reduced.image, stretch, unit.size);

  const Frame frame = frame_of(sky.geometry);
  const double longer = std::max(sky.image.width, sky.image.height);
  const int plot_width = std::max(240, static_cast<int>(std::lround(plot_side * sky.image.width / longer)));
  const int plot_height = std::max(240, static_cast<int>(std::lround(plot_side * sky.image.height / longer)));
  const int width = plot_width + margin_left + margin_right;
  const int height = plot_height + margin_top + margin_bottom;
  const double step = reduced.block * sky.geometry.cell_rad / frame.unit.size;

  script
      << "reset\nset encoding utf8\nset minussign\nset terminal pngcairo noenhanced background rgb 'white' font 'sans,13' size "
      << width << ',' << height << '\n'
      << "set output 'png'\n"
      << "set lmargin at screen " << double(margin_left) / width << "\nset rmargin at screen "
      << double(margin_left + plot_width) / width << "\nset bmargin at screen " << double(margin_bottom) / height
      << "\nset tmargin at screen " << double(margin_bottom + plot_height) / height << '\n'
      << "set palette defined (0 '#000004', 1 '#1f0c48', 2 '#550f6d', 3 '#88226a', 4 '#bb3754', 5 '#e35933', 6 '#f98e09', 7 "
         "'#f9c932', "
         "8 '#fcffa4')\n"
      << "set border lw 1 lc rgb '#444444'\nset tics out nomirror textcolor rgb '#222222'\nunset key\n"
      << "set label 1 " << gnuplot_quoted(picture.title) << " at graph 0, screen " << 1 - 26.0 / height
      << " font 'sans:Bold,17'\n"
      << "set label 2 " << gnuplot_quoted(subtitle(sky)) << " at graph 0, screen " << 1 - 56.0 / height
      << " font 'sans,11' tc rgb '#555555'\n"
      << "set xlabel " << gnuplot_quoted("offset east, " + frame.unit.name) << "\nset ylabel "
      << gnuplot_quoted("offset north, " + frame.unit.name) << '\n'
      << "set xrange [" << frame.east << ':' << frame.west << "]\nset yrange [" << frame.south << ':' << frame.north << "]\n";
  colour_bar(script, stretch, unit.name, width);
  if (sky.has_beam) script << "$beam << EOD\n" << beam_outline(sky.beam, frame) << "EOD\n";
  script << "plot 'data' binary array=(" << reduced.image.width << ',' << reduced.image.height << ") format='%float' origin=("
         << frame.east - (reduced.image.width - 0.5) * step << ',' << frame.south + step / 2 << ") dx=" << step
         << " dy=" << step << " with image";
  if (sky.has_beam) script << ", $beam with filledcurves fc rgb '#ffffff' fs solid border lc rgb '#999999'";
  script << "\nunset output\n";
}

/// Whether a PNG file is there to its last chunk, IEND; gnuplot says nothing when the disk is full.
bool is_complete(const fs::path& path) {
  const std::string end("IEND\xae\x42\x60\x82", 8);
  std::ifstream file(path, std::ios::binary);
  file.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  std::string last(end.size(), '\0');
  file.read(last.data(), static_cast<std::streamsize>(last.size()));
  return file && last == end;
}

}  // namespace

/// A picture being drawn.
struct PictureDrawing::Sheet {
  std::string path;
  std::unique_ptr<WorkFolder> work;
  std::future<std::string> failure;

  explicit Sheet(const Picture& picture)
      : path(picture.path), failure(std::async(std::launch::async, [this, picture] { return draw(picture); })) {}

  std::string draw(const Picture& picture) {
    work = std::make_unique<WorkFolder>(fs::absolute(picture.path).parent_path());
    std::ofstream script(work->path() / "script");
    script.precision(12);
    script_picture(script, picture, work->path());
    script.close();
    return run_gnuplot(*work);
  }
  fs::path drawn() const { return work->path() / "png"; }
};

PictureDrawing::PictureDrawing(const std::vector<Picture>& pictures) {
  for (const Picture& picture : pictures) sheets_.push_back(std::make_unique<Sheet>(picture));
}

PictureDrawing::~PictureDrawing() = default;

std::string PictureDrawing::finish() {
  for (const auto& sheet : sheets_) {
    const std::string failure = sheet->failure.get();
    if (!failure.empty()) return "Pictures are left out because " + failure + ".";
  }
  for (const auto& sheet : sheets_)
    if (!is_complete(sheet->drawn())) return "Pictures are left out because gnuplot could not finish them; is the disk full?";
  for (const auto& sheet : sheets_) fs::rename(sheet->drawn(), sheet->path);
  return "";
}

std::string draw_pictures(const std::vector<Picture>& pictures) {
  return PictureDrawing(pictures).finish();
}

}  // namespace misfit::tools
