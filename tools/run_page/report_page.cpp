#include "tools/run_page/report_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "tools/base/numbers.h"
#include "tools/report/html.h"
#include "tools/report/html_elements.h"
#include "tools/report/report_values.h"
#include "tools/run_page/clean_section.h"
#include "tools/run_page/cube_section.h"
#include "tools/run_page/outside_section.h"
#include "tools/run_page/time_section.h"

namespace misfit::tools {
namespace {

using html::Row;
using html::section;
using html::table;
using html::tag;
using nlohmann::json;

std::string relative(const json& value) {
  return value.is_number() ? html_power(value.get<double>()) : not_measured;
}

/// "0.52 × 0.51″" and the position angle in small, or nothing.
std::string beam_size(const json& beam, const std::string& before) {
  const json& major = member(beam, "major_arcsec");
  const json& minor = member(beam, "minor_arcsec");
  const json& angle = member(beam, "pa_deg");
  if (!major.is_number() || !minor.is_number() || !angle.is_number()) return "";
  const bool tiny = major.get<double>() < 0.1;
  const double scale = tiny ? 1000 : 1;
  const std::string size =
      significant(major.get<double>() * scale, 3) + " × " + significant(minor.get<double>() * scale, 3) + (tiny ? " mas" : "″");
  const std::string at = significant(angle.get<double>(), 3) + "°";
  return before.empty() ? size + tag("small", "position angle " + at) : tag("small", before + " " + size + " at " + at);
}

std::string beam_text(const json& report) {
  const json& beam = member(report, "beam");
  const std::string size = beam_size(beam, "");
  if (size.empty()) return not_measured;
  const json& misfit = member(beam, "misfit");
  const std::string how =
      misfit.is_number() ? plain(member(beam, "how")) + "; the main lobe differs by " + significant(misfit.get<double>(), 2)
                         : "";
  return size + (how.empty() ? "" : tag("small", how)) +
         beam_size(member(report, "beam_by_quadrant"), "to compare: WSClean’s fit, to a quadrant of the PSF, gives");
}

std::string image_text(const json& options) {
  const json& size = member(options, "imsize");
  std::vector<std::string> sides;
  if (size.is_array()) {
    for (const json& side : size) sides.push_back(plain(side));
  } else if (!size.is_null()) {
    std::istringstream words(plain(size));
    for (std::string side; words >> side;) sides.push_back(side);
  }
  const std::string text = sides.empty() ? "" : sides.front() + " × " + sides.back();
  const json& cell = member(options, "cell");
  return text.empty() ? not_measured : text + " pixels" + (cell.is_null() ? "" : tag("small", "of " + plain(cell)));
}

/// The peak of the restored image in Jy/beam, and in small where it is.
std::string restored_text(const json& restored) {
  constexpr double degree = M_PI / 180;
  const json& ra = member(restored, "ra_deg");
  const json& dec = member(restored, "dec_deg");
  const bool on_sky = ra.is_number() && dec.is_number();
  return with_unit(member(restored, "peak_jy"), "Jy/beam") +
         tag("small", "peak" + (on_sky ? ", at " + sexagesimal({ra.get<double>() * degree, dec.get<double>() * degree}) : "")) +
         tag("small", "pixel " + whole(member(restored, "column")) + ", " + whole(member(restored, "row")) + ", from 0");
}

/// The error against the direct transform: measured, or else expected, whether it keeps the accuracy asked, and what it is not.
std::string accuracy_text(const json& error) {
  const json& requested = member(error, "requested");
  const bool measured = member(error, "measured_rms").is_number();
  const json& reached = member(error, measured ? "measured_rms" : "expected_rms");
  if (!reached.is_number()) return not_measured;
  std::string text = html_power(reached.get<double>()) + tag("small", measured ? "measured" : "expected, not measured");
  if (requested.is_number()) {
    const bool kept = reached.get<double>() <= requested.get<double>();
    text += tag("small", (kept ? "✓ within " : "✗ exceeds ") + html_power(requested.get<double>()) + " asked for",
                kept ? "good" : "bad");
  }
  return text +
         tag("small", "of gridding and FFT against direct sums of these data; it says nothing of CLEAN, calibration or noise");
}

std::string headline(const json& report) {
  const json& visibilities = member(report, "visibilities");
  const json& clean = member(report, "clean");
  std::vector<std::pair<std::string, std::string>> facts{{"Image", image_text(member(report, "options"))},
                                                         {"Beam", beam_text(report)},
                                                         {"Image error", accuracy_text(member(report, "error"))}};
  facts.emplace_back("Visibilities used", whole(member(visibilities, "used")) +
                                              tag("small", "of " + whole(member(visibilities, "samples_read")) + " read"));
  if (clean.is_object()) {
    if (const json& restored = member(report, "restored"); restored.is_object())
      facts.emplace_back("Restored", restored_text(restored));
    facts.emplace_back("Residual", with_unit(member(clean, "rms_jy"), "Jy/beam") +
                                       tag("small", "noise; peak " + with_unit(member(clean, "peak_residual_jy"), "Jy/beam")));
  } else if (const json& histogram = member(report, "residual_histogram"); histogram.is_object()) {
    facts.emplace_back("Dirty image", with_unit(member(histogram, "noise_jy"), "Jy/beam") +
                                          tag("small", "noise; largest " + with_unit(member(histogram, "max_jy"), "Jy/beam")));
  }
  if (const json& predicted = member(member(report, "noise"), "predicted_jy"); predicted.is_number())
    facts.back().second += tag("small", with_unit(predicted, "Jy/beam") + " predicted from the weights");
  const json& total = member(member(report, "timings_s"), "total");
  const json& memory = member(report, "memory_gib_peak");
  facts.emplace_back("Run",
                     (total.is_number() ? duration(total.get<double>()) : not_measured) +
                         (memory.is_number() ? tag("small", significant(memory.get<double>(), 2) + " GiB at most") : ""));
  std::string content;
  for (const auto& [name, value] : facts) content += tag("div", tag("dt", name) + tag("dd", value)) + "\n";
  return tag("dl", content, "facts") + "\n";
}

std::string warnings(const json& list) {
  std::string content;
  if (list.is_array()) {
    for (const json& warning : list) content += tag("p", tag("strong", "Warning.") + " " + plain(warning)) + "\n";
  }
  return content.empty() ? "" : tag("aside", content);
}

/// The numbers of the histogram.
std::string histogram_caption(const json& histogram, bool cleaned) {
  const json& noise = member(histogram, "noise_jy");
  const json& pixels = member(histogram, "pixels");
  if (!noise.is_number() || !pixels.is_number()) return "";
  const auto in_sigma = [&](const char* key) {
    const json& value = member(histogram, key);
    return value.is_number() ? significant(value.get<double>() / noise.get<double>(), 3) + "\u00a0σ" : not_measured;
  };
  constexpr double beyond_5_sigma = 5.733e-7;  // of a Gaussian
  return tag("b", cleaned ? "Residual." : "Dirty image.") + " Noise σ = " + with_unit(noise, "Jy/beam") + "; pixels from " +
         in_sigma("min_jy") + " to " + in_sigma("max_jy") + ". " + whole(member(histogram, "beyond_5_sigma")) + " of " +
         whole(pixels) + " lie beyond 5\u00a0σ, where noise alone would leave " +
         significant(beyond_5_sigma * pixels.get<double>(), 1) + ".";
}

std::string figures(const std::vector<PagePicture>& pictures, const std::vector<std::string>& drawings) {
  std::string content;
  for (const PagePicture& picture : pictures) {
    content += "<figure><img alt=\"" + html_escaped(picture.title) + "\" src=\"data:image/png;base64," + base64(picture.png) +
               "\"></figure>\n";
  }
  for (const std::string& drawing : drawings)
    if (!drawing.empty()) content += tag("figure", drawing) + "\n";
  return content.empty() ? "" : tag("div", content, "pictures") + "\n";
}

std::string plan(const json& list) {
  std::vector<Row> rows;
  for (const json& step : list.is_array() ? list : json::array()) {
    rows.push_back({plain(member(step, "item")), tag("b", plain(member(step, "decision"))), plain(member(step, "because"))});
  }
  return table({"Item", "Decision", "Because"}, rows);
}

std::string errors(const json& error, const json& kernel) {
  std::string content;
  if (error.is_object()) {
    content = table({"Relative to the direct transform", "#Value"},
                    {{"asked for, RMS", relative(member(error, "requested"))},
                     {"expected, RMS", relative(member(error, "expected_rms"))},
                     {"bound, RMS", relative(member(error, "bound_rms"))},
                     {"bound, worst pixel", relative(member(error, "bound_max"))},
                     {"measured in the image, RMS", relative(member(error, "measured_rms"))},
                     {"measured in the image, worst pixel", relative(member(error, "measured_max"))},
                     {"measured in predicted visibilities, RMS", relative(member(error, "measured_predict_rms"))}});
  }
  if (kernel.is_object()) {
    content += tag("p", "Kernel: " + plain(member(kernel, "name")) + ", width " + plain(member(kernel, "width")) +
                            " cells, x0 " + plain(member(kernel, "x0")) + ", padding " + plain(member(kernel, "padding")) +
                            ", evaluated as " + plain(member(kernel, "evaluation")) + ".") +
               "\n";
  }
  return content;
}

std::string left_out(const json& visibilities) {
  if (!visibilities.is_object()) return "";
  const json& read = member(visibilities, "samples_read");
  const auto row = [&](const std::string& name, const std::string& key) -> Row {
    const json& count = member(visibilities, key);
    const bool share = count.is_number() && read.is_number() && read.get<double>() > 0;
    return {name, whole(count), share ? significant(100 * count.get<double>() / read.get<double>(), 3) + " %" : ""};
  };
  return table({"Stokes samples", "#Count", "#Share"},
               {row("read", "samples_read"), row("auto-correlations", "autocorrelations"), row("flagged", "flagged"),
                row("not finite", "nonfinite"), row("zero or negative weight", "zero_weight"),
                row("outside the grid", "outside_grid"), row("used", "used")});
}

/// A row for each Stokes parameter where there are several.
std::string stokes_section(const json& list) {
  if (!list.is_array() || list.size() < 2) return "";
  std::vector<Row> rows;
  for (const json& of : list) {
    const json& clean = member(of, "clean");
    const json& histogram = member(of, "residual_histogram");
    const json& error = member(of, "error");
    rows.push_back({plain(member(of, "stokes")), with_unit(member(histogram, "noise_jy"), "Jy/beam"),
                    with_unit(member(histogram, "max_jy"), "Jy/beam"), with_unit(member(histogram, "min_jy"), "Jy/beam"),
                    clean.is_object() ? with_unit(member(clean, "model_flux_jy"), "Jy") : "",
                    clean.is_object() ? whole(member(clean, "iterations")) : "",
                    clean.is_object() ? plain(member(clean, "stop_reason")) : "", relative(member(error, "expected_rms"))});
  }
  return table(
      {"Stokes", "#Noise", "#Largest pixel", "#Smallest pixel", "#Model flux", "#Components", "CLEAN ended", "#Expected error"},
      rows);
}

/// True if nothing was given for an option.
bool is_empty(const json& value) {
  return value.empty() || plain(value).empty() || value == "[]";
}

std::string options(const json& used) {
  std::vector<Row> rows;
  if (used.is_object()) {
    for (const auto& [name, value] : used.items()) {
      if (!is_empty(value)) rows.push_back({tag("code", "--" + html_escaped(name)), plain(value)});
    }
  }
  return table({"Option", "Value"}, rows);
}

}  // namespace

std::string report_page(const json& report, const std::vector<PagePicture>& pictures, const PageDrawings& drawings) {
  const json& name = member(member(report, "options"), "imagename");
  const std::string title = name.is_string() ? plain(name) : "misfit";
  const json& command = member(report, "command_line");
  std::string content = html::header(title, "misfit " + plain(member(report, "version")));
  content += warnings(member(report, "warnings"));
  content += headline(report);
  const json& clean = member(report, "clean");
  const std::string caption = histogram_caption(member(report, "residual_histogram"), clean.is_object());
  content += figures(pictures, {clean_progress(clean), drawings.spectrum,
                                drawings.histogram.empty() ? "" : drawings.histogram + tag("figcaption", caption)});
  content += section("Planes", cube_section(report));
  content += section("Stokes parameters", stokes_section(member(report, "stokes")));
  content += section("CLEAN", clean_section(clean));
  content += section("Sources outside the image", outside_section(report));
  content += section("Plan", plan(member(report, "plan")));
  content += section("Error", errors(member(report, "error"), member(report, "kernel")));
  content += section("What was used and what was left out", left_out(member(report, "visibilities")));
  content += section("Time", time_section(member(report, "timings_s"), member(report, "timings_expected_s")));
  content += section("Options", options(member(report, "options")));
  content += section("Command line", command.is_string() ? tag("pre", plain(command)) : "");
  return html::page(title + " — misfit", content);
}

}  // namespace misfit::tools
