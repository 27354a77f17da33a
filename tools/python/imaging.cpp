// The program in the process of Python: a module of its own, since it takes casacore, which arrays need not.
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/base/interrupt.h"
#include "tools/base/process.h"
#include "tools/base/progress.h"
#include "tools/program.h"

namespace py = pybind11;

namespace {

using namespace misfit::tools;

/// Raised as ValueError.
struct WrongUsage : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Silences casacore's words on stderr about failures that it also throws, as long as it lives.
class QuietErrors {
 public:
  QuietErrors() : before_(std::cerr.rdbuf(nullptr)) {}
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
  ~QuietErrors() { std::cerr.rdbuf(before_); }

 private:
  std::streambuf* before_;
};

/// Lines go to `tell` as long as it lives.
class ToldLines {
 public:
  explicit ToldLines(std::function<void(const std::string&)> tell) { tell_lines(std::move(tell)); }
  ToldLines(const ToldLines&) = delete;
  ToldLines& operator=(const ToldLines&) = delete;
  ~ToldLines() { tell_lines({}); }
};

/// Runs the command `words` as the program does, without a call to Python.
void run_words(std::vector<std::string> words, Outcome& outcome) {
  std::string line = "misfit";
  for (const std::string& word : words) line += " " + word;
  const std::unique_ptr<CLI::App> program = make_program({line, misfit::imager::alone(), &outcome});
  std::reverse(words.begin(), words.end());  // as the parser takes them
  try {
    program->parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    throw WrongUsage(usage_message(error, *program));
  } catch (const std::invalid_argument& error) {
    throw WrongUsage(error.what());
  }
}

/// Returns (report as JSON, words, whether the user stopped it). One call at a time, which misfit/_program.py sees to.
py::tuple run(const std::vector<std::string>& words, const py::function& tell, bool catches_interrupts) {
  static std::once_flag prepared;
  std::call_once(prepared, prepare_process);
  Outcome outcome;
  bool stopped = false;
  {
    const py::gil_scoped_release others_run;
    const QuietErrors quiet;
    const BorrowedProcess borrowed(catches_interrupts);
    const ToldLines told([&tell](const std::string& line) {
      const py::gil_scoped_acquire python;
      try {
        tell(line);
      } catch (py::error_already_set& error) {
        error.discard_as_unraisable("misfit");
      }
    });
    try {
      run_words(words, outcome);
      stopped = interrupted();  // where nothing waited for it
    } catch (const Interrupted&) {
      stopped = true;
    }
  }
  return py::make_tuple(outcome.report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), outcome.words, stopped);
}

}  // namespace

PYBIND11_MODULE(_imaging, m) {
  m.doc() = "The program misfit, compiled for Python.";
  py::register_exception<WrongUsage>(m, "WrongUsage", PyExc_ValueError);
  m.def("run", &run, py::arg("words"), py::arg("tell"), py::arg("catches_interrupts"));
}
