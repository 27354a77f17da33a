// Models that are one of several Taylor terms, by their names and by their headers.
#include "tests/tools/program.h"
#include "tools/formats/image_file.h"

BOOST_AUTO_TEST_SUITE(taylor_models)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

/// A set, and the model of an image of it in one term, as FITS and as a CASA image.
class Model {
 public:
  Model() {
    std::filesystem::copy(snapshot(), set(), std::filesystem::copy_options::recursive);
    succeed(small_image(set(), folder_ / "a") + Arguments{"--niter", "20", "--outformat", "both"});
  }
  std::string set() const { return folder_ / "s.ms"; }
  /// The model under another name.
  std::string as(const std::string& name) const {
    const bool fits = name.find(".fits") != std::string::npos;
    std::filesystem::copy(folder_ / (fits ? "a.model.fits" : "a.model"), folder_ / name,
                          std::filesystem::copy_options::recursive);
    return folder_ / name;
  }
  std::vector<Arguments> uses(const std::string& model) const {
    const Arguments clean = small_image(set(), folder_ / "b") + Arguments{"--niter", "5", "--startmodel", model};
    return {{"predict", "--vis", set(), "--model", model}, clean, clean + Arguments{"--specmode", "cube"}};
  }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
};

void check_refusal(const Arguments& arguments, const std::vector<std::string>& parts) {
  const Outcome outcome = run(arguments + Arguments{"--quiet"});
  BOOST_TEST_INFO(outcome.err);
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  for (const std::string& part : parts) BOOST_TEST(outcome.err.find(part) != std::string::npos, part << " in " << outcome.err);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_first_term_is_refused_with_the_names_of_those_that_would_be_left_out) {
  for (const std::string end : {".fits", "", ".smooth.fits", "_smooth.fits"}) {
    const Model model;
    const std::string first = model.as("x.model.tt0" + end), second = model.as("x.model.tt1" + end),
                      third = model.as("x.model.tt2" + end);
    for (const Arguments& use : model.uses(first)) check_refusal(use, {first, "taken without " + second + ", " + third});
    for (const Arguments& use : model.uses(second)) check_refusal(use, {second + " is by its name Taylor term 1", first});
  }
}

BOOST_AUTO_TEST_CASE(a_term_whose_others_are_not_there_is_refused_with_what_is_possible) {
  for (const std::string end : {".fits", ""}) {
    const Model model;
    const std::string first = model.as("x.model.tt0" + end), second = model.as("y.model.TT1" + end);
    for (const Arguments& use : model.uses(first))
      check_refusal(use, {"there is no " + (model.folder() / ("x.model.tt1" + end)), "under a name without .tt0"});
    for (const Arguments& use : model.uses(second))
      check_refusal(use, {"there is no " + (model.folder() / ("y.model.TT0" + end)), "--savemodel modelcolumn"});
  }
  const Model model;
  check_refusal(model.uses(model.as("x.tt0") + "/").front(), {"first of several Taylor terms"});
}

BOOST_AUTO_TEST_CASE(other_names_are_no_terms) {
  const Model model;
  std::filesystem::create_directory(model.folder() / "x.tt0");
  for (const std::string name : {"x.tt0/a.fits", "tt0.fits", "a.tt.fits", "a.tt0b.fits", "a.att0.fits", "x.tt0/casa"})
    for (const Arguments& use : model.uses(model.as(name))) {
      const Outcome outcome = run(use + Arguments{"--quiet"});
      BOOST_TEST(outcome.err.find("Taylor") == std::string::npos, outcome.err);
    }
  BOOST_TEST(run(model.uses(model.folder() / "x.tt0/a.fits").front()).code == 0);
  check_refusal(model.uses(model.folder() / "none.tt0.fits").front(), {"none.tt0.fits"});
}

BOOST_AUTO_TEST_CASE(a_name_is_a_term_whatever_parts_it_and_wherever_links_lead) {
  const Model model;
  for (const std::string name : {"a_tt0.fits", "b-tt1.fits", "c_tt1", "d-tt0-new.fits", "e.tt0_v2"})
    check_refusal(model.uses(model.as(name)).front(), {name + " is by its name", "Taylor term"});
  for (const std::string name : {"x.model.tt0.fits", "x.model.tt1"}) {
    const std::string link = model.folder() / ("link to " + name.substr(8)), far = link + " again";
    std::filesystem::create_symlink(model.as(name), link);
    std::filesystem::create_symlink(link, far);
    for (const Arguments& use : model.uses(far)) check_refusal(use, {far + " leads to ", name + ", which is by its name"});
  }
}

/// All that a run of several terms writes, in both formats.
BOOST_AUTO_TEST_CASE(headers_say_which_term_an_image_is_and_what_its_pixels_are_and_a_term_is_refused_by_any_name) {
  const TemporaryFolder folder;
  succeed({"simulate", "--output", folder / "s.ms", "--channels", "4", "--channel-width", "200MHz"});
  succeed(small_image(folder / "s.ms", folder / "a") +
          Arguments{"--niter", "20", "--nterms", "3", "--pbcor", "--outformat", "both"});
  int terms = 0, indices = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "")) {
    const std::string path = entry.path(), name = entry.path().filename();
    if (name == "s.ms" || !(entry.is_directory() || name.ends_with(".fits"))) continue;
    const imager::ImageHeader header = tools::open_image_file(path)->header();
    const std::size_t at = name.find(".tt");
    const bool is_term = at != std::string::npos, index = name.starts_with("a.alpha") || name.starts_with("a.beta");
    BOOST_TEST_CONTEXT(path) {
      BOOST_TEST(header.taylor.terms == (is_term ? 3 : 1));
      BOOST_TEST(header.taylor.order == (is_term ? name[at + 3] - '0' : 0));
      BOOST_TEST(header.quantity == (index ? "Spectral Index" : "Intensity"));
      BOOST_TEST(header.unit == (index || name.starts_with("a.pb.") ? ""
                                 : name.starts_with("a.model")      ? "Jy/pixel"
                                                                    : "Jy/beam"));
    }
    terms += is_term ? 1 : 0;
    indices += index ? 1 : 0;
    if (!name.starts_with("a.model")) continue;
    const std::string copy = folder / ("sky" + std::to_string(terms) + (entry.is_directory() ? "" : ".fits"));
    std::filesystem::copy(path, copy, std::filesystem::copy_options::recursive);
    const std::string term = " is by its header Taylor term " + std::to_string(header.taylor.order) + " of 3";
    check_refusal({"predict", "--vis", folder / "s.ms", "--model", copy}, {copy + term, "--savemodel modelcolumn"});
    check_refusal(small_image(folder / "s.ms", folder / "b") + Arguments{"--niter", "5", "--startmodel", copy}, {copy + term});
  }
  BOOST_TEST(terms == 2 * (5 + 5 * 3));  // PSFs up to order 4; residuals, models, images, corrected images and beams
  BOOST_TEST(indices == 2 * 5);
}

/// Flat spectra, which the run changes: what the refusal says is possible.
BOOST_AUTO_TEST_CASE(a_model_without_terms_begins_a_run_of_several) {
  const TemporaryFolder folder;
  succeed({"simulate", "--output", folder / "s.ms", "--channels", "4", "--channel-width", "100MHz"});
  const Arguments clean{"--niter", "20"};
  succeed(small_image(folder / "s.ms", folder / "a") + clean);
  succeed(small_image(folder / "s.ms", folder / "b") + clean +
          Arguments{"--nterms", "2", "--startmodel", folder / "a.model.fits"});
  succeed({"predict", "--vis", folder / "s.ms", "--model", folder / "a.model.fits"});
}

BOOST_AUTO_TEST_CASE(the_terms_of_a_model_begin_where_an_earlier_run_ended) {
  const TemporaryFolder folder;
  const std::string set = folder / "s.ms";
  succeed({"simulate", "--output", set, "--channels", "4", "--channel-width", "100MHz"});
  for (const std::string format : {"fits", "casa"}) {
    const auto image = [&](const std::string& name, const Arguments& options) {
      return small_image(set, folder / name) + Arguments{"--nterms", "2", "--outformat", format} + options;
    };
    const auto model = [&](int term) {
      return folder / ("a.model.tt" + std::to_string(term) + (format == "fits" ? ".fits" : ""));
    };
    succeed(image("a", {"--niter", "50", "--nmajor", "1"}));
    succeed(image("b", {"--niter", "50", "--startmodel", model(0), model(1)}));
    const nlohmann::json before = report_of(folder / "a")["clean"],
                         after = report_of(folder / "b")["clean"]["major_cycles_log"][0];
    // The models passed through files of 32-bit numbers.
    for (const char* key : {"peak_residual_jy", "rms_jy", "model_flux_jy"})
      BOOST_TEST(std::abs(after[key].get<double>() / before[key].get<double>() - 1) < 1e-5, key);
    BOOST_TEST(report_of(folder / "b")["clean"]["peak_residual_jy"] < before["peak_residual_jy"]);
    const Arguments five{"--niter", "5"};
    check_refusal(image("b", five + Arguments{"--startmodel", model(1), model(0)}),
                  {model(1) + " is by its name Taylor term 1", "expected term 0 of 2"});
    check_refusal(image("b", five + Arguments{"--startmodel", model(0), model(1), "--reffreq", "1.41GHz"}),
                  {"start model " + model(0) + " has spectra about", "expected spectra about 1.41 GHz, or --reffreq"});
    Arguments three = image("b", five + Arguments{"--startmodel", model(0), model(1)});
    *std::find(three.begin(), three.end(), "2") = "3";
    const Outcome outcome = run(three);
    BOOST_TEST(outcome.code == 2);
    BOOST_TEST(outcome.err.find("expected one image, or 3, one for each of --nterms") != std::string::npos, outcome.err);
  }
}

BOOST_AUTO_TEST_SUITE_END()
