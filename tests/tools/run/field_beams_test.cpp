#include "tools/run/field_beams.h"

#include <boost/test/data/test_case.hpp>
#include <cmath>

#include "imager/beams/airy_pattern.h"
#include "imager/beams/primary_beam.h"
#include "imager/beams/telescopes.h"
#include "imager/numerics/constants.h"
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"
#include "tools/base/numbers.h"

BOOST_AUTO_TEST_SUITE(field_beams)

namespace {

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::tools::testing;
using tools::FieldNotes;

constexpr double degree = imager::pi / 180, arcmin = degree / 60, hz = 1.4e9;
const imager::SkyDirection centre{1.0, 0.7, "FK5"};

ms_io::FieldPointing field_at(const std::string& name, double north_rad, std::uint8_t sort = 0) {
  return {name,   {centre.ra_rad, centre.dec_rad + north_rad, "FK5"},
          0,      name,
          "a.ms", std::abs(north_rad),
          25,     {{{sort, sort}, 100}}};
}

ms_io::BeamRows fields(const std::vector<imager::AntennaSort>& sorts, const std::vector<ms_io::FieldPointing>& pointings) {
  ms_io::BeamRows rows;
  rows.sorts = sorts;
  rows.pointings = pointings;
  return rows;
}

std::string refusal(const ms_io::BeamRows& rows) {
  try {
    tools::notes_on_apart_fields(rows, {hz, false});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// An hour of two fields of 4 channels at 1.4 GHz, the second `north_rad` beside the first, where the image will be. Both are
/// phased to where they point.
class TwoFields {
 public:
  explicit TwoFields(double north_rad) {
    std::ofstream(folder_ / "sky.csv") << "ra_deg,dec_deg,flux_jy\n60,40,1\n";
    succeed({"simulate", "--output", set(), "--sky", folder_ / "sky.csv", "--array", "vla-d", "--channels", "4", "--frequency",
             "1.4GHz", "--channel-width", "10MHz"});
    add_field(set(), {"ASIDE", 60 * degree, 40 * degree + north_rad});
  }
  std::string set() const { return folder_ / "two.ms"; }
  Arguments image(const Arguments& more = {}) const {
    return Arguments{"image",
                     "--vis",
                     set(),
                     "--imagename",
                     folder_ / "a",
                     "--imsize",
                     "32",
                     "--cell",
                     "15arcsec",
                     "--phasecenter",
                     "J2000 4h00m00s +40d00m00s",
                     "--gridder",
                     "standard"} +
           more;
  }
  std::string warnings() const { return report_of(folder_ / "a")["warnings"].dump(); }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
};

void check_refused(const Arguments& arguments) {
  const Outcome outcome = run(arguments);
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST_INFO(outcome.err);
  BOOST_TEST(has(outcome.err, "1 (ASIDE)"));
  BOOST_TEST(has(outcome.err, "beyond the first null"));
  BOOST_TEST(has(outcome.err, "--force-average"));
}

const std::vector<imager::AntennaSort> dishes{
    {"EVLA", 25, "ea01"}, {"ALMA", 12, "DA41"}, {"ALMA", 7, "CM01"}, {"MeerKAT", 13.5, "m000"}, {"UNHEARD", 40, "X1"}};

}  // namespace

/// Inside half power, between that and the null, and beyond it: in parts of the null's angle.
BOOST_DATA_TEST_CASE(fields_are_listed_with_distance_and_dimming_up_to_the_null_and_refused_beyond,
                     bdata::xrange(dishes.size()) * bdata::make({0.05, 0.3, 0.6, 0.99, 1.01, 1.5, 7.0}), which, nulls) {
  const imager::Pattern pattern = imager::beam_model(dishes[which]).pattern;
  const double away_rad = nulls * std::asin(pattern->main_lobe_sine(hz));
  const ms_io::BeamRows rows = fields({dishes[which]}, {field_at("0 (M51)", 0), field_at("1 (M51b)", away_rad)});
  const double voltage = pattern->voltage(std::sin(away_rad), hz);
  const std::string listed = "1 (M51b), " + tools::angle_text(away_rad, 3) + " away (",
                    dimming = "to " + tools::significant(voltage * voltage, 3);
  const FieldNotes forced = tools::notes_on_apart_fields(rows, {hz, true});
  BOOST_REQUIRE_EQUAL(forced.warnings.size(), 1U);
  BOOST_REQUIRE_EQUAL(forced.decisions.size(), 1U);
  for (const std::string& text : {forced.warnings[0], forced.decisions[0].because}) {
    BOOST_TEST(has(text, listed), text);
    BOOST_TEST(has(text, dimming), text);
    BOOST_TEST(has(text, "0 (M51), at it, to 1"), text);
  }
  const std::string refused = refusal(rows);
  BOOST_TEST(refused.empty() == (nulls < 1));
  if (nulls < 1) return;
  BOOST_TEST(has(refused, "but 1 (M51b) cannot see its centre"), refused);
  BOOST_TEST(has(refused, listed), refused);
}

BOOST_DATA_TEST_CASE(feeds_are_listed_with_their_offsets_and_refused_where_no_turn_of_a_mount_brings_one_to_the_centre,
                     bdata::make({0.05, 0.6, 0.99, 1.01, 3.0}) * bdata::make({0.0, 0.2}) * bdata::make({0.0, 1.0, 2.5}), nulls,
                     field_nulls, turn_rad) {
  const imager::Pattern pattern = imager::beam_model(dishes[0]).pattern;
  const double null_rad = std::asin(pattern->main_lobe_sine(hz));
  const double offset_rad = nulls * null_rad;
  ms_io::BeamRows rows = fields({dishes[0]}, {field_at("0 (M51)", field_nulls * null_rad)});
  rows.feeds = {{0, 0, 0}, {1, offset_rad * std::cos(turn_rad), offset_rad * std::sin(turn_rad)}};
  const FieldNotes forced = tools::notes_on_feeds(rows, {hz, true});
  BOOST_REQUIRE_EQUAL(forced.warnings.size(), 1U);
  const double voltage = pattern->voltage(std::sin(offset_rad), hz);
  BOOST_TEST(has(forced.warnings[0], "feed 1, " + tools::angle_text(offset_rad, 3) + " away"), forced.warnings[0]);
  BOOST_TEST(has(forced.warnings[0], "to " + tools::significant(voltage * voltage, 3)), forced.warnings[0]);
  BOOST_TEST(has(forced.warnings[0], "feed 0, at it, to 1"), forced.warnings[0]);
  const bool sees = nulls - field_nulls < 1;
  if (sees)
    BOOST_TEST(tools::notes_on_feeds(rows, {hz, false}).warnings == forced.warnings);
  else
    BOOST_CHECK_THROW(tools::notes_on_feeds(rows, {hz, false}), std::runtime_error);
  for (ms_io::FeedOffset& feed : rows.feeds) feed.x_rad += 0.1 * null_rad;  // both alike
  rows.feeds[1] = rows.feeds[0];
  rows.feeds[1].y_rad += 0.9 * tools::same_pointing_beams * 31 * arcmin;
  BOOST_TEST(tools::notes_on_feeds(rows, {hz, false}).warnings.empty());
}

BOOST_AUTO_TEST_CASE(feeds_of_a_set_that_are_averaged_are_told_of_or_refused) {
  for (const double offset_rad : {0.0, 10 * arcmin, 2 * degree}) {
    const TwoFields set(0);
    add_feed(set.set(), offset_rad, 0);
    const Outcome outcome = run(set.image());
    BOOST_TEST_CONTEXT(outcome.err) {
      BOOST_TEST(outcome.code == (offset_rad > degree ? 1 : 0));
      BOOST_TEST(has(outcome.err, "feeds that point apart") == (offset_rad > 0));
      if (offset_rad > degree) BOOST_TEST(has(outcome.err, "but feed 1 cannot see its centre"));
    }
    BOOST_TEST(run(set.image({"--force-average"})).code == 0);
    BOOST_TEST(has(set.warnings(), "feed 1") == (offset_rad > 0), set.warnings());
  }
}

BOOST_AUTO_TEST_CASE(fields_that_point_alike_are_as_one_wherever_they_point) {
  for (const double away_rad : {0.0, 10 * arcmin, 5 * degree, 120 * degree}) {
    // A thousandth of a beam of 31′ is 1.9″.
    const ms_io::BeamRows rows =
        fields({dishes[0]}, {field_at("0 (M51)", away_rad), field_at("1 (M51)", away_rad + 1.5 * arcmin / 60)});
    const FieldNotes notes = tools::notes_on_apart_fields(rows, {hz, false});
    BOOST_TEST(notes.warnings.empty());
    BOOST_TEST(notes.decisions.empty());
  }
}

BOOST_AUTO_TEST_CASE(each_field_has_the_beam_of_its_own_dishes_and_the_null_of_the_widest) {
  const double away_rad = 1.5 * 1.2 * imager::speed_of_light_m_s / hz / 10.7;  // beyond the null of 12 m dishes
  const auto rows = [&](const std::vector<ms_io::SortRows>& of_second) {
    ms_io::BeamRows made = fields({dishes[1], dishes[2]}, {field_at("0 (A)", 0), field_at("1 (B)", away_rad)});
    made.pointings[1].rows = of_second;
    return made;
  };
  BOOST_TEST(has(refusal(rows({{{0, 0}, 9}})), "1 (B)"));
  BOOST_TEST(refusal(rows({{{1, 1}, 9}})) == "");
  BOOST_TEST(refusal(rows({{{0, 0}, 9}, {{0, 1}, 5}})) == "");  // the small ones may see something
  const auto voltage = [&](double diameter_m) {
    return imager::airy_voltage({diameter_m, 0.75}, std::sin(away_rad) * hz / imager::speed_of_light_m_s);
  };
  const double mean = (9 * voltage(10.7) * voltage(10.7) + 5 * voltage(10.7) * voltage(6.25)) / 14;
  const std::string warning = tools::notes_on_apart_fields(rows({{{0, 0}, 9}, {{0, 1}, 5}}), {hz, false}).warnings.at(0);
  BOOST_TEST(has(warning, "to " + tools::significant(mean, 3)), warning);
}

BOOST_AUTO_TEST_CASE(where_beams_are_not_known_angles_stand) {
  const ms_io::BeamRows rows = fields({{"LOFAR", 31, "CS001"}, dishes[0]},
                                      {field_at("0 (A)", 0), field_at("1 (B)", 4 * degree), field_at("2 (C)", 10 * arcmin, 1)});
  const std::string warning = tools::notes_on_apart_fields(rows, {hz, false}).warnings.at(0);
  BOOST_TEST(has(warning, "1 (B), 4 deg away; 2 (C), 10 arcmin away ("), warning);
  BOOST_TEST(has(warning, "LOFAR has no simple primary beam"), warning);
  ms_io::BeamRows beyond = rows;
  beyond.pointings[2] = field_at("2 (C)", 4 * degree, 1);
  BOOST_TEST(has(refusal(beyond), "but 2 (C) cannot see"));
}

BOOST_AUTO_TEST_CASE(of_many_fields_the_farthest_are_named_and_the_plan_has_all) {
  std::vector<ms_io::FieldPointing> many;
  for (int i = 0; i < 30; ++i) many.push_back(field_at(std::to_string(i) + " (F)", i * 0.5 * arcmin));
  const FieldNotes notes = tools::notes_on_apart_fields(fields({dishes[0]}, many), {hz, false});
  for (int i = 0; i < 30; ++i) {
    const std::string name = std::to_string(i) + " (F), ";
    BOOST_TEST(has(notes.decisions.at(0).because, name));
    BOOST_TEST(has(notes.warnings.at(0), " " + name) == (i >= 10));
  }
  BOOST_TEST(has(notes.warnings.at(0), "and 10 nearer ones"));
  for (ms_io::FieldPointing& field : many) field = field_at(field.field, field.from_centre_rad * 60 + degree);
  BOOST_TEST(has(refusal(fields({dishes[0]}, many)), "10 (F) and 10 more cannot see"));
}

/// Half power lies at 15′, the null at 36′.
BOOST_AUTO_TEST_CASE(images_and_cubes_of_two_fields_say_so_or_are_refused) {
  for (const Arguments& mode : {Arguments{}, Arguments{"--specmode", "cube"}}) {
    const TwoFields seen(20 * arcmin);
    BOOST_TEST(run(seen.image(mode)).code == 0);
    BOOST_TEST(has(seen.warnings(), "1 (ASIDE), 20 arcmin away ("), seen.warnings());
    for (const char* field : {"0", "ASIDE"}) {  // alone each is one field
      BOOST_TEST(run(seen.image(mode + Arguments{"--field", field})).code == 0);
      BOOST_TEST(!has(seen.warnings(), "apart"), seen.warnings());
    }
    const TwoFields unseen(4 * degree);
    check_refused(unseen.image(mode));
    check_refused(unseen.image(mode + Arguments{"--dry-run"}));
    BOOST_TEST(run(unseen.image(mode + Arguments{"--force-average"})).code == 0);
    BOOST_TEST(has(unseen.warnings(), "1 (ASIDE), 4 deg away ("), unseen.warnings());
    BOOST_TEST(run(unseen.image(mode + Arguments{"--field", "ASIDE"})).code == 0);  // a warning, as of one field
    BOOST_TEST(has(unseen.warnings(), "beyond the first null of the beam: field 1 (ASIDE), 4 deg away"), unseen.warnings());
  }
}

BOOST_AUTO_TEST_CASE(what_counts_is_where_antennas_pointed_not_where_visibilities_are_phased_to) {
  const TwoFields shifted(0);
  const Arguments image{"image",    "--vis", shifted.set(), "--imagename", shifted.folder() / "a",
                        "--imsize", "32",    "--cell",      "15arcsec"};
  BOOST_TEST(run(image).code == 0);
  BOOST_TEST(shifted.warnings() == "[]");
  point_field(shifted.set(), 1, 60 * degree, 44 * degree);
  check_refused(image);
}

BOOST_AUTO_TEST_CASE(a_set_that_does_not_say_where_antennas_pointed_is_imaged_with_a_warning) {
  const TwoFields unsaid(0);
  forget_pointing(unsaid.set(), 1);
  BOOST_TEST(run(unsaid.image()).code == 0);
  BOOST_TEST(
      has(unsaid.warnings(), "whether the antennas see the image is not known: cannot find where antennas point in field 1"),
      unsaid.warnings());
}

BOOST_AUTO_TEST_CASE(fields_of_several_sets_are_named_with_their_sets) {
  const TwoFields first(0), second(4 * degree);
  Arguments image = first.image();
  image.insert(image.begin() + 3, second.set());
  const Outcome outcome = run(image);
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(has(outcome.err, "but 1 (ASIDE) of " + second.set() + " cannot see"), outcome.err);
  BOOST_TEST(run(image + Arguments{"--field", "0"}).code == 0);
  BOOST_TEST(!has(first.warnings(), "apart"), first.warnings());
}

BOOST_AUTO_TEST_CASE(telescopes_without_known_beams_are_imaged_with_a_warning_of_angles) {
  const TwoFields stations(4 * degree), unheard(4 * degree);
  name_telescope(stations.set(), "LOFAR");
  BOOST_TEST(run(stations.image()).code == 0);
  BOOST_TEST(has(stations.warnings(), "1 (ASIDE), 4 deg away;"), stations.warnings());
  name_telescope(unheard.set(), "UNHEARD");
  check_refused(unheard.image());  // its dishes of 25 m are taken as they are
  BOOST_TEST(has(run(unheard.image()).err, "is not known: it is taken to be that of a uniformly lit one"));
  set_dish_diameters(unheard.set(), 0);
  BOOST_TEST(run(unheard.image()).code == 0);
  BOOST_TEST(has(unheard.warnings(), "DISH_DIAMETER of 0 m"), unheard.warnings());
}

BOOST_AUTO_TEST_SUITE_END()
