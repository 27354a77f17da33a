#include "tools/formats/model_image.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "imager/data/extent.h"
#include "imager/plan/planned_transform.h"
#include "imager/taylor/taylor_prediction.h"
#include "tools/base/numbers.h"
#include "tools/formats/image_file.h"

namespace misfit::tools {
namespace {

/// The part of the accuracy that misplaced pixels may take.
constexpr double misplaced_part = 0.3;

void check_pixels(const imager::SkyImage& model, const std::string& path) {
  for (int row = 0; row < model.image.height; ++row)
    for (int column = 0; column < model.image.width; ++column) {
      const double value = model.image.at(row, column);
      const bool finite = std::isfinite(value), beyond = imager::beyond_horizon(model.geometry.at(row, column));
      if (!finite && !beyond)
        throw std::runtime_error(path + " has no finite value in pixel " + std::to_string(column + 1) + ", " +
                                 std::to_string(row + 1) +
                                 ", or its own mask leaves that pixel out; expected a number in each pixel above the horizon");
      if (finite && beyond && value != 0)
        throw std::runtime_error(path + " has " + significant(value, 6) + " Jy in pixel " + std::to_string(column + 1) + ", " +
                                 std::to_string(row + 1) +
                                 ", which lies beyond the horizon of its reference; expected 0 there");
    }
}

char lower(char letter) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
}

/// True if a unit is Jy/pixel, which programs write in upper and lower case.
bool is_jy_per_pixel(std::string unit) {
  for (char& letter : unit) letter = lower(letter);
  return unit == "jy/pixel";
}

void check_model(const imager::SkyImage& model, const std::string& path) {
  if (!is_jy_per_pixel(model.unit))
    throw std::runtime_error(path + " has the unit " + (model.unit.empty() ? "none" : model.unit) + ", expected Jy/pixel");
  check_pixels(model, path);
}

bool parts_names(char letter) {
  return letter == '.' || letter == '_' || letter == '-';
}

/// The Taylor term in a path: ".tt" and a number in the file's own name, before a dot or its end; people also write "_tt" and
/// "-tt".
struct TermInName {
  std::string before;  ///< "x.model.tt"
  int term = 0;
  std::string after;  ///< ".fits", ""

  std::string path_of(int other) const { return before + std::to_string(other) + after; }
};

std::optional<TermInName> term_in_name(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  const std::size_t name = path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1;
  for (std::size_t at = path.size(); at-- > name;) {
    if (!parts_names(path[at])) continue;
    const std::size_t number = at + 3;
    const auto next = std::find_if(path.begin() + static_cast<std::ptrdiff_t>(at) + 1, path.end(), parts_names);
    const auto end = static_cast<std::size_t>(next - path.begin());
    int term = 0;
    const bool is_term = end > number && lower(path[at + 1]) == 't' && lower(path[at + 2]) == 't' &&
                         std::from_chars(path.data() + number, path.data() + end, term).ptr == path.data() + end;
    if (is_term && term >= 0) return TermInName{path.substr(0, number), term, path.substr(end)};
  }
  return {};
}

/// The file that `path` leads to by links; `path` itself where it is no link.
std::string behind_links(const std::string& path) {
  std::error_code none;
  const std::filesystem::path file = std::filesystem::canonical(path, none);
  return none ? path : file.string();
}

/// The other terms that lie beside it.
std::string other_terms(const TermInName& name) {
  std::string found;
  for (int term = 0; term < 10; ++term)
    if (std::error_code absent; term != name.term && std::filesystem::exists(name.path_of(term), absent))
      found += (found.empty() ? "" : ", ") + name.path_of(term);
  return found;
}

constexpr const char* models_of_terms =
    "misfit predict reads no models of several terms, but misfit image --savemodel modelcolumn predicts all that it finds; "
    "--startmodel reads all terms of --nterms, named one after the other, and --restart goes on from them";

[[noreturn]] void refuse_by_name(const TermInName& name, const std::string& path) {
  const std::string others = other_terms(name);
  if (name.term > 0)
    throw std::runtime_error(path + " is by its name Taylor term " + std::to_string(name.term) +
                             ", which is how brightness changes with frequency, and no brightness; " +
                             (others.empty() ? "there is no " + name.path_of(0) + " beside it" : "beside it lies " + others) +
                             "; expected a model of one term. " + models_of_terms);
  throw std::runtime_error(path + " is by its name the first of several Taylor terms, " +
                           (others.empty() ? "but there is no " + name.path_of(1) + " beside it"
                                           : "and would be taken without " + others + ", as if spectra were flat") +
                           "; expected a model of one term, which it is under a name without .tt0, of flat spectra. " +
                           models_of_terms);
}

[[noreturn]] void refuse_by_header(const imager::TaylorTerm& taylor, const std::string& path) {
  throw std::runtime_error(
      path + " is by its header Taylor term " + std::to_string(taylor.order) + " of " + std::to_string(taylor.terms) +
      ", counted from 0, " +
      (taylor.order > 0 ? "which is how brightness changes with frequency, and no brightness; expected a model of one term. "
                        : "and would be taken without the others, as if spectra were flat; expected a model of one term, which "
                          "it is without " +
                              std::string(imager::taylor_order_key) + " and " + imager::taylor_terms_key +
                              " in its header, of flat spectra. ") +
      models_of_terms);
}

}  // namespace

void refuse_taylor_term(const imager::ImageReader& file, const std::string& path) {
  if (const auto name = term_in_name(path)) refuse_by_name(*name, path);
  const std::string target = behind_links(path);
  if (const auto name = term_in_name(target)) refuse_by_name(*name, path + " leads to " + target + ", which");
  if (file.header().taylor.several()) refuse_by_header(file.header().taylor, path);
}

void require_taylor_term(const imager::ImageReader& file, const std::string& path, int order,
                         const imager::TaylorExpansion& expansion) {
  const imager::TaylorTerm expected{order, expansion.terms};
  const auto refuse = [&](const std::string& by, const std::string& is) {
    throw std::runtime_error(path + " is by its " + by + " Taylor term " + is + ", counted from 0; expected term " +
                             std::to_string(expected.order) + " of " + std::to_string(expected.terms) +
                             ", as terms are named from the first on and as many as --nterms");
  };
  for (const std::string& name : {path, behind_links(path)})
    if (const auto term = term_in_name(name); term && term->term != expected.order) refuse("name", std::to_string(term->term));
  const imager::TaylorTerm& stated = file.header().taylor;
  if (stated.several() && (stated.order != expected.order || stated.terms != expected.terms))
    refuse("header", std::to_string(stated.order) + " of " + std::to_string(stated.terms));
  constexpr double rounding = 1e-9;
  const double hz = file.header().observation.frequency_hz;
  if (!(std::abs(hz / expansion.reference_hz - 1) < rounding))
    throw std::runtime_error(path + " has spectra about " + frequency_text(hz, 10) + ", expected spectra about " +
                             frequency_text(expansion.reference_hz, 10) + ", or --reffreq " + significant(hz / 1e9, 12) +
                             "GHz");
}

namespace {

/// The .weight of a mosaic whose model has this path.
std::string weight_path(const std::string& model) {
  constexpr char part[] = ".model";
  const std::size_t at = model.rfind(part);
  if (at == std::string::npos) return "";
  return model.substr(0, at) + ".weight" + model.substr(at + sizeof part - 1);
}

}  // namespace

void divide_by_sensitivity(std::vector<imager::SkyImage>& planes, const ModelChannel& of) {
  const std::string& path = of.path;
  const std::string other = weight_path(path);
  if (std::error_code absent; other.empty() || !std::filesystem::exists(other, absent))
    throw std::runtime_error(path + " has the sky times a mosaic's primary beam, as its " + imager::flat_noise_key +
                             " says; expected the mosaic's .weight beside it" + (other.empty() ? "" : ", " + other));
  const auto file = open_image_file(other);
  if (of.channel >= file->header().spectral.channels)
    throw std::runtime_error(other + " has " + std::to_string(file->header().spectral.channels) +
                             " planes; expected those of " + path);
  const imager::Image weight = file->read({of.channel, 0});
  const double most = imager::largest_magnitude(weight);
  for (imager::SkyImage& plane : planes) {
    if (weight.width != plane.image.width || weight.height != plane.image.height)
      throw std::runtime_error(other + " has " + std::to_string(weight.width) + " × " + std::to_string(weight.height) +
                               " pixels; expected those of " + path);
    for (std::size_t i = 0; i < plane.image.pixel.size(); ++i) {
      double& pixel = plane.image.pixel[i];
      if (pixel == 0) continue;
      pixel /= std::sqrt(weight.pixel[i] / most);
      if (!std::isfinite(pixel)) throw std::runtime_error(path + " has flux where " + other + " is 0; expected none there");
    }
  }
}

std::vector<imager::SkyImage> read_stokes_model(const imager::ImageReader& file, const std::string& path) {
  refuse_taylor_term(file, path);
  const int channels = file.header().spectral.channels;
  if (channels > 1)
    throw std::runtime_error(path + " has planes of " + std::to_string(channels) + " frequencies; expected one");
  std::vector<imager::SkyImage> planes = read_model_channel(file, {path, 0});
  if (file.header().flat_noise) divide_by_sensitivity(planes, {path, 0});
  return planes;
}

std::vector<imager::SkyImage> read_model_channel(const imager::ImageReader& file, const ModelChannel& of) {
  std::vector<imager::SkyImage> planes = imager::read_channel(file, of.channel);
  for (const imager::SkyImage& plane : planes) check_model(plane, of.path);
  return planes;
}

std::string band_warning(const imager::Observation& model, const imager::Observation& data, const std::string& path) {
  if (!bands_apart(model, data)) return "";
  return "the model " + path + " is of " + frequency_text(model.frequency_hz, 6) + ", and the data of " +
         frequency_text(data.frequency_hz, 6) + ": its fluxes are taken as they are";
}

std::string misplacement_warning(const imager::ImageReader& file, const std::string& path, const ms_io::MeasurementSet& set,
                                 double accuracy) {
  const imager::UprightGeometry upright = imager::upright_geometry(file.grid().value());
  if (upright.difference.empty()) return "";
  const imager::UvwReach reach = set.reach(ms_io::ReachOf::all);
  const double distance_rad = upright.off_pixels * std::min(upright.geometry.cell_rad, upright.geometry.cell_height_rad());
  const double error = 2 * M_PI * std::hypot(reach.max_abs_u, reach.max_abs_v, reach.max_abs_w) * distance_rad;
  if (!(error > misplaced_part * accuracy)) return "";
  return "pixels of the model " + path + " lie up to " + significant(upright.off_pixels, 2) +
         " pixels from where they are taken to lie (" + upright.difference + "): visibilities may be wrong by another " +
         significant(error, 2) + " of the model's flux, beside the --accuracy of " + significant(accuracy, 2) +
         "; regrid it first, as with CASA's imregrid";
}

imager::GriddingRequest prediction_request(imager::GriddingRequest request, const imager::ImageGeometry& geometry,
                                           const ms_io::MeasurementSet& set) {
  request.geometry = geometry;
  const std::vector<std::uint64_t> samples = set.sharing().samples;
  request.samples = std::accumulate(samples.begin(), samples.end(), std::uint64_t{0});
  request.psf = false;
  request.max_abs_w = set.reach(ms_io::ReachOf::all).max_abs_w;
  return request;
}

ModelVisibilities image_visibilities(const StokesPlanes& planes, const imager::ImageGeometry& geometry,
                                     const imager::GriddingRequest& request, const ms_io::MeasurementSet& set,
                                     const TaylorTerms& taylor) {
  ModelVisibilities model;
  model.transform =
      std::make_unique<imager::PlannedTransform>(imager::plan_gridding(prediction_request(request, geometry, set)));
  std::array<const imager::Prediction*, 4> of{};
  for (std::size_t k = 0; k < planes.size(); ++k) {
    if (planes[k] == nullptr) continue;
    const std::vector<const imager::Image*>& further = taylor.further[k];
    if (further.empty()) {
      model.predictions[k] = model.transform->predict(*planes[k]);
    } else {
      std::vector<imager::Image> terms;
      terms.push_back(*planes[k]);
      for (const imager::Image* term : further) terms.push_back(*term);
      model.predictions[k] = std::make_unique<imager::TaylorPrediction>(*model.transform, std::move(terms), taylor.expansion);
    }
    of[k] = model.predictions[k].get();
    model.samples_at_once = std::max<std::uint64_t>(model.samples_at_once, of[k]->samples_at_once());
  }
  model.predict = [of](const imager::SampleCoordinates& at) {
    ms_io::StokesVisibilities visibilities;
    for (std::size_t k = 0; k < of.size(); ++k)
      if (of[k] != nullptr) visibilities.plane[k] = of[k]->at(at);
    return visibilities;
  };
  return model;
}

}  // namespace misfit::tools
