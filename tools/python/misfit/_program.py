"""The program in this process."""

import json
import logging
import re
import threading

log = logging.getLogger("misfit")
_OWN_NAMES = {"chanwidth": "width"}


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

    return re.sub(r"(?<![^\s(,;'])--([a-z][a-z-]*[a-z])\b", parameter, message)


def run(words):
    """
    Run a command of the program, here, while other Python threads run.

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
    from . import _imaging  # takes casacore, which arrays need not

    main = threading.current_thread() is threading.main_thread()
    try:
        report, said, stopped = _imaging.run(words, _tell, main)
    except _imaging.WrongUsage as error:
        raise ValueError(_in_python(str(error))) from None
    except RuntimeError as error:
        raise RuntimeError(_in_python(str(error))) from None
    if stopped:
        raise KeyboardInterrupt(said or "stopped by the user")
    return json.loads(report), said
