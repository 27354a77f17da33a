"""The program in this process."""

import contextlib
import json
import logging
import os
import re
import signal
import threading

log = logging.getLogger("misfit")
_OWN_NAMES = {"chanwidth": "width"}


class _Turn:
    """One run at a time, with all that it finds and leaves on disk: others wait, and Ctrl-C ends their waiting."""

    def __init__(self):
        self._lock = threading.Lock()
        self._owner = None

    @contextlib.contextmanager
    def taken(self):
        if self._owner == threading.get_ident():
            raise RuntimeError("a run of misfit is going on in this thread, which called this function; expected a call after it")
        with self._lock:
            self._owner = threading.get_ident()
            try:
                yield
            finally:
                self._owner = None


turn = _Turn()


def _tell(line):
    warning = line.startswith("warning: ")
    line = _in_python(line[len("warning: "):] if warning else line)
    log.log(logging.WARNING if warning else logging.INFO, "%s", line)


def tell_all(said):
    """Lines of what a command says at its end."""
    for line in said.splitlines():
        _tell(line)


def _in_python(message):
    """What the program says of its options, said of parameters."""
    def parameter(option):
        return _OWN_NAMES.get(option[1], option[1].replace("-", "_"))

    return re.sub(r"(?<![^\s(,;])--([a-z][a-z-]*[a-z])\b", parameter, message)


def run(words):
    """
    Run a command of the program, here, while other Python threads run, in a turn that the caller has taken.

    Its lines go to the logger "misfit": warnings as such, the rest as information. Ctrl-C ends CLEAN after its major cycle, and
    all else, or CLEAN when it comes twice, soon.

    Parameters
    ----------
    words : list of str
        As on the command line.

    Returns
    -------
    report : dict or None
        As report.json.
    said : str
        What the program would print.

    Raises
    ------
    ValueError
        For options that are wrong.
    RuntimeError
        For data or files that cannot be used.
    KeyboardInterrupt
        Where the user stopped it; images that CLEAN had then are written.
    """
    try:
        os.getcwd()
    except FileNotFoundError:
        raise RuntimeError("the current folder is not there any more; expected one, as casacore needs it") from None
    from . import _imaging  # takes casacore, which arrays need not

    # Who has a handler of their own keeps it.
    usual = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    try:
        report, said, stopped = _imaging.run(words, _tell, usual)
    except _imaging.WrongUsage as error:
        raise ValueError(_in_python(str(error))) from None
    except RuntimeError as error:
        raise RuntimeError(_in_python(str(error))) from None
    if stopped:
        tell_all(said)
        raise KeyboardInterrupt("stopped by the user")
    return json.loads(report), said
