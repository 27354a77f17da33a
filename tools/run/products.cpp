#include "tools/run/products.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "imager/beams/common_beam.h"
#include "imager/beams/primary_beam.h"
#include "imager/data/noise.h"
#include "imager/numerics/parallel.h"
#include "tools/base/files.h"
#include "tools/formats/component_list.h"
#include "tools/run/image_files.h"
#include "tools/run/left_over.h"
#include "tools/run/mosaic_stage.h"

namespace misfit::tools {
namespace {

/// True if CLEAN ran in a channel.
bool cleaned(const ChannelReport& channel) {
  return channel.stokes.front().clean.has_value();
}

/// Fills in the numbers that a cube's report has of each channel, with the limits of the histogram alone.
void look_at(const imager::Image& residual, const imager::Image* restored, double noise_jy, StokesReport& told) {
  const imager::ImageStatistics of_residual = imager::statistics_of(residual);
  told.histogram = {.noise_jy = noise_jy, .min_jy = of_residual.least, .max_jy = of_residual.largest, .count = {}};
  told.brightest = restored == nullptr ? imager::find_peak(residual, of_residual) : imager::find_peak(*restored);
}

/// CLEAN's components as sources on the sky. Components of a mosaic of flat noise are the sky times its primary beam.
std::vector<imager::Source> sources(const imager::ComponentModel& model, const imager::ImageGeometry& geometry,
                                    const imager::Image* primary_beam) {
  std::vector<imager::Source> sources;
  for (const imager::Component& c : model.components())
    sources.push_back({geometry.at(c.row, c.column),
                       c.flux_jy / (primary_beam == nullptr ? 1 : primary_beam->at(c.row, c.column)),
                       model.scale_pixels()[static_cast<std::size_t>(c.scale)] * geometry.cell_rad});
  return sources;
}

/// W over Σ w of a mosaic.
imager::Image sensitivity_of(ChannelRun& run) {
  if (run.mosaic_beam() == nullptr) return {};
  imager::Image sensitivity = *run.mosaic_beam();
  const double most = run.images().images.normalisation.weight() / run.report().sums.weight;
  for (double& pixel : sensitivity.pixel) pixel = std::isnan(pixel) ? 0 : most * pixel * pixel;
  return sensitivity;
}

}  // namespace

std::unique_ptr<NameLock> claim_product_paths(const ImageOptions& o) {
  check_writable_folder(o.imagename);
  for (const std::string& name : all_product_names()) check_image_paths(o.imagename + "." + name, o.outformat);
  for (const char* end : {".report.json", ".report.html", ".last.ini"})
    if (std::error_code absent; std::filesystem::is_directory(o.imagename + end, absent))
      throw std::runtime_error("cannot write " + o.imagename + end + ": it is a folder; expected another --imagename");
  auto lock = std::make_unique<NameLock>(o.imagename);
  remove_half_written(o.imagename);
  return lock;
}

std::vector<imager::HeaderCard> error_cards(const RunReport& report) {
  std::vector<imager::HeaderCard> cards;
  if (report.accuracy != 0) cards.push_back({"ERRASKED", report.accuracy, "accuracy asked: RMS error over image RMS"});
  // Adds the largest number of all channels and Stokes parameters; channels without samples have none.
  const auto add_largest = [&](const char* keyword, const auto& part, const auto& number, const char* comment) {
    double largest = -1;
    for (const ChannelReport& channel : report.channels)
      for (const StokesReport& stokes : channel.stokes)
        if (const auto& has = stokes.*part) largest = std::max(largest, (*has).*number);
    if (largest >= 0) cards.push_back({keyword, largest, comment});
  };
  using Theory = imager::TheoreticalError;
  using Measured = imager::PixelError;
  add_largest("ERREXPEC", &StokesReport::theory, &Theory::expected_rms, "expected RMS error over image RMS");
  add_largest("ERRBOUND", &StokesReport::theory, &Theory::bound_rms, "bound on it, whatever the data");
  add_largest("ERRBMAX", &StokesReport::theory, &Theory::bound_max, "bound on any pixel's error over image RMS");
  add_largest("ERRMEAS", &StokesReport::measured, &Measured::rms, "measured RMS error over image RMS");
  add_largest("ERRMMAX", &StokesReport::measured, &Measured::max, "largest measured error over image RMS");
  double predicted = -1;
  for (const ChannelReport& channel : report.channels)
    predicted = std::max(predicted, channel.measured_predict_rms.value_or(-1));
  if (predicted >= 0) cards.push_back({"ERRPRED", predicted, "measured RMS error of prediction"});
  if (!report.cube && report.channels.front().predicted_noise_jy != 0)
    cards.push_back({"NOISPRED", report.channels.front().predicted_noise_jy, "Jy/beam, noise predicted from the weights"});
  // An image of zeros has no relative error, and a FITS header no number for that.
  std::erase_if(cards, [](const imager::HeaderCard& card) { return !std::isfinite(card.value); });
  return cards;
}

/// The primary beam of a channel; nothing where none is wanted.
struct Products::OfBeam {
  std::vector<imager::Image> terms;              ///< images of it that are written, [term]
  std::optional<imager::TaylorBeam> of_terms{};  ///< corrects several terms, unless one beam corrects all
  bool divided_out = false;                      ///< whether images are the sky already

  std::vector<imager::Image> corrected(const std::vector<const imager::Image*>& apparent) const {
    if (of_terms) return of_terms->corrected(apparent);
    imager::Image by = terms.front();
    if (divided_out)
      for (double& pixel : by.pixel) pixel = std::isnan(pixel) ? pixel : 1;
    std::vector<imager::Image> sky;
    for (const imager::Image* image : apparent) sky.push_back(imager::corrected(*image, by));
    return sky;
  }
};

/// The written images from which a cube's channels are restored.
struct Products::Written {
  std::unique_ptr<imager::ImageReader> models;
  std::unique_ptr<imager::ImageReader> residuals;
  std::unique_ptr<imager::ImageReader> beams;  ///< of a mosaic, else null
};

Products::Products(const ImageOptions& options, const imager::ImageHeader& header, const PrimaryBeamStage* primary_beam,
                   const ChannelWorkers& workers, const Open& open)
    : o_(options),
      header_(header),
      primary_beam_(primary_beam),
      workers_(workers),
      in_common_(options.cube.is_cube() && options.clean.runs() && options.clean.restoringbeam == "common") {
  for (const ProductKind& kind : product_kinds(ProductChoice::of(o_))) {
    const std::vector<std::string> paths = image_paths(o_.imagename + "." + kind.name, o_.outformat);
    // A mask that the user has under its name stays.
    if (kind.name == "mask" && std::any_of(paths.begin(), paths.end(), [&](const auto& path) { return is_input(o_, path); }))
      continue;
    imager::ImageHeader own = header;
    own.unit = kind.unit;
    own.quantity = kind.quantity;
    own.taylor = kind.term;
    own.flat_noise = o_.makes_flat_noise() && kind.name.rfind("model", 0) == 0;
    if (!kind.each_stokes) own.stokes.resize(1);
    if (kind.one_pixel) own.geometry.width = own.geometry.height = 1;
    paths_.insert(paths_.end(), paths.begin(), paths.end());
    files_.emplace(kind.name, File{kind, open(kind, own), {}});
  }
}

void Products::write(const std::string& kind, const imager::PlaneIndex& at, const imager::Image& image,
                     const std::optional<imager::Beam>& beam) {
  const std::lock_guard lock(image_files_mutex());
  files_.at(kind).writer->write(at, image, beam);
}

/// Writes a plane, if there is a file of this kind and something to write.
void Products::put(const std::string& kind, const imager::PlaneIndex& at, const imager::Image& image,
                   const std::optional<imager::Beam>& beam) {
  const auto file = files_.find(kind);
  if (file == files_.end() || image.pixel.empty()) return;
  write(kind, at, image, file->second.kind.beam ? beam : std::nullopt);
}

void Products::put_terms(const std::string& kind, const imager::PlaneIndex& at, const std::vector<const imager::Image*>& terms,
                         const std::optional<imager::Beam>& beam, const std::string& end) {
  for (std::size_t t = 0; t < terms.size(); ++t)
    put(product_name(kind, {static_cast<int>(t), o_.taylor.nterms}, end), at, *terms[t], beam);
}

/// Headers tell whether the primary beam is divided out of the spectra.
void Products::put_spectra(const imager::SpectralImages& spectra, const std::string& end, const imager::PlaneIndex& at,
                           const std::optional<imager::Beam>& beam) {
  const bool corrected = !end.empty();
  for (const auto& [name, image] :
       {std::pair{"alpha", &spectra.alpha}, {"alpha.error", &spectra.alpha_error}, {"beta", &spectra.beta}}) {
    const auto file = files_.find(name + end);
    if (file == files_.end()) continue;
    file->second.cards = {{"ALPHALIM", spectra.level_jy, "Jy/beam of .image.tt0, below which pixels are NaN"},
                          corrected ? imager::HeaderCard{"PBCOR", 1, "the primary beam's spectrum is divided out"}
                                    : imager::HeaderCard{"PBCOR", 0, "the primary beam's spectrum is still in it"}};
    put(name + end, at, *image, beam);
  }
}

Products::OfBeam Products::primary_beam_of(ChannelRun& run) const {
  OfBeam beam;
  if (run.mosaic_beam() != nullptr) {
    beam.terms.push_back(limited_beam(*run.mosaic_beam(), o_.primary_beam));
    beam.divided_out = o_.mosaic.normtype == "flatsky";
  }
  if (primary_beam_ == nullptr) return beam;
  const imager::StageTimer timer(run.times(), imager::stage::primary_beam);
  if (TaylorStage* const taylor = run.taylor(); taylor != nullptr) {
    beam.of_terms = primary_beam_->of_terms(taylor->expansion());
    beam.terms = beam.of_terms->terms();
  } else {
    beam.terms.push_back(primary_beam_->of_image(run.report().frequency_hz));
  }
  if (const std::string doubt = primary_beam_->warning_of(beam.terms.front()); !doubt.empty())
    run.made().doubts.push_back(doubt);
  return beam;
}

void Products::write(ChannelRun& run, RunPictures* pictures) {
  const imager::PlaneIndex at{run.report().channel, 0};
  const std::optional<imager::Beam>& beam = run.report().beams->restoring;
  std::future<void> psfs = beside([&] {
    const imager::Image& psf = run.images().images.psf;
    put_terms("psf", at, run.taylor() == nullptr ? std::vector{&psf} : all_terms(psf, run.taylor()->images().psf), beam);
  });
  const OfBeam primary_beam = primary_beam_of(run);
  const imager::Image sensitivity = sensitivity_of(run);
  wait_for(psfs, run);
  {
    const imager::StageTimer timer(run.times(), imager::stage::write_images);
    put_terms("pb", at, pointers_to(primary_beam.terms), beam);
    if (run.mosaic_beam() != nullptr) put_terms("weight", at, {&sensitivity}, beam);
  }
  for (std::size_t s = header_.stokes.size(); s-- > 0;)
    write_stokes(s, primary_beam, run, pictures);  // the first is shown first
  if (!o_.cube.is_cube() && o_.taylor.nterms == 1 && !run.cleaned().empty())
    write_components(run.cleaned(), o_.makes_flat_noise() ? run.mosaic_beam() : nullptr);
}

std::future<void> Products::beside(const std::function<void()>& work) const {
  // Deferred where no further thread is to be had. Then `work` is taken a second time, and must not have been moved away.
  const auto either = std::launch::async | std::launch::deferred;
  return std::async(workers_.threads > 1 ? either : std::launch::deferred, work);
}

void Products::wait_for(std::future<void>& work, ChannelRun& run) {
  const imager::StageTimer timer(run.times(), imager::stage::write_images);
  work.get();
}

void Products::write_stokes(std::size_t stokes, const OfBeam& primary_beam, ChannelRun& run, RunPictures* pictures) {
  imager::StageTimes& times = run.times();
  const std::optional<imager::Beam>& beam = run.report().beams->restoring;
  const imager::CleanResult* const result = run.cleaned().empty() ? nullptr : &run.cleaned()[stokes];
  TaylorStage* const taylor = run.taylor();
  const imager::Image& residual = result != nullptr ? result->residual : run.images().images.dirty[stokes];
  RestoredTerms restored;
  if (result != nullptr && !in_common_) {
    const imager::StageTimer timer(times, imager::stage::restore);
    if (taylor != nullptr)
      restored = taylor->restore(*result, *beam, header_.geometry.cell_rad);
    else
      restored.first = restore(result->model, residual, *beam);
  }
  std::future<void> images = beside([&] { put_images(stokes, primary_beam, restored, run); });
  {
    const imager::StageTimer timer(times, imager::stage::statistics);
    StokesReport& told = run.report().stokes[stokes];
    const double noise_jy = told.clean ? told.clean->final_state().rms_jy : imager::sampled_noise(residual);
    const imager::Image* const image = restored.first.pixel.empty() ? nullptr : &restored.first;
    if (o_.cube.is_cube()) {
      look_at(residual, image, noise_jy, told);
    } else {
      told.histogram = pixel_histogram(residual, noise_jy, workers_.threads);
      if (image != nullptr) told.brightest = imager::find_peak(*image);
    }
  }
  if (pictures != nullptr && result != nullptr) pictures->draw(stokes, *result, restored);
  wait_for(images, run);
}

void Products::put_images(std::size_t stokes, const OfBeam& primary_beam, const RestoredTerms& restored, ChannelRun& run) {
  const std::optional<imager::Beam>& beam = run.report().beams->restoring;
  const imager::CleanResult* const result = run.cleaned().empty() ? nullptr : &run.cleaned()[stokes];
  TaylorStage* const taylor = run.taylor();
  const imager::Image& residual = result != nullptr ? result->residual : run.images().images.dirty[stokes];
  const imager::PlaneIndex at{run.report().channel, static_cast<int>(stokes)};
  put_weights(at, run);
  const ProductChoice choice = ProductChoice::of(o_);
  std::vector<imager::Image> principal;  // of terms that are not cleaned
  std::vector<const imager::Image*> shown{&residual};
  if (result != nullptr) {
    put_terms("residual", at, result->residuals(), beam);
    put_terms("model", at, result->models(), beam);
    if (choice.masked) put("mask", at, result->mask.pixel.empty() ? mask_of_ones() : result->mask, beam);
    shown = all_terms(restored.first, restored.further);
    put_terms("image", at, shown, beam);
    if (taylor != nullptr) put_spectra(restored.spectra, "", at, beam);
  } else if (taylor != nullptr) {
    put_terms("residual", at, all_terms(residual, taylor->images().dirty), beam);
    if (o_.primary_beam.pbcor || choice.restored) principal = taylor->principal_solution(residual);
    shown = pointers_to(principal);
  } else {
    put("residual", at, residual, beam);
  }
  if (result == nullptr && choice.restored && beam) put_terms("image", at, shown, beam);
  if (o_.primary_beam.pbcor && (result != nullptr || !o_.clean.runs()))
    write_corrected(at, primary_beam, shown, result == nullptr ? nullptr : &restored.spectra, beam);
}

imager::Image Products::mask_of_ones() const {
  imager::Image ones(header_.geometry.width, header_.geometry.height);
  std::fill(ones.pixel.begin(), ones.pixel.end(), 1);
  return ones;
}

/// Σ w, and of Taylor terms Σ w x^k as the middles of their PSFs have it.
void Products::put_weights(const imager::PlaneIndex& at, ChannelRun& run) {
  std::vector<imager::Image> sums(1, imager::Image(1, 1));
  const double weight = sums.front().pixel.front() = sumwt_of(run.images().images.sums[static_cast<std::size_t>(at.stokes)]);
  if (run.taylor() != nullptr)
    for (const imager::Image& psf : run.taylor()->images().psf) {
      sums.emplace_back(1, 1);
      sums.back().pixel.front() = weight * psf.at(psf.height / 2, psf.width / 2);
    }
  put_terms("sumwt", at, pointers_to(sums), {});
}

/// Images [term] without the primary beam.
void Products::write_corrected(const imager::PlaneIndex& at, const OfBeam& primary_beam,
                               const std::vector<const imager::Image*>& apparent, const imager::SpectralImages* spectra,
                               const std::optional<imager::Beam>& beam) {
  if (apparent.front()->pixel.empty()) return;  // it follows
  const std::vector<imager::Image> sky = primary_beam.corrected(apparent);
  put_terms("image", at, pointers_to(sky), beam, ".pbcor");
  if (spectra == nullptr || sky.size() == 1) return;
  imager::SpectralImages of_sky = imager::spectral_images_of_sky(sky, *spectra, workers_.threads);
  put_spectra(of_sky, ".pbcor", at, beam);
}

void Products::write_components(const std::vector<imager::CleanResult>& cleaned, const imager::Image* divided_by) const {
  std::vector<SourcesOf> found;
  for (std::size_t s = 0; s < cleaned.size(); ++s)
    found.push_back({header_.stokes[s], sources(cleaned[s].components, header_.geometry, divided_by)});
  const bool stands = header_.observation.moving_at.empty();
  write_stokes_components(o_.imagename + ".components.csv", found,
                          stands ? std::optional(header_.geometry.phase_centre) : std::nullopt);
}

std::vector<std::string> Products::finish(std::vector<ChannelReport>& channels, const std::vector<imager::HeaderCard>& cards,
                                          imager::StageTimes& times) {
  std::vector<std::string> removed;
  {
    const imager::StageTimer timer(times, imager::stage::write_images);
    remove_left_over(o_, {paths_, o_.cube.is_cube() ? header_.spectral.channels : 0}, removed);
    for (auto& [name, file] : files_) {
      file.writer->add_cards(cards);
      file.writer->add_cards(file.cards);
    }
    finish_files(Completed::first);
    finish_files(Completed::as_usual);
    if (!in_common_) finish_files(Completed::with_beam);
  }
  if (!in_common_) return removed;
  const imager::StageTimer timer(times, imager::stage::restore);
  restore_in_common(channels);
  finish_files(Completed::with_beam);
  return removed;
}

void Products::finish_files(Completed which) {
  for (auto& [name, file] : files_) {
    if (file.kind.completed != which) continue;
    if (file.kind.masked_by_beam && o_.primary_beam.masks_others() && o_.outformat != "fits")
      file.writer->mask_like(*open_written(o_, product_name("pb", {0, o_.taylor.nterms})));
    file.writer->finish();
  }
}

imager::Image Products::restore(const imager::Image& model, const imager::Image& residual, const imager::Beam& beam) const {
  return imager::restored({model, residual}, beam, header_.geometry.cell_rad, workers_.threads);
}

/// Restores the models and residuals as they were written.
void Products::restore_in_common(std::vector<ChannelReport>& channels) {
  std::vector<imager::Beam> beams;
  for (const ChannelReport& channel : channels)
    if (cleaned(channel)) beams.push_back(*channel.beams->restoring);
  if (beams.empty()) return;
  const imager::Beam common = imager::common_beam(beams);
  const Written written{open_written(o_, "model"), open_written(o_, "residual"),
                        o_.makes_mosaic() ? open_written(o_, "pb") : nullptr};
  imager::parallel_for(channels.size(), workers_.count, [&](std::size_t i) {
    if (cleaned(channels[i])) restore_channel(channels[i], common, written);
  });
}

void Products::restore_channel(ChannelReport& channel, const imager::Beam& common, const Written& written) {
  channel.beams->restoring = common;
  channel.beams->how = "common to all planes";
  OfBeam primary_beam;
  if (written.beams) {
    const std::lock_guard lock(image_files_mutex());
    primary_beam.terms.push_back(written.beams->read({channel.channel, 0}));
    primary_beam.divided_out = o_.mosaic.normtype == "flatsky";
  } else if (primary_beam_ != nullptr) {
    primary_beam.terms.push_back(primary_beam_->at(channel.frequency_hz));
  }
  const auto read = [](const imager::ImageReader& file, const imager::PlaneIndex& at) {
    const std::lock_guard lock(image_files_mutex());
    return file.read(at);
  };
  for (std::size_t s = 0; s < header_.stokes.size(); ++s) {
    const imager::PlaneIndex at{channel.channel, static_cast<int>(s)};
    const imager::Image restored = restore(read(*written.models, at), read(*written.residuals, at), common);
    channel.stokes[s].brightest = imager::find_peak(restored);
    put("image", at, restored, common);
    if (o_.primary_beam.pbcor) write_corrected(at, primary_beam, {&restored}, nullptr, common);
  }
}

}  // namespace misfit::tools
