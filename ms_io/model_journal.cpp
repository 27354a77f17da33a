#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "ms_io/model_journal_internal.h"

namespace misfit::ms_io {
namespace {

constexpr const char* unfinished = ".part";  ///< while it is written

constexpr const char* journal_kind = "unfinished";

std::string text_of(const ModelJournal& journal) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "misfit is writing a column, or was stopped while it did\n"
       << "command " << journal.command << "\nidentity " << journal.identity << "\nrows " << journal.rows << "\nwritten "
       << journal.written << "\nnonfinite_uvw_rows " << journal.nonfinite_uvw_rows << "\nchecksum " << journal.checksum.values
       << ' ' << journal.checksum.data << '\n';
  for (const Witness& witness : journal.witnesses)
    text << "witness " << witness.row << ' ' << witness.channel << ' ' << witness.before << ' ' << witness.after << '\n';
  for (const auto& [setup, row] : journal.done_below) text << "done " << setup << ' ' << row << '\n';
  text << "end\n";
  return text.str();
}

ModelJournal journal_of(std::istream& text, const std::string& column) {
  ModelJournal journal;
  std::string line, key;
  bool ended = false;
  std::getline(text, line);
  while (!ended && std::getline(text, line)) {
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    words >> key >> std::ws;
    if (key == "command") std::getline(words, journal.command);
    if (key == "identity") words >> journal.identity;
    if (key == "rows") words >> journal.rows;
    if (key == "written") words >> journal.written;
    if (key == "nonfinite_uvw_rows") words >> journal.nonfinite_uvw_rows;
    if (key == "checksum") words >> journal.checksum.values >> journal.checksum.data;
    if (Witness found; key == "witness" && words >> found.row >> found.channel >> found.before >> found.after)
      journal.witnesses.push_back(found);
    if (std::size_t setup = 0; key == "done" && words >> setup) words >> journal.done_below[setup];
    ended = key == "end";
  }
  if (!ended) journal = {};
  journal.column = column;
  return journal;
}

}  // namespace

std::vector<std::string> files_beside(const casacore::Table& set, const std::string& kind, const std::string& column) {
  std::string name = "misfit_" + kind + "_" + column;
  std::replace(name.begin(), name.end(), '/', '_');
  std::vector<std::string> files;
  const casacore::Block<casacore::String> tables = set.getPartNames(true);
  for (std::size_t t = 0; t < tables.nelements(); ++t) files.push_back(std::string(tables[t]) + "/" + name);
  return files;
}

void replace_file(const std::string& path, const std::string& contents, const std::string& meaning) {
  const std::string beside = path + unfinished;
  errno = 0;
  std::ofstream file(beside, std::ios::binary);
  file << contents << std::flush;
  std::error_code error;
  if (file) std::filesystem::rename(beside, path, error);
  if (!file) error = {errno, std::generic_category()};
  if (error) throw std::runtime_error("cannot write " + path + ", which is to hold " + meaning + ": " + error.message());
}

void remove_file(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove(path + unfinished, ignored);
  std::filesystem::remove(path, ignored);
}

std::optional<ModelJournal> read_journal(const casacore::Table& set, const std::string& column) {
  for (const std::string& path : files_beside(set, journal_kind, column)) {
    if (std::ifstream file(path); file) return journal_of(file, column);
  }
  return std::nullopt;
}

void write_journal(const casacore::Table& set, const ModelJournal& journal) {
  for (const std::string& path : files_beside(set, journal_kind, journal.column))
    replace_file(path, text_of(journal), "how many rows of the column are written");
}

void remove_journal(const casacore::Table& set, const std::string& column) {
  for (const std::string& path : files_beside(set, journal_kind, column)) remove_file(path);
}

bool outlived(const casacore::Table& set, const ModelJournal& journal) {
  return !journal.witnesses.empty() && changed(journal.witnesses, set, journal.column) == journal.witnesses.size();
}

std::string incompleteness(const std::string& path, const ModelJournal& journal) {
  return journal.column + " of " + path + " is incomplete: " + std::to_string(journal.written) + " of " +
         std::to_string(journal.rows) + " rows were written before by " +
         (journal.command.empty() ? "a run that left no trace" : journal.command);
}

}  // namespace misfit::ms_io
