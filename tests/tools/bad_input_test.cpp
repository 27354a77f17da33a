// What cannot be done is refused with one line that says why, and leaves nothing behind.
#include "tests/tools/markup.h"
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(bad_input)

namespace {

using namespace misfit::tools::testing;

/// The program must end with `code`, print nothing but one line with all of `parts`, and write nothing into `folder`.
void check_refused(const Arguments& arguments, int code, const std::vector<std::string>& parts, const std::string& folder) {
  const auto before = files_below(folder);
  const Outcome outcome = run(arguments + Arguments{"--quiet"});
  BOOST_TEST_CONTEXT(outcome.err) {
    BOOST_TEST(outcome.code == code);
    BOOST_TEST(outcome.out == "");
    BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    BOOST_TEST(contains(outcome.err, "misfit: "));
    for (const std::string& part : parts) {
      BOOST_TEST_INFO(part);
      BOOST_TEST(contains(outcome.err, part));
    }
    BOOST_TEST((files_below(folder) == before));
  }
}

void replace(Arguments& arguments, const std::string& option, const std::string& value) {
  const auto at = std::find(arguments.begin(), arguments.end(), option);
  if (at == arguments.end())
    arguments.insert(arguments.end(), {option, value});
  else
    at[1] = value;
}

/// A folder for what should not be written.
struct Scene {
  TemporaryFolder folder;
  std::string out = folder / "out";
  Scene() { std::filesystem::create_directory(out); }
  Arguments image(const std::string& option = "", const std::string& value = "") const {
    Arguments arguments = small_image(snapshot(), out + "/a");
    if (!option.empty()) replace(arguments, option, value);
    return arguments;
  }
  void usage(const std::string& option, const std::string& value, const std::string& expected) const {
    check_refused(image(option, value), 2, {value, expected}, out);
  }
  void unusable(const std::string& option, const std::string& value, const std::string& expected) const {
    check_refused(image(option, value), 1, {value, expected}, out);
  }
};

/// A temporary copy of the snapshot.
std::string copy_of_snapshot(const TemporaryFolder& folder) {
  std::filesystem::copy(snapshot(), folder / "copy.ms", std::filesystem::copy_options::recursive);
  return folder / "copy.ms";
}

/// Nothing unfinished, and no image that cannot be read.
void check_complete(const std::string& folder) {
  for (const auto& [path, bytes] : files_below(folder)) {
    BOOST_TEST_CONTEXT(path) {
      BOOST_TEST(!contains(path, ".part"));
      BOOST_TEST(!contains(path, ".pictures"));
      if (path.ends_with(".fits")) BOOST_CHECK_NO_THROW(misfit::imager::read_fits(path));
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(options_with_impossible_values_are_wrong_usage) {
  const Scene scene;
  scene.usage("--imsize", "0", "expected 1 to 65536");
  scene.usage("--imsize", "-5", "expected 1 to 65536");
  scene.usage("--imsize", "65537", "expected 1 to 65536");
  scene.usage("--imsize", "64.5", "");
  for (const char* number : {"--niter", "--nsigma", "--accuracy", "--gain", "--memory", "--threads", "--imsize"})
    scene.usage(number, "", std::string(number) + " '': expected ");
  scene.usage("--cell", "0", "expected an angle above 0");
  scene.usage("--cell", "-1arcsec", "expected an angle above 0");
  scene.usage("--cell", "1parsec", "expected a number with a unit");
  scene.usage("--cell", "1rad", "expected less than 0.5 rad");
  scene.usage("--accuracy", "0", "expected a number above 0");
  scene.usage("--accuracy", "2", "below 1");
  scene.usage("--accuracy", "1e-16", "it can reach");
  scene.usage("--kernel", "nosuch", "least-misfit, minimax");
  scene.usage("--kernel", "spheroidal-exact-wide", "is not a number in [0, 10]");
  scene.usage("--kernel", "nosuch", "a kernel-table file, or with --kernel-folder a library");
  scene.usage("--kernel-width", "99", "--kernel-width 99: expected 1 to 20, which kernel least-misfit has");
  scene.usage("--padding", "0.5", "--padding 0.5: expected 1.02 to 10");
  scene.usage("--niter", "-1", "expected 0 or more");
  scene.usage("--niter", "1.5e0", "--niter 1.5e0: expected a whole number");
  scene.usage("--niter", "99999999999", "--niter 99999999999: expected a whole number of magnitude 2147483647 at most");
  scene.usage("--gain", "much", "--gain much: expected a number (Part of a peak that a component takes away)");
  scene.usage("--scales", "0,wide", "--scales 0,wide: expected numbers (Scales of multiscale in pixels");
  scene.usage("--restfreq", "abc", "--restfreq abc: expected a frequency such as 1.420405752GHz");
  scene.usage("--niter", "many", "");
  scene.usage("--gain", "0", "expected more than 0");
  scene.usage("--gain", "1.5", "at most 1");
  scene.usage("--gain", "nan", "at most 1");
  scene.usage("--threshold", "-1Jy", "expected 0 or more");
  scene.usage("--threshold", "1mK", "Jy, mJy, uJy");
  scene.usage("--nsigma", "-1", "expected 0 or more");
  scene.usage("--cyclefactor", "0", "more than 0");
  scene.usage("--nmajor", "-2", "-1");
  scene.usage("--cycleniter", "0", "-1 (no limit), 1 or more");
  scene.usage("--restoringbeam", "1arcsec", "expected --niter above 0");
  scene.usage("--restoringbeam", "1arcsec,2arcsec,0deg", "MAJ at least MIN");
  scene.usage("--restoringbeam", "2arcsec,1arcsec", "MAJ,MIN,PA");
  for (const char* beam : {"0arcsec", "1", "1arcsec,", ",", "2arcsec,1arcsec,30", "2arcsec,1arcsec,3deg,", "100deg"})
    scene.usage("--restoringbeam", beam, "expected common, circular, MAJ");
  scene.usage("--savemodel", "modelcolumn", "expected --niter above 0");
  scene.usage("--savemodel", "virtual", "modelcolumn");
  scene.usage("--mask", "mask.crtf", "expected --niter above 0");
  scene.usage("--threads", "-1", "expected 0 (all cores) or more");
  scene.usage("--verify", "-1", "expected 0 or more");
  scene.usage("--weighting", "bright",
              "--weighting bright: expected natural, uniform, superuniform, briggs, briggsbwtaper or ");
}

BOOST_AUTO_TEST_CASE(unknown_options_and_missing_ones_are_wrong_usage) {
  const Scene scene;
  check_refused(scene.image("--bogus", "3"), 2, {"--bogus"}, scene.out);
  check_refused(scene.image() + Arguments{"surplus"}, 2, {"surplus"}, scene.out);
  check_refused(scene.image() + Arguments{"--cell", "2arcsec"}, 2, {"--cell"}, scene.out);
  check_refused({"image", "--vis", snapshot()}, 2, {"is required"}, scene.out);
  check_refused(scene.image() + Arguments{"--restart=perhaps"}, 2, {"--restart perhaps: expected true or false"}, scene.out);
  check_refused({"image", "--imsize"}, 2, {"--imsize --quiet: expected whole numbers"}, scene.out);
  check_refused({"image", "--imsize", "1", "2", "3"}, 2, {"--imsize: expected 1 to 2 values, found 3"}, scene.out);
  check_refused(scene.image() + Arguments{"--niter", "1", "--niter", "2"}, 2, {"--niter: expected 1 value, found 2"},
                scene.out);
  check_refused({"predict", "--vis", snapshot()}, 2, {"--model or --components"}, scene.out);
}

BOOST_AUTO_TEST_CASE(data_that_cannot_be_used_are_named) {
  const Scene scene;
  scene.unusable("--vis", scene.folder / "none.ms", "expected a MeasurementSet");
  scene.unusable("--vis", scene.out, "expected the directory of a MeasurementSet");
  scene.unusable("--vis", MISFIT_PROGRAM, "expected the directory of a MeasurementSet");
  scene.unusable("--vis", snapshot() + "/ANTENNA", "not a MeasurementSet");
  check_refused(scene.image("--mask", scene.out) + Arguments{"--niter", "10"}, 1,
                {"cannot read " + scene.out + ": it is no casacore image; expected the folder of one"}, scene.out);
  scene.unusable("--datacolumn", "CORRECTED_DATA", "columns with visibilities: DATA");
  scene.unusable("--datacolumn", "FLAG", "columns with visibilities: DATA");
  scene.unusable("--field", "nosuch", "the set has no such field; expected some of 0 'SIMULATED'");
  scene.unusable("--field", "7", "the set has no such field");
  scene.unusable("--spw", "3", "the set has no such spectral window; expected some of 0 (4 GHz, 1 channel)");
  scene.unusable("--spw", "0:~", "Parse error");
  scene.unusable("--config", scene.folder / "none.ini", "cannot read");
}

BOOST_AUTO_TEST_CASE(a_kernel_file_must_be_whole_and_is_padded_as_it_needs) {
  const Scene scene;
  const std::string file = scene.folder / "k.fits", text = scene.folder / "text.fits", none = scene.folder / "none.fits";
  succeed({"kernel", "--width", "5", "--padding", "2", "--output", file});
  check_refused(scene.image("--kernel", file) + Arguments{"--padding", "1.5"}, 2,
                {file, "--padding 1.5: expected at least 2, since kernel "}, scene.out);
  check_refused(scene.image("--kernel", file) + Arguments{"--kernel-width", "6"}, 2,
                {file, "--kernel-width 6: expected 5, which kernel "}, scene.out);
  check_refused(scene.image("--kernel", file) + Arguments{"--accuracy", "1e-9"}, 2, {file, "it can reach"}, scene.out);
  scene.unusable("--kernel", none, "does not exist");
  std::ofstream(text) << "least-misfit\n";
  scene.unusable("--kernel", text, "no FITS file");
  std::string bytes = content(file);
  bytes[bytes.size() - 2880 + 3] ^= 1;
  std::ofstream(text, std::ios::binary) << bytes;
  scene.unusable("--kernel", text, "does not match its checksum");
  succeed(small_image(snapshot(), scene.folder / "m"));
  check_refused({"predict", "--vis", snapshot(), "--model", scene.folder / "m.residual.fits", "--kernel", text}, 1,
                {text, "checksum"}, scene.out);
}

BOOST_AUTO_TEST_CASE(nothing_left_after_flags_says_what_became_of_the_samples) {
  const Scene scene;
  const TemporaryFolder folder;
  const std::string set = copy_of_snapshot(folder);
  const Arguments of_scene{"report", "scene", "--vis", set, "--imsize", "64", "--cell", "0.1arcsec", "--quick", "--output"};
  const Arguments of_stability{"report", "stability", "--vis", set, "--quick", "--output", scene.out};
  const auto check = [&](const std::string& reason) {
    const std::vector<std::string> parts{set + ": none of 351 visibilities can be used: 351 " + reason +
                                         "; expected at least one"};
    for (const Arguments& arguments : {scene.image("--vis", set), of_scene + Arguments{scene.out}, of_stability})
      check_refused(arguments, 1, parts, scene.out);
  };
  put_weights(set, 0);
  check("of zero weight");
  flag_all(set);
  check("flagged");
}

BOOST_AUTO_TEST_CASE(a_report_takes_no_negative_time) {
  const Scene scene;
  check_refused({"report", "scene", "--vis", snapshot(), "--imsize", "64", "--cell", "0.1arcsec", "--seconds", "-3", "--output",
                 scene.out},
                2, {"--seconds −3: expected 0 or more"}, scene.out);
}

BOOST_AUTO_TEST_CASE(a_word_that_is_no_subcommand_is_answered_with_those_there_are_the_nearest_first) {
  const Scene scene;
  check_refused({"imag", "--vis", "a"}, 2, {"misfit: imag: expected image, "}, scene.out);
  check_refused({"report", "scen"}, 2, {"misfit: report scen: expected scene, kernels or stability"}, scene.out);
  check_refused({"report", "stabilty", "--output", "x"}, 2, {"misfit: report stabilty: expected stability, "}, scene.out);
  check_refused({}, 2, {"misfit: expected image, "}, scene.out);
  check_refused({"report"}, 2, {"misfit: report: expected kernels, scene or stability"}, scene.out);
}

BOOST_AUTO_TEST_CASE(a_quantity_that_is_none_is_named_with_its_option) {
  const Scene scene;
  scene.usage("--threshold", "foo",
              "--threshold: 'foo' is no flux density; expected a number with a unit of Jy, mJy, uJy, such as");
  scene.usage("--cell", "foo", "--cell: 'foo' is no angle");
  scene.usage("--restoringbeam", "foo", "--restoringbeam foo: expected common, circular, MAJ");
  for (const char* option : {"--cell", "--ra", "--dec", "--frequency", "--channel-width", "--noise"})
    check_refused({"simulate", "--output", scene.out + "/a.ms", option, "foo"}, 2, {option, "'foo' is no", "such as"},
                  scene.out);
}

BOOST_AUTO_TEST_CASE(an_output_without_a_name_is_refused) {
  const Scene scene;
  const Arguments none{"--output", ""};
  for (const Arguments& command :
       {Arguments{"report", "scene", "--vis", snapshot(), "--imsize", "64", "--cell", "1arcsec"},
        Arguments{"report", "stability"}, Arguments{"report", "kernels"}, Arguments{"simulate"},
        Arguments{"mosaic", "a.fits", "b.fits"}, Arguments{"kernel", "--width", "4", "--padding", "2"}})
    check_refused(command + none, 2, {"--output: '': expected a name"}, scene.out);
}

BOOST_AUTO_TEST_CASE(a_cell_too_large_for_every_sample_is_named) {
  const Scene scene;
  check_refused(scene.image("--cell", "20deg"), 1, {"351 usable samples lie beyond 1/(2 cell)"}, scene.out);
}

BOOST_AUTO_TEST_CASE(an_output_that_cannot_be_written_is_named) {
  const Scene scene;
  check_refused(scene.image("--imagename", scene.folder / "none/a"), 1, {scene.folder / "none", "does not exist"}, scene.out);
  scene.unusable("--imagename", "/proc/a", "/proc");
  std::filesystem::permissions(scene.out, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  if (access(scene.out.c_str(), W_OK) != 0)
    check_refused(scene.image(), 1, {scene.out, "cannot be written"}, scene.out);
  else
    BOOST_TEST_MESSAGE("skipped: this user may write where nobody may");
  std::filesystem::permissions(scene.out, std::filesystem::perms::owner_all);
}

BOOST_AUTO_TEST_CASE(a_name_that_ends_in_a_slash_is_no_name) {
  const Scene scene;
  check_refused(scene.image("--imagename", scene.out + "/"), 2, {"--imagename", "expected a name"}, scene.out);
  check_refused(scene.image("--imagename", ""), 2, {"--imagename", "expected a name"}, scene.out);
  check_refused(scene.image("--imagename", scene.out + "/.."), 2, {"--imagename", "expected a name"}, scene.out);
}

BOOST_AUTO_TEST_CASE(images_are_not_put_inside_a_measurement_set) {
  const Scene scene;
  const TemporaryFolder folder;
  const std::string set = copy_of_snapshot(folder);
  check_refused(scene.image("--imagename", set + "/a"), 1, {set, "expected a folder of files"}, set);
}

BOOST_AUTO_TEST_CASE(a_set_that_exists_is_not_simulated_again) {
  const Scene scene;
  check_refused({"simulate", "--output", snapshot()}, 1, {snapshot(), "exists already"}, scene.out);
  check_refused({"simulate", "--output", scene.out + "/x.ms", "--array", "mars"}, 2, {"mars", "vla-a"}, scene.out);
  check_refused({"simulate", "--output", scene.folder / "none/x.ms"}, 1, {"none/x.ms"}, scene.out);
  check_refused({"simulate", "--output", scene.out + "/x.ms", "--sky", scene.folder / "none.csv"}, 1, {"none.csv"}, scene.out);
}

BOOST_AUTO_TEST_CASE(a_model_must_be_an_image_and_lie_where_the_phase_centre_given_is) {
  const Scene scene;
  const TemporaryFolder folder;
  const std::string set = copy_of_snapshot(folder);
  const auto predict = [&](const std::string& model) { return Arguments{"predict", "--vis", set, "--model", model}; };
  check_refused(predict(folder / "none.fits"), 1, {"none.fits"}, set);
  check_refused(predict(MISFIT_PROGRAM), 1, {MISFIT_PROGRAM}, set);
  succeed(small_image(set, folder / "a") + Arguments{"--niter", "5"});
  misfit::imager::SkyImage model = misfit::imager::read_fits(folder / "a.model.fits");
  model.geometry.phase_centre.ra_rad += 0.01;
  misfit::imager::write_fits(model, folder / "moved.fits", misfit::imager::PixelFormat::float32);
  check_refused(predict(folder / "moved.fits") + Arguments{"--phasecenter", "0"}, 1,
                {"moved.fits is centred on", "expected the --phasecenter given"}, set);
  check_refused(predict(folder / "a.model.fits") + Arguments{"--column", "DATA"}, 1, {"DATA"}, set);
}

BOOST_AUTO_TEST_CASE(an_option_that_there_is_not_is_named_before_one_that_is_missing) {
  const TemporaryFolder folder;
  for (const char* command : {"image", "predict", "mosaic", "simulate"}) {
    const Outcome outcome = run({command, "--no-such-option"});
    BOOST_TEST(outcome.code == 2);
    BOOST_TEST(outcome.err.find("not expected: --no-such-option") != std::string::npos, outcome.err);
  }
  BOOST_TEST(run({"image"}).err.find("--vis is required") != std::string::npos);
  for (const Arguments& words :
       {Arguments{"image", "--no-such-option", "3"}, small_image("a.ms", "a") + Arguments{"--cel", "2arcsec"}})
    BOOST_TEST(run(words).err.find(words[1] == "--vis" ? "not expected: --cel\n" : "not expected: --no-such-option\n") !=
               std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_wrong_value_is_named_before_an_option_that_is_missing) {
  const TemporaryFolder folder;
  const std::string kernel = folder / "k.fits";
  const std::vector<std::pair<Arguments, std::vector<Arguments>>> commands{
      {{"image"},
       {{"--imsize", "0"},
        {"--cell", "-1arcsec"},
        {"--imagename", "a/"},
        {"--gain", "2"},
        {"--threads", "-1"},
        {"--accuracy", "3"},
        {"--kernel", "nosuch"},
        {"--scales", "0,9,5", "--niter", "5", "--deconvolver", "multiscale"},
        {"--nterms", "7"},
        {"--uvtaper", "-1arcsec"},
        {"--maxuv-l", "5arcsec"},
        {"--nchan", "-5", "--specmode", "cube"}}},
      {{"predict"}, {{"--accuracy", "2"}, {"--threads", "-1"}}},
      {{"mosaic"}, {{"--pblimit", "2"}, {"--threads", "-1"}, {"--imsize", "0"}, {"--rms", "0"}, {"--phasecenter", "M31"}}},
      {{"simulate"}, {{"--channels", "0"}, {"--hours", "-1"}, {"--dec", "100deg"}}},
      {{"report", "scene"}, {{"--seconds", "-1"}, {"--imsize", "70000"}, {"--robust", "9", "--weighting", "briggs"}}},
      {{"kernel"},
       {{"--width", "99"},
        {"--x0", "0.6"},
        {"--padding", "0.5"},
        {"--degree", "99"},
        {"--kernel", "nosuch"},
        {"--accuracy", "2"},
        {"--w-turns", "-1", "--accuracy", "0.1"},
        {"--samples", "-7", "--accuracy", "0.1"},
        {"--target-error", "3", "--emit", "ducc"},
        {"--host-padding", "0.5", "--emit", "ducc"}}},
      {{"kernel", "--output", kernel}, {{"--width", "99"}, {"--x0", "0.6"}, {"--padding", "0.5"}, {"--sampling", "0"}}}};
  for (const auto& [command, values] : commands)
    for (const Arguments& wrong : values) {
      const Outcome outcome = run(command + wrong);
      BOOST_TEST_CONTEXT(command.front() << " " << wrong.front() << ": " << outcome.err) {
        BOOST_TEST(outcome.code == 2);
        BOOST_TEST((contains(outcome.err, wrong[0] + " ") || contains(outcome.err, wrong[1])));  // −1 is written with a minus
        BOOST_TEST(!contains(outcome.err, "is required"));
      }
    }
  check_refused(small_image("a.ms", "a") + Arguments{"--imsize", "0", "--no-such-option"}, 2, {"--no-such-option"},
                folder / "");
}

BOOST_AUTO_TEST_CASE(a_number_given_as_0_is_named) {
  const TemporaryFolder folder;
  for (const char* option : {"--width", "--x0", "--padding", "--accuracy"})
    check_refused({"kernel", option, "0", "--output", folder / "k.fits"}, 2, {option + std::string(": 0: expected")},
                  folder / "");
}

BOOST_AUTO_TEST_CASE(what_is_subtracted_from_is_not_overwritten) {
  const Scene scene;
  const TemporaryFolder folder;
  const std::string set = copy_of_snapshot(folder), list = scene.folder / "one.csv";
  std::ofstream(list) << "l_arcsec,m_arcsec,flux_jy,scale_arcsec\n1,2,3,-4\n";
  const Arguments predict{"predict", "--vis", set, "--components", list};
  check_refused(predict, 1, {list + ", line 2", "scale_arcsec is '-4'"}, set);
  check_refused(predict + Arguments{"--datacolumn", "data"}, 2, {"--datacolumn", "--subtract"}, set);
  check_refused(predict + Arguments{"--kernel", "spheroidal"}, 2, {"--kernel spheroidal", "--components"}, set);
  const Arguments subtract = predict + Arguments{"--subtract"};
  check_refused(subtract + Arguments{"--column", "data"}, 1, {"DATA", "such as CORRECTED_DATA"}, set);
  check_refused(subtract + Arguments{"--datacolumn", "corrected"}, 1, {"CORRECTED_DATA", "columns with visibilities: DATA"},
                set);
  check_refused(subtract + Arguments{"--datacolumn", "model"}, 1, {"MODEL_DATA", "columns with visibilities: DATA"}, set);
  std::ofstream(list) << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n";
  succeed(predict + Arguments{"--column", "CORRECTED_DATA"});
  check_refused(subtract, 1, {"has a column CORRECTED_DATA already"}, set);
}

BOOST_AUTO_TEST_CASE(an_image_too_large_for_the_memory_is_refused_before_work_begins) {
  const Scene scene;
  const long double memory = static_cast<long double>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGE_SIZE);
  if (memory > 16.0L * 65536 * 65536) return;  // dirty image and PSF would fit
  check_refused(scene.image("--imsize", "65536"), 2, {"65536", "GiB"}, scene.out);
  check_refused(
      {"report", "scene", "--vis", snapshot(), "--imsize", "65536", "--cell", "1mas", "--output", scene.out + "/report"}, 2,
      {"--imsize 65536 65536: expected an image that fits this machine's", "this one needs"}, scene.out);
}

BOOST_AUTO_TEST_CASE(too_little_memory_is_refused_with_what_is_needed) {
  const Scene scene;
  scene.usage("--memory", "0.01", "expected at least 0.");
  scene.usage("--memory", "-1", "or more, in GiB");
  scene.usage("--memory", "nan", "or more, in GiB");
  check_refused(scene.image("--memory", "0.01") + Arguments{"--dry-run"}, 2, {"--memory 0.01", "64 × 64"}, scene.out);
}

BOOST_AUTO_TEST_CASE(the_first_interrupt_ends_a_run_and_leaves_only_complete_files) {
  const Scene scene;
  Child child({"image", "--vis", track(), "--imagename", scene.out + "/a", "--imsize", "1024", "--cell", "0.05arcsec",
               "--niter", "2000000000", "--gain", "0.001"});
  child.wait_for("dirty image and PSF");
  child.signal(SIGINT);
  const Outcome outcome = child.wait();
  BOOST_TEST(outcome.code == 130);
  BOOST_TEST(contains(outcome.err, "stopped by the user"));
  check_complete(scene.out);
}

BOOST_AUTO_TEST_CASE(an_interrupt_before_there_is_an_image_leaves_nothing) {
  const Scene scene;
  Child child({"simulate", "--output", scene.out + "/a.ms", "--hours", "0.2", "--channels", "512"});
  while (!child.ended() && files_below(scene.out).empty()) std::this_thread::yield();
  child.signal(SIGTERM);
  const Outcome outcome = child.wait();
  BOOST_TEST(outcome.code == 130);
  BOOST_TEST(files_below(scene.out).empty());
}

BOOST_AUTO_TEST_CASE(a_home_is_not_needed) {
  const Scene scene;
  const char* const home = std::getenv("HOME");
  const std::string kept = home == nullptr ? "" : home;
  unsetenv("HOME");
  succeed(scene.image());
  if (home != nullptr) setenv("HOME", kept.c_str(), 1);
}

BOOST_AUTO_TEST_SUITE_END()
