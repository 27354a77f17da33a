#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <set>

#include "imager/direct/source_sums.h"
#include "imager/numerics/parallel.h"
#include "imager/pointing/seen_sources.h"
#include "ms_io/simulated_set.h"
#include "tools/base/array.h"
#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/base/progress.h"
#include "tools/base/quantity.h"
#include "tools/base/value_checks.h"
#include "tools/command.h"
#include "tools/formats/component_list.h"
#include "tools/formats/pointings.h"
#include "tools/formats/sky.h"
#include "tools/run/dish_beams.h"

namespace misfit::tools {
namespace {

constexpr double j2000_mjd_s = 51544.5 * 86400;  // near where a position of date is that of J2000

struct SimulateOptions {
  std::string output;
  std::string sky = "testcard";
  std::string array = "vla-a";
  bool coplanar = false;
  bool noncoplanar = false;
  bool primary_beam = false;
  std::string beam;
  std::string telescope;       ///< empty: the array's own
  std::vector<double> dishes;  ///< diameters in metres, of the antennas by turns; empty: the array's own
  std::string pointings;       ///< see pointings(); empty: one, --ra and --dec
  std::string cell = "0.05arcsec";
  std::string ra = "60deg";
  std::string dec = "40deg";
  double hours = 0;
  double interval = 10;
  std::string frequency = "4GHz";
  int channels = 1;
  std::string channel_width = "2MHz";
  std::string noise = "0Jy";
  unsigned seed = 1;
  int threads = 0;
  bool quiet = false;
};

void check(const SimulateOptions& o) {
  if (o.channels < 1) throw std::invalid_argument("--channels " + std::to_string(o.channels) + ": expected at least 1");
  if (!(o.hours >= 0)) throw std::invalid_argument("--hours " + std::to_string(o.hours) + ": expected 0 (a snapshot) or more");
  if (!(o.interval > 0))
    throw std::invalid_argument("--interval " + std::to_string(o.interval) + ": expected more than 0 seconds");
  check_beam(o.beam);
  if (!o.beam.empty() && !o.primary_beam)
    throw std::invalid_argument("--beam " + o.beam + " without --primary-beam: expected both, or neither");
  for (const double dish_m : o.dishes)
    if (!(dish_m > 0 && std::isfinite(dish_m)))
      throw std::invalid_argument("--dishes " + significant(dish_m, 3) + ": expected diameters above 0, in metres");
  if (!o.pointings.empty()) check_pointings(o.pointings);
  if (!o.pointings.empty() && o.coplanar)
    throw std::invalid_argument("--pointings " + o.pointings +
                                " with --coplanar: expected one of them, since w is 0 about one phase centre alone");
  if (o.threads < 0) throw std::invalid_argument("--threads " + std::to_string(o.threads) + ": expected 0 (all cores) or more");
  constexpr double most_integrations = 1e7;
  constexpr int most_channels = 1 << 20;
  if (o.channels > most_channels)
    throw std::invalid_argument("--channels " + std::to_string(o.channels) + ": expected at most " +
                                std::to_string(most_channels));
  if (o.hours * 3600 / o.interval > most_integrations)
    throw std::invalid_argument("--hours " + std::to_string(o.hours) + " at --interval " + std::to_string(o.interval) +
                                ": expected at most 10000000 integrations");
  if (!(parse_angle_rad(o.cell) > 0)) throw std::invalid_argument("--cell " + o.cell + ": expected more than 0");
  if (!(parse_flux_jy(o.noise) >= 0)) throw std::invalid_argument("--noise " + o.noise + ": expected 0 or more");
  if (!(parse_frequency_hz(o.frequency) > 0))
    throw std::invalid_argument("--frequency " + o.frequency + ": expected more than 0");
  if (std::abs(parse_angle_rad(o.dec)) > std::numbers::pi / 2)
    throw std::invalid_argument("--dec " + o.dec + ": expected -90deg to 90deg");
}

imager::SkyDirection centre_of(const SimulateOptions& o) {
  return {parse_angle_rad(o.ra), parse_angle_rad(o.dec), "FK5"};
}

std::vector<ms_io::SimulatedField> fields_of(const SimulateOptions& o) {
  if (o.pointings.empty()) return {{"SIMULATED", centre_of(o)}};
  std::vector<ms_io::SimulatedField> fields;
  for (const imager::SkyDirection& direction : pointings(o.pointings, centre_of(o)))
    fields.push_back({"P" + std::to_string(fields.size()), direction});
  return fields;
}

ms_io::SimulatedObservation observation_of(const SimulateOptions& o, const AntennaArray& array) {
  ms_io::SimulatedObservation observation;
  observation.telescope = o.telescope.empty() ? array.telescope : o.telescope;
  observation.antenna_name = array.name;
  observation.antenna_itrf_m = array.itrf_m;
  observation.dish_diameter_m = o.dishes.empty() ? std::vector<double>{array.dish_diameter_m} : o.dishes;
  observation.fields = fields_of(o);
  observation.interval_s = o.interval;
  observation.channel_width_hz = parse_frequency_hz(o.channel_width);
  for (int channel = 0; channel < o.channels; ++channel)
    observation.frequency_hz.push_back(parse_frequency_hz(o.frequency) + channel * observation.channel_width_hz);
  observation.noise_jy = parse_flux_jy(o.noise);
  observation.seed = o.seed;
  const double transit = transit_mjd_s(array, centre_of(o), j2000_mjd_s);
  const auto visits = static_cast<long>(observation.fields.size());  // each field is seen once at least
  const auto integrations = std::max(visits, std::lround(o.hours * 3600 / o.interval));
  for (long i = 0; i < integrations; ++i)
    observation.time_mjd_s.push_back(transit +
                                     (static_cast<double>(i) - 0.5 * static_cast<double>(integrations - 1)) * o.interval);
  return observation;
}

/// The beams of an observation's rows, about each field's own phase centre; prints doubts about them.
imager::RowBeams beams_of(const SimulateOptions& o, const ms_io::SimulatedObservation& observation, ProgressLine& progress) {
  const DishBeams beams(o.beam);
  std::vector<imager::Pattern> of_diameter, of_antenna;
  std::set<std::string> doubts;
  for (const double diameter_m : observation.dish_diameter_m) {
    const imager::BeamModel model = beams.of({observation.telescope, diameter_m});
    of_diameter.push_back(model.pattern);
    for (const double hz : {observation.frequency_hz.front(), observation.frequency_hz.back()})
      if (const std::string doubt = model.doubt_at(hz); !doubt.empty() && doubts.insert(doubt).second)
        progress.say("warning: " + doubt);
  }
  for (std::size_t a = 0; a < observation.antenna_name.size(); ++a) of_antenna.push_back(of_diameter[a % of_diameter.size()]);
  std::vector<imager::AxisFrame> frames;
  for (const ms_io::SimulatedField& field : observation.fields) frames.push_back({{}, field.phase_centre.dec_rad});
  return {std::move(of_antenna), std::move(frames)};
}

/// Sources about `from`, as seen from another phase centre; without those beyond its horizon.
std::vector<imager::Source> moved(const std::vector<imager::Source>& sources, const imager::SkyDirection& from,
                                  const imager::SkyDirection& to) {
  if (from.ra_rad == to.ra_rad && from.dec_rad == to.dec_rad) return sources;
  std::vector<imager::Source> seen;
  for (imager::Source source : sources) {
    try {
      source.position = imager::direction_cosines(imager::sky_direction(source.position, from), to);
    } catch (const std::invalid_argument&) {
      continue;
    }
    seen.push_back(source);
  }
  return seen;
}

void simulate(const SimulateOptions& o) {
  check(o);
  const AntennaArray array = antenna_array(o.array);
  const ms_io::SimulatedObservation observation = observation_of(o, array);
  if (o.dishes.size() > array.name.size())
    throw std::invalid_argument("--dishes with " + std::to_string(o.dishes.size()) + " diameters: expected at most " +
                                std::to_string(array.name.size()) + ", as many as " + o.array + " has antennas");
  const bool test_card_sky = o.sky == "testcard";
  const bool coplanar = o.coplanar || (test_card_sky && !o.noncoplanar && o.pointings.empty());
  const std::vector<imager::Source> sources =
      test_card_sky ? test_card(parse_angle_rad(o.cell)) : read_component_list(o.sky, centre_of(o));
  const int threads = o.threads == 0 ? imager::available_threads() : o.threads;

  ProgressLine progress(o.quiet);
  std::size_t unseen = 0;
  for (const ms_io::SimulatedField& field : observation.fields)
    unseen += sources.size() - moved(sources, centre_of(o), field.phase_centre).size();
  if (unseen > 0)
    progress.say("warning: sources lie beyond the horizons of pointings, and are left out there: " + std::to_string(unseen) +
                 " in all");
  progress.begin("simulate");
  const std::optional<imager::RowBeams> beams =
      o.primary_beam ? std::optional(beams_of(o, observation, progress)) : std::nullopt;
  float zenith_rad = 0;
  const auto baselines = [&](std::size_t integration) {
    const imager::SkyDirection& centre = observation.fields[observation.field_of(integration)].phase_centre;
    const LocalDirection source{hour_angle_rad(array, centre, observation.time_mjd_s[integration]), centre.dec_rad};
    zenith_rad = static_cast<float>(parallactic_angle_rad(array, source));
    std::vector<double> baseline = uvw(array, source);
    if (coplanar)
      for (std::size_t i = 2; i < baseline.size(); i += 3) baseline[i] = 0;
    return baseline;
  };
  const auto exact = [&](imager::SampleCoordinates at) {
    const auto field = static_cast<std::size_t>(at.sights.front().field);
    const std::vector<imager::Source> here = moved(sources, centre_of(o), observation.fields[field].phase_centre);
    for (imager::RowSight& sight : at.sights) sight.zenith_rad = zenith_rad;
    return beams ? imager::predict_seen_sources(here, *beams, at, threads) : imager::predict_sources(here, at, threads);
  };
  ms_io::write_simulated_set(o.output, observation, baselines, exact,
                             [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  progress.end();
  const std::size_t antennas = array.name.size();
  const auto visibilities = antennas * (antennas - 1) / 2 * observation.time_mjd_s.size() * observation.frequency_hz.size();
  const std::size_t fields = observation.fields.size();
  if (!o.quiet)
    std::printf("%s: %s visibilities of %zu sources, %s%s, w %s\n", o.output.c_str(),
                grouped(static_cast<long long>(visibilities)).c_str(), sources.size(), o.array.c_str(),
                fields == 1 ? "" : (", " + std::to_string(fields) + " pointings").c_str(), coplanar ? "= 0" : "kept");
}

}  // namespace

void add_simulate_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("simulate", "Write a MeasurementSet with exact visibilities of points and Gaussians");
  const auto o = std::make_shared<SimulateOptions>();
  command->add_option("--output", o->output, "MeasurementSet to write")->required()->type_name(path_type)->check(not_empty());
  command
      ->add_option(
          "--sky", o->sky,
          "testcard: the 34 sources of Ye et al. 2020; or a CSV file of sources, as for --components of misfit predict")
      ->type_name(name_or_file_type)
      ->check(values_are({"testcard"}, Others::possible));
  command->add_option("--array", o->array, "Antennas: the VLA in its A, B, C or D configuration")
      ->check(values_are({"vla-a", "vla-b", "vla-c", "vla-d"}));
  CLI::Option* coplanar =
      command->add_flag("--coplanar", o->coplanar, "Set w to 0; the default with --sky testcard, unless there are --pointings");
  command->add_flag("--noncoplanar", o->noncoplanar, "Keep w; the default with --pointings and with other skies")
      ->excludes(coplanar);
  command->add_flag("--primary-beam", o->primary_beam,
                    "Multiply the sources by the dishes' primary beam about their pointing, at each channel's frequency; "
                    "Gaussians are multiplied by the beam at their middle");
  command
      ->add_option("--beam", o->beam,
                   "Primary beam that --primary-beam uses instead of the telescope's; values as for --beam of misfit image")
      ->type_name(name_or_file_type);
  command->add_option("--telescope", o->telescope, "Name of the telescope in the set instead of EVLA, such as ALMA");
  command
      ->add_option("--dishes", o->dishes,
                   "Diameters of the antennas in metres, repeated in this order: 12,7 makes antennas of 12, 7, 12, 7, … m; 25 "
                   "when empty")
      ->delimiter(',');
  command
      ->add_option("--pointings", o->pointings,
                   "Fields to observe: hex,N,SPACING, the N points of a hexagonal lattice nearest to --ra and --dec, SPACING "
                   "apart; or a CSV file of ra_deg,dec_deg. Integrations visit the fields in turn, each field at least once")
      ->type_name(name_or_file_type);
  command->add_option("--cell", o->cell, "Cell size of the test card")->check(quantity(parse_angle_rad));
  command->add_option("--ra", o->ra, "Right ascension of the phase centre, J2000")->check(quantity(parse_angle_rad));
  command->add_option("--dec", o->dec, "Declination of the phase centre, J2000")->check(quantity(parse_angle_rad));
  command->add_option("--hours", o->hours, "Length of the track around transit, in hours; 0 means a snapshot");
  command->add_option("--interval", o->interval, "Integration time in seconds");
  command->add_option("--frequency", o->frequency, "Frequency of the first channel")->check(quantity(parse_frequency_hz));
  command->add_option("--channels", o->channels, "Number of channels");
  command->add_option("--channel-width", o->channel_width, "Channel spacing")->check(quantity(parse_frequency_hz));
  command
      ->add_option("--noise", o->noise,
                   "Standard deviation of the noise in the real and in the imaginary part of each correlation")
      ->check(quantity(parse_flux_jy));
  command->add_option("--seed", o->seed, "Seed of the noise");
  command->add_option("--threads", o->threads, "Threads; 0 means all cores");
  command->add_flag("--quiet", o->quiet, "Print nothing but errors");
  check_before_missing(*command, [o] { check(*o); });
  command->callback([o] { simulate(*o); });
}

}  // namespace misfit::tools
