#include <fstream>
#include <locale>
#include <sstream>

#include "ms_io/model_journal_internal.h"
#include "ms_io/subtracted_models_internal.h"

namespace misfit::ms_io {
namespace {

constexpr const char* kind_of_file = "subtracted";

struct Record {
  std::vector<SubtractedModel> models;
  std::vector<Witness> witnesses;
};

/// The record in a file that is whole.
Record record_in(std::istream& text) {
  Record record;
  std::string line, key;
  while (std::getline(text, line)) {
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    words >> key >> std::ws;
    if (SubtractedModel one; key == "model" && words >> one.model >> one.selection >> std::ws) {
      std::getline(words, one.command);
      record.models.push_back(one);
    }
    if (Witness cell; key == "cell" && words >> cell.row >> cell.channel >> cell.after) {
      cell.before = cell.after;
      record.witnesses.push_back(cell);
    }
    if (key == "end") return record;
  }
  return {};
}

}  // namespace

std::vector<SubtractedModel> subtracted_models(const casacore::MeasurementSet& set, const std::string& column) {
  if (!set.tableDesc().isColumn(column)) return {};
  for (const std::string& path : files_beside(set, kind_of_file, column)) {
    std::ifstream file(path);
    if (!file) continue;
    const Record record = record_in(file);
    const bool written_since = !record.witnesses.empty() && changed(record.witnesses, set, column) == record.witnesses.size();
    if (!written_since) return record.models;
  }
  return {};
}

void write_subtracted_models(const casacore::MeasurementSet& set, const std::string& column,
                             const std::vector<SubtractedModel>& models, const std::vector<Witness>& witnesses) {
  if (models.empty()) {
    for (const std::string& path : files_beside(set, kind_of_file, column)) remove_file(path);
    return;
  }
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "misfit subtracted models from the data of this column\n";
  for (const SubtractedModel& one : models) text << "model " << one.model << ' ' << one.selection << ' ' << one.command << '\n';
  for (const Witness& cell : witnesses) text << "cell " << cell.row << ' ' << cell.channel << ' ' << cell.after << '\n';
  text << "end\n";
  for (const std::string& path : files_beside(set, kind_of_file, column))
    replace_file(path, text.str(), "the models that the column's data lack");
}

std::string lacks_already(const std::string& path, const std::string& column, const SubtractedModel& model) {
  return "the model of " + (model.command.empty() ? "a run that left no name" : model.command) +
         " has already been subtracted from " + column + " of " + path;
}

}  // namespace misfit::ms_io
