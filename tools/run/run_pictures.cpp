#include "tools/run/run_pictures.h"

#include "imager/data/stokes.h"
#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/formats/image_file.h"
#include "tools/run/image_files.h"
#include "tools/run_page/spectrum_figure.h"

namespace misfit::tools {
namespace {

/// The drawing of a figure; empty where gnuplot cannot draw it: the pictures say why.
std::string drawn(const Figure& figure) {
  try {
    return draw_svg(figure);
  } catch (const std::runtime_error&) {
    return "";
  }
}

}  // namespace

std::unique_ptr<imager::ImageReader> open_written(const ImageOptions& o, const std::string& kind) {
  return open_image_file(image_paths(o.imagename + "." + kind, o.outformat).front(), imager::Grids::upright,
                         ms_io::Masks::ignored);
}

RunPictures::Shown RunPictures::of_stokes(std::size_t stokes, Shown shown) const {
  if (header_.stokes.size() == 1) return shown;
  const std::string name = imager::stokes_name(header_.stokes[stokes]);
  shown.name += "." + name;
  shown.title += ", " + name;
  return shown;
}

void RunPictures::add(const std::vector<Shown>& shown) {
  std::vector<imager::SkyImage> each(shown.size(), about_);
  std::vector<Picture> wanted;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::string path = o_.imagename + "." + shown[i].name + ".png";
    each[i].unit = shown[i].unit;
    titles_and_paths_.emplace_back(shown[i].title, path);
    wanted.push_back({&each[i], shown[i].title, path, shown[i].shades, shown[i].image, shown[i].sketch, shown[i].mask});
  }
  drawing_.add(wanted);
}

void RunPictures::draw_dirty(ChannelRun& run) {
  const imager::StageTimer timer(times_, imager::stage::draw_pictures);
  about_.geometry = header_.geometry;
  about_.observation = header_.observation;
  about_.has_beam = run.report().beams->restoring.has_value();
  about_.beam = run.report().beams->restoring.value_or(imager::Beam{});
  const std::string uv_path = o_.imagename + ".uv.png";
  titles_and_paths_.emplace_back("uv coverage", uv_path);
  drawing_.add(run.samples().uv_coverage(), uv_path);
  const imager::DirtyImages& images = run.images().images;
  add({{.name = "psf", .title = "PSF", .image = &images.psf}});
  std::vector<Shown> shown;
  dirty_.resize(images.dirty.size());
  for (std::size_t s = images.dirty.size(); s-- > 0;) {
    const imager::Image& dirty = images.dirty[s];
    if (o_.clean.usemask == "auto")
      dirty_[s] = sketch(dirty, Shades::brightness, picture_side);
    else
      shown.push_back(of_stokes(
          s, {.name = !o_.clean.runs() ? "residual" : "dirty", .title = "Dirty image", .image = &dirty, .mask = run.mask(s)}));
  }
  add(shown);
}

void RunPictures::draw(std::size_t stokes, const imager::CleanResult& cleaned, const RestoredTerms& restored) {
  const imager::StageTimer timer(times_, imager::stage::draw_pictures);
  const imager::Image* const mask = cleaned.mask.pixel.empty() ? nullptr : &cleaned.mask;
  std::vector<Shown> shown;
  if (o_.clean.usemask == "auto")
    shown.push_back(of_stokes(stokes, {.name = "dirty", .title = "Dirty image", .sketch = &dirty_[stokes], .mask = mask}));
  shown.push_back(of_stokes(stokes, {"model", "Model", "Jy/pixel", Shades::about_zero, &cleaned.model, nullptr, mask}));
  shown.push_back(of_stokes(stokes, {"residual", "Residual", "Jy/beam", Shades::about_zero, &cleaned.residual, nullptr, mask}));
  shown.push_back(
      of_stokes(stokes, {"image", "Restored image", "Jy/beam", Shades::brightness, &restored.first, nullptr, mask}));
  if (o_.taylor.nterms > 1)
    shown.push_back({"alpha", "Spectral index as seen", "", Shades::about_zero, &restored.spectra.alpha, nullptr, mask});
  add(shown);
}

void RunPictures::draw_channel(const ChannelReport& channel) {
  const imager::StageTimer timer(times_, imager::stage::draw_pictures);
  about_.geometry = header_.geometry;
  about_.observation = header_.observation;
  about_.observation.frequency_hz = channel.frequency_hz;
  about_.has_beam = channel.beams && channel.beams->restoring;
  if (about_.has_beam) about_.beam = *channel.beams->restoring;
  const bool cleaned = o_.clean.runs() && channel.stokes.front().clean;
  const std::string kind = cleaned ? "image" : "residual";
  const std::string of = ", plane " + std::to_string(channel.channel) + " at " + frequency_text(channel.frequency_hz, 7) + " " +
                         header_.spectral.frame;
  const imager::PlaneIndex at{channel.channel, 0};
  const imager::Image image = open_written(o_, kind)->read(at), psf = open_written(o_, "psf")->read(at);
  add({{.name = "psf", .title = "PSF" + of, .image = &psf},
       {.name = kind, .title = (cleaned ? "Restored image" : "Dirty image") + of, .image = &image}});
}

std::string RunPictures::finish(std::vector<PagePicture>& pictures) {
  const imager::StageTimer timer(times_, imager::stage::draw_pictures);
  std::string failure = drawing_.finish();
  if (!failure.empty()) return failure;
  for (auto picture = titles_and_paths_.rbegin(); picture != titles_and_paths_.rend(); ++picture)
    pictures.push_back({picture->first, read_file(picture->second)});
  return failure;
}

std::string histogram_drawing(const ChannelReport& channel) {
  const PixelHistogram& histogram = channel.stokes.front().histogram;
  return histogram.pixels == 0 ? "" : drawn(histogram_figure(histogram));
}

std::string spectrum_drawing(const RunReport& report) {
  Spectrum spectrum{.frame = report.cube ? report.cube->frame : "", .frequency_hz = {}, .brightest_jy = {}, .noise_jy = {}};
  for (const ChannelReport& channel : report.channels) {
    if (channel.sums.used == 0) continue;
    spectrum.frequency_hz.push_back(channel.frequency_hz);
    spectrum.brightest_jy.push_back(channel.stokes.front().brightest.value);
    spectrum.noise_jy.push_back(channel.stokes.front().histogram.noise_jy);
  }
  return spectrum.frequency_hz.empty() ? "" : drawn(spectrum_figure(spectrum));
}

}  // namespace misfit::tools
