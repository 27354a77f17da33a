#include "tools/run/scale_forecast.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <optional>
#include <utility>

#include "imager/clean/components.h"
#include "tools/base/memory.h"
#include "tools/base/numbers.h"
#include "tools/run/sharing.h"

namespace misfit::tools {
namespace {

/// Bytes that a rank takes in and adds to its own in a second, as measured of two ranks of one machine.
constexpr double added_bytes_s = 4.2e9;
constexpr double turned_sample_s = 1e-8;  ///< to a facet's own phase centre, on one core

int levels_of(int nodes) {
  int levels = 0;
  while ((1LL << levels) < nodes) ++levels;
  return levels;
}

/// The part of a node's seconds that a stage's work belongs to.
double& part_of(NodeSeconds& seconds, const std::string& stage) {
  if (stage == imager::stage::read) return seconds.read;
  if (stage == imager::stage::fft) return seconds.fft;
  for (const char* shared : {imager::stage::grid, imager::stage::degrid, imager::stage::weights, imager::stage::verify,
                             imager::stage::planes, imager::stage::sources_outside, imager::stage::primary_beam})
    if (stage == shared) return seconds.gridding;
  return seconds.first;
}

NodeSeconds operator-(const NodeSeconds& a, const NodeSeconds& b) {
  return {a.read - b.read, a.gridding - b.gridding, a.fft - b.fft, a.exchange - b.exchange, a.first - b.first};
}

bool is_of_files(const StageSeconds& stage) {
  return stage.stage == imager::stage::write_images || stage.stage == imager::stage::draw_pictures;
}

std::string bytes_text(double bytes) {
  const char* const units[] = {"B", "KiB", "MiB", "GiB", "TiB", "PiB"};
  std::size_t unit = 0;
  while (bytes >= 1024 && unit + 1 < std::size(units)) {
    bytes /= 1024;
    ++unit;
  }
  return significant(bytes, 3) + " " + units[unit];
}

std::string column(const std::string& text, int width) {
  std::string padded(text);
  int shown = 0;  // characters, not bytes
  for (const char c : text) shown += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
  padded.insert(0, static_cast<std::size_t>(std::max(0, width - shown)), ' ');
  return padded;
}

}  // namespace

/// The image in facets, each planned for itself.
class ScaleForecast::Facets {
 public:
  Facets(const imager::GriddingRequest& whole, int along_a_side) : count(along_a_side * along_a_side) {
    imager::GriddingRequest request = whole;
    for (int* side : {&request.geometry.width, &request.geometry.height}) *side = (*side + along_a_side - 1) / along_a_side;
    plan = imager::plan_gridding(request);
  }

  int count;
  imager::GriddingPlan plan;
};

ScaleForecast::ScaleForecast(const RunScene& scene, const RunPlan& plan, const TimeForecast& forecast, const RunWork& work)
    : scene_(scene), plan_(plan), forecast_(forecast), work_(work), clean_(scene.options.clean.runs()) {}

RunWork ScaleForecast::work_of_a_node(int nodes) const {
  RunWork work = work_;
  work.rows /= nodes;
  work.samples /= nodes;
  work.verified /= nodes;
  work.ranks = nodes;
  return work;
}

/// The seconds of a second cycle, which has no part in work that is done once after the last.
NodeSeconds ScaleForecast::cycle_seconds(const RunWork& work) const {
  const int components = components_of_a_cycle(scene_.options);
  return seconds_of(with_cycles(work, 2, components)) - seconds_of(with_cycles(work, 1, components));
}

NodeSeconds ScaleForecast::seconds_of(const RunWork& work) const {
  NodeSeconds seconds;
  for (const StageSeconds& stage : forecast_.expected(work, work_)) part_of(seconds, stage.stage) += stage.seconds;
  return seconds;
}

double ScaleForecast::taking_in_seconds(double bytes) const {
  return bytes * (1 / (scene_.options.scale.network_bytes_s()) + 1 / added_bytes_s);
}

/// The seconds of a sum along nodes: the first piece passes all nodes, and the others follow.
double ScaleForecast::sum_seconds(int nodes, double bytes) const {
  if (nodes == 1) return 0;
  if (!imager::pass_along_ranks(nodes, static_cast<std::size_t>(bytes) / sizeof(double))) return tree_seconds(nodes, bytes);
  const double piece = std::min(bytes, 1.0 * sizeof(double) * imager::chain_piece);
  return taking_in_seconds(bytes + (nodes - 2) * piece);
}

/// The seconds of the sum in a binomial tree, where rank 0 takes in a whole image from each of its branches.
double ScaleForecast::tree_seconds(int nodes, double bytes) const {
  return levels_of(nodes) * taking_in_seconds(bytes);
}

void ScaleForecast::set_memory(NodeForecast& forecast, double samples) const {
  const ImageOptions& o = scene_.options;
  const double room = o.memory_gib > 0 ? o.memory_gib * gib : physical_memory_bytes() / 2;
  const double channels = std::max(1.0, work_.samples / std::max(1.0, work_.rows));
  const double sample =
      1.0 * plan_.gridding.request.stokes * sizeof(std::complex<float>) + sizeof(float) + 3 * sizeof(double) / channels;
  const double others = plan_.memory.total() - plan_.memory.visibilities;
  forecast.kept = others + samples * sample <= room;
  forecast.memory_bytes = others + (forecast.kept ? samples * sample : 0);
  // Data, flags and weights of two correlations for each Stokes parameter; UVW, antennas, times and flags of a row.
  constexpr double row_bytes = 3 * sizeof(double) + 2 * sizeof(int) + sizeof(double) + 2 * sizeof(float) + 1;
  forecast.read_bytes = samples * (2 * (sizeof(std::complex<float>) + 1) + row_bytes / channels);
}

NodeForecast ScaleForecast::at(int nodes) const {
  if (scene_.channels > 1) return channel_forecast(nodes);
  NodeForecast node;
  node.sharing.nodes = nodes;
  RunWork work = work_of_a_node(nodes);
  set_memory(node, work.samples);
  work.kept = node.kept;
  node.image = seconds_of(work);
  const int stokes = plan_.gridding.request.stokes, terms = scene_.options.taylor.nterms;
  const ExchangeForecast exchange = exchange_of(work.pixels, 3 * terms - 2 + stokes, terms);
  if (nodes > 1) node.image_bytes = exchange.first_bytes;
  node.image.exchange = sum_seconds(nodes, node.image_bytes);
  if (!clean_) return node;
  node.cycle = cycle_seconds(work);
  if (nodes > 1) node.cycle_bytes = exchange.cycle_bytes;
  const double model_s =
      components_of_a_cycle(scene_.options) * sizeof(imager::Component) / (scene_.options.scale.network_bytes_s());
  node.cycle.exchange = sum_seconds(nodes, node.cycle_bytes) + levels_of(nodes) * model_s;
  return node;
}

/// The forecast of a cube. Planes wait for no others, but rank 0 gets and writes all.
NodeForecast ScaleForecast::channel_forecast(int nodes) const {
  const int channels = (scene_.channels + nodes - 1) / nodes;
  RunWork work = work_;
  work.channels = channels;
  work.samples *= 1.0 * channels / scene_.channels;
  work.workers = std::min(work_.workers, channels);
  work.ranks = 1;
  if (channels == 1) work.threads = scene_.threads;
  NodeForecast node;
  node.sharing.nodes = nodes;
  set_memory(node, work.samples);
  node.kept = work.kept;
  node.memory_bytes = plan_.memory.total();  // which holds as many channels as it has room for
  for (const StageSeconds& stage : forecast_.expected(work, work_)) {
    double& part = part_of(node.image, stage.stage);
    if (!is_of_files(stage)) (&part == &node.image.first ? node.image.gridding : part) += stage.seconds;
  }
  for (const StageSeconds& stage : forecast_.expected(work_))
    if (is_of_files(stage)) node.image.first += stage.seconds;
  if (nodes > 1) node.image_bytes = channel_bytes(work) * channels;
  node.image.exchange = node.image_bytes * (nodes - 1) / (scene_.options.scale.network_bytes_s());
  if (!clean_) return node;
  node.cycle = cycle_seconds(work);
  node.cycle.gridding += std::exchange(node.cycle.first, 0);
  return node;
}

NodeForecast ScaleForecast::facet_forecast(int nodes, const Facets& facets) const {
  const int group = nodes / facets.count;  // nodes that share the samples
  const double network = scene_.options.scale.network_bytes_s();
  const NodeForecast rows = at(nodes);
  NodeForecast node = rows;
  node.sharing.facets = facets.count;
  RunWork work = work_of_a_node(group);
  const double samples = work.samples, threads = work.threads, all_images = sizeof(double) * work.pixels;
  set_memory(node, samples);
  work.kept = node.kept;
  work.plan = &facets.plan;
  const NodeSeconds image = seconds_of(work), cycle = cycle_seconds(work);
  const double turned_s = turned_sample_s * samples / threads;
  const auto share = [&](NodeSeconds& is, const NodeSeconds& of_a_facet, double bytes) {
    is.gridding = of_a_facet.gridding + turned_s;
    is.fft = of_a_facet.fft;
    // A group sums its facet; rank 0 gets them all.
    is.exchange = sum_seconds(group, bytes / facets.count) + bytes * (facets.count - 1) / facets.count / network;
  };
  share(node.image, image, rows.image_bytes);
  node.image.read = image.read;
  if (!clean_) return node;
  share(node.cycle, cycle, rows.cycle_bytes);
  node.cycle.gridding += turned_s;
  node.cycle.read = cycle.read;
  // The sums of the facets' models at each sample; and the model, which is of the whole image.
  const double sums = 2.0 * (facets.count - 1) / facets.count;
  node.cycle.exchange += sums * samples * sizeof(std::complex<double>) / network;
  node.memory_bytes = std::max(2 * all_images, node.memory_bytes);
  return node;
}

NodeForecast ScaleForecast::best_facets(int nodes) const {
  constexpr int least_side = 256;  // pixels
  const imager::ImageGeometry& g = scene_.geometry;
  NodeForecast best = at(nodes);
  if (scene_.channels > 1 || plan_.gridding.direct) return best;
  for (int side = 2; side * side <= nodes && std::min(g.width, g.height) / side >= least_side; side *= 2) {
    const NodeForecast one = facet_forecast(nodes, Facets(plan_.gridding.request, side));
    if (one.shown(clean_).total() < best.shown(clean_).total()) best = one;
  }
  return best;
}

int ScaleForecast::limit() const {
  constexpr int most = 1 << 20;
  constexpr double least_gain = 1.25;
  int nodes = 1;
  while (nodes < most && at(nodes).shown(clean_).total() >= least_gain * at(2 * nodes).shown(clean_).total()) nodes *= 2;
  return nodes;
}

std::string ScaleForecast::row(const NodeForecast& node) const {
  const NodeSeconds& s = node.shown(clean_);
  const double alone = at(1).shown(clean_).total();
  std::string line = column(grouped(node.sharing.nodes), 9);
  for (const double seconds : {s.total(), s.read, s.gridding, s.fft, s.exchange, s.first})
    line += column(duration(seconds), 15);
  const double used = 100 * alone / s.total() / node.sharing.nodes;
  line += column(used < 0.1 ? "<0.1%" : significant(used, 2) + "%", 8);
  const bool reads = !clean_ || !node.kept;
  for (const double bytes : {reads ? node.read_bytes : 0, clean_ ? node.cycle_bytes : node.image_bytes, node.memory_bytes})
    line += column(bytes_text(bytes), 11);
  return line + "\n";
}

std::string ScaleForecast::why(const NodeForecast& node) const {
  const NodeSeconds& s = node.shown(clean_);
  const std::string of = " of " + duration(s.total());
  if (scene_.channels > 1 && s.first + s.exchange < s.gridding)
    return "there are " + std::to_string(scene_.channels) + " planes, and a node makes one at least: " + duration(s.gridding) +
           of;
  if (s.exchange >= s.fft && s.exchange >= s.first)
    return "images come to rank 0: " + duration(s.exchange) + of + ", for " +
           bytes_text(clean_ ? node.cycle_bytes : node.image_bytes) + " from every node";
  if (s.fft >= s.first) return "every node transforms the whole image: " + duration(s.fft) + of;
  return std::string(clean_ ? "minor cycles and statistics are" : "statistics and files are") +
         " rank 0's alone: " + duration(s.first) + of;
}

std::string ScaleForecast::table() const {
  const ScaleOptions& asked = scene_.options.scale;
  const std::string what = scene_.channels > 1 ? (clean_ ? "a major cycle of every plane" : "the cube")
                           : clean_ ? "a major cycle of " + grouped(components_of_a_cycle(scene_.options)) + " components"
                                    : "dirty image and PSF";
  std::string text = "nodes: time of " + what + ", for " + grouped(std::llround(work_.samples)) + " samples on nodes of " +
                     std::to_string(scene_.threads) + " threads, with " + significant(asked.network_bytes_s() / 1e9, 3) +
                     " GB/s between them\n";
  text += column("nodes", 9);
  for (const char* name : {"total", "read", "gridding", "FFTs", "exchange", "rank 0"}) text += column(name, 15);
  text += column("used", 8);
  for (const char* name : {"reads", "gives", "holds"}) text += column(name, 11);
  text += "\n";
  for (int nodes = 1; nodes < asked.nodes; nodes *= 2) text += row(at(nodes));
  text += row(at(asked.nodes));
  const int stop = limit();
  const NodeForecast there = at(stop), twice = at(2 * stop);
  text += "nodes: more than " + grouped(stop) + " do not help: twice as many are " +
          significant(there.shown(clean_).total() / twice.shown(clean_).total(), 3) + " times as fast; " + why(twice) + "\n";
  const double bytes = clean_ ? at(asked.nodes).cycle_bytes : at(asked.nodes).image_bytes;
  if (const double tree_s = tree_seconds(asked.nodes, bytes);
      scene_.channels == 1 && sum_seconds(asked.nodes, bytes) < 0.9 * tree_s)
    text += "nodes: images are added up on their way along the nodes, in pieces: " + duration(sum_seconds(asked.nodes, bytes)) +
            " of " + grouped(asked.nodes) + " nodes, where a tree would take " + duration(tree_s) + "\n";
  std::optional<int> before;
  for (const int nodes : {asked.nodes, 4 * stop}) {
    if (before == nodes || scene_.channels > 1) continue;
    before = nodes;
    const NodeForecast rows = at(nodes), facets = best_facets(nodes);
    const std::string of = "nodes: facets shared among " + grouped(nodes);
    if (facets.sharing.facets == 1) {
      text += of + " would gain nothing\n";
      continue;
    }
    const NodeSeconds& s = facets.shown(clean_);
    text += of + ", " + std::to_string(facets.sharing.facets) + " of them, would take " + duration(s.total()) + " instead of " +
            duration(rows.shown(clean_).total()) + ": gridding " + duration(s.gridding) + ", FFTs " + duration(s.fft) +
            ", exchange " + duration(s.exchange) + ", rank 0 " + duration(s.first) + "\n";
  }
  return text;
}

}  // namespace misfit::tools
