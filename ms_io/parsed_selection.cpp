#include <casacore/ms/MSSel/MSSelectableTable.h>
#include <casacore/ms/MSSel/MSSelection.h>
#include <casacore/ms/MeasurementSets/MSSpectralWindow.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>

#include "imager/numerics/constants.h"
#include "ms_io/ephemeris_internal.h"
#include "ms_io/parsed_selection_internal.h"
#include "ms_io/selectable_things_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// The parts of a set that MSSelection reads.
class Selectable : public casacore::MSInterface {
 public:
  explicit Selectable(const casacore::MeasurementSet& set)
      : casacore::MSInterface(set), field_(without_ephemerides(set.field())) {}

  const casacore::MSField& field() override { return field_; }

 private:
  casacore::MSField field_;
};

casacore::TableExprNode rows_of(const casacore::MeasurementSet& set, casacore::MSSelection& selection) {
  Selectable selectable(set);
  return selection.toTableExprNode(&selectable);
}

void parse_uv_ranges(const casacore::MeasurementSet& set, const Selection& selection, ParsedSelection& parsed) {
  // MSSelection leaves the end of a lone distance undefined.
  for (const std::string& part : split(selection.uv_range.of(0), ',')) {
    if (part.find_first_of("~<>") == std::string::npos) {
      throw casacore::AipsError("'" + one_line(part) + "' is a distance and no range");
    }
  }
  casacore::MSSelection expression;
  expression.setUvDistExpr(selection.uv_range.of(0));
  const casacore::Matrix<double> ends = expression.getUVList(&set);  // columns of least and most
  const casacore::Vector<bool> in_metres = expression.getUVUnitsList(&set);
  for (std::size_t r = 0; r < in_metres.nelements(); ++r) parsed.uv.push_back({ends(0, r), ends(1, r), in_metres(r)});
  if (parsed.uv.empty()) throw casacore::AipsError("it names no range");  // none would stand for all
}

/// MSSelection moves channels beyond the last one onto it. A range whose first channel exists ends with the window instead.
void require_channels(const casacore::MeasurementSet& set, const std::string& expression) {
  const casacore::ScalarColumn<int> channels(set.spectralWindow(), "NUM_CHAN");
  for (const std::string& part : split(expression, ',')) {
    const std::size_t colon = part.find(':');
    if (colon == std::string::npos) continue;
    casacore::MSSelection windows;
    windows.setSpwExpr(part.substr(0, colon));
    for (const int window : windows.getSpwList(&set)) {
      const int count = channels(static_cast<casacore::rownr_t>(window));
      for (const std::string& range : split(one_line(part.substr(colon + 1)), ';')) {
        const bool by_index = range.find_first_not_of("0123456789~^ ") == std::string::npos;
        if (!by_index || range.empty() || std::isdigit(static_cast<unsigned char>(range[0])) == 0) continue;
        if (std::strtol(range.c_str(), nullptr, 10) >= count) {
          throw casacore::AipsError("'" + range + "' begins beyond the " + std::to_string(count) +
                                    " channels of spectral window " + std::to_string(window));
        }
      }
    }
  }
}

void parse_fields(const casacore::MeasurementSet& set, const Selection& selection, ParsedSelection& parsed) {
  casacore::MSSelection expression;
  expression.setFieldExpr(selection.field.of(0));
  rows_of(set, expression);
  for (const int field : expression.getFieldList()) parsed.fields.insert(field);
  parsed.all_fields = false;
}

void parse_windows(const casacore::MeasurementSet& set, const Selection& selection, ParsedSelection& parsed) {
  casacore::MSSelection expression;
  expression.setSpwExpr(selection.spectral_window.of(0));
  const casacore::Matrix<int> ranges = expression.getChanList(&set);  // rows of window, start, stop, step
  require_channels(set, selection.spectral_window.of(0));
  for (ssize_t r = 0; r < ranges.shape()(0); ++r) {
    const int step = std::max(1, ranges(r, 3));
    for (int c = ranges(r, 1); c <= ranges(r, 2); c += step) parsed.channels[ranges(r, 0)].insert(c);
  }
  parsed.all_windows = false;
  for (const std::string& part : split(selection.spectral_window.of(0), ',')) {  // MSSelection sorts them
    casacore::MSSelection one;
    one.setSpwExpr(part);
    for (const int window : one.getSpwList(&set))
      if (parsed.place_of(window) == parsed.listed_windows.size()) parsed.listed_windows.push_back(window);
  }
}

/// The ways to parse an expression.
struct Parser {
  PerSet Selection::*expression;
  casacore::Bool (casacore::MSSelection::*give)(const casacore::String&);  ///< null: it is not MSSelection's
  void (*alone)(const casacore::MeasurementSet&, const Selection&, ParsedSelection&) = nullptr;  ///< null: it is for the rows
};

constexpr std::array<Parser, selection_kinds.size()> parsers{
    {{&Selection::field, &casacore::MSSelection::setFieldExpr, parse_fields},
     {&Selection::spectral_window, &casacore::MSSelection::setSpwExpr, parse_windows},
     {&Selection::uv_range, nullptr, parse_uv_ranges},
     {&Selection::time_range, &casacore::MSSelection::setTimeExpr},
     {&Selection::antenna, &casacore::MSSelection::setAntennaExpr},
     {&Selection::scan, &casacore::MSSelection::setScanExpr},
     {&Selection::intent, &casacore::MSSelection::setStateExpr},
     {&Selection::observation, &casacore::MSSelection::setObservationExpr}}};

const Parser& parser_of(const SelectionKind& kind) {
  return *std::find_if(parsers.begin(), parsers.end(), [&](const Parser& p) { return p.expression == kind.expression; });
}

void parse_alone(const casacore::MeasurementSet& set, const Selection& selection, const Parser& parser,
                 ParsedSelection& parsed) {
  if (parser.alone) return parser.alone(set, selection, parsed);
  casacore::MSSelection expression;
  (expression.*parser.give)((selection.*parser.expression).of(0));
  rows_of(set, expression);
}

/// The refusal of an expression: what is wrong with it and, where nothing in the set matches, what there is.
std::string refusal(const casacore::MeasurementSet& set, const SelectionKind& kind, const std::string& expression,
                    const std::exception& error) {
  const std::string option = std::string("--") + kind.option + " '" + expression + "'", words = one_line(error.what());
  if (says_no_match(words)) {
    try {
      const SelectableThings there = selectable_things(set, kind);
      if (!there.list.empty()) return option + ": the set has no such " + there.singular + "; expected some of " + there.list;
      if (!there.plural.empty()) return option + ": the set names no " + there.plural + "; expected no --" + kind.option;
    } catch (const casacore::AipsError&) {  // of a subtable that cannot be read: casacore's words stand
    }
  }
  return option + " selects nothing: " + words + "; expected " + kind.expected;
}

/// True if a time of the expression may be one without a date.
bool lacks_date(const std::string& times) {
  const std::vector<std::string> parts = split(times, ',');
  return !one_line(times).empty() &&
         std::any_of(parts.begin(), parts.end(), [](const std::string& part) { return part.find('/') == std::string::npos; });
}

bool in_order_of_time(const casacore::MeasurementSet& set) {
  const casacore::Vector<double> time = casacore::ScalarColumn<double>(set, "TIME").getColumn();
  return std::is_sorted(time.begin(), time.end());
}

/// True where the selection holds, [row]. casacore takes the date of a time without one from the first row, which is the
/// earliest here.
std::vector<bool> rows_in_order_of_time(const casacore::MeasurementSet& set, casacore::MSSelection& selection) {
  const casacore::MeasurementSet sorted(set.sort("TIME"));
  const casacore::Table found = sorted(rows_of(sorted, selection));
  std::vector<bool> rows(set.nrow(), false);
  for (const casacore::rownr_t row : found.rowNumbers(set)) rows[row] = true;
  return rows;
}

}  // namespace

std::size_t ParsedSelection::place_of(int window) const {
  if (all_windows) return static_cast<std::size_t>(window);
  return static_cast<std::size_t>(std::find(listed_windows.begin(), listed_windows.end(), window) - listed_windows.begin());
}

bool ParsedSelection::uv_in_wavelengths() const {
  return std::any_of(uv.begin(), uv.end(), [](const UvRange& range) { return !range.in_metres; });
}

bool ParsedSelection::has_uv(const double* uvw_m, double reference_frequency_hz) const {
  const double square_m2 = uvw_m[0] * uvw_m[0] + uvw_m[1] * uvw_m[1];
  return uv.empty() || std::any_of(uv.begin(), uv.end(), [&](const UvRange& range) {
           const double unit_m = range.in_metres ? 1 : imager::speed_of_light_m_s / reference_frequency_hz;
           const double least = range.least * unit_m, most = range.most * unit_m;
           return square_m2 >= least * least && square_m2 <= most * most;
         });
}

bool ParsedSelection::has_row(std::uint64_t row) const {
  if (!listed_rows.empty()) return listed_rows[row];
  return rows.isNull() || rows.getBool(casacore::TableExprId(row));
}

ParsedSelection parse_selection(const casacore::MeasurementSet& set, const std::string& path, const Selection& selection) {
  ParsedSelection parsed;
  bool among_rows = false;
  casacore::MSSelection all;  // a time without a date has that of the earliest row that the others select
  for (const SelectionKind& kind : selection_kinds) {
    const std::string& expression = (selection.*kind.expression).of(0);
    if (one_line(expression).empty()) continue;
    const Parser& parser = parser_of(kind);
    try {
      parse_alone(set, selection, parser, parsed);
    } catch (const casacore::AipsError& error) {
      throw std::runtime_error(path + ": " + refusal(set, kind, expression, error));
    } catch (const casacore::ArrayError& error) {  // of a range that ends before it begins
      throw std::runtime_error(path + ": " + refusal(set, kind, expression, error));
    }
    if (parser.give) (all.*parser.give)(expression);
    among_rows = among_rows || !parser.alone;
  }
  if (among_rows) {
    translated(path + ": " + to_text(selection), [&] {
      if (lacks_date(selection.time_range.of(0)) && !in_order_of_time(set))
        parsed.listed_rows = rows_in_order_of_time(set, all);
      else
        parsed.rows = rows_of(set, all);
    });
  }
  return parsed;
}

}  // namespace misfit::ms_io
