"""Models' visibilities in MeasurementSets."""

import os

from . import _program


def _write(vis, options, flags=()):
    words = ["predict", "--vis", os.fspath(vis), *flags]
    for name, value in options.items():
        if value is not None and value != "":
            words += ["--" + name, str(value)]
    with _program.turn.taken():
        report, said = _program.run(words)
    _program.tell_all(said)
    return report


def predict(
    vis,
    *,
    model=None,
    components=None,
    column="MODEL_DATA",
    field="",
    spw="",
    timerange="",
    uvrange="",
    antenna="",
    scan="",
    intent="",
    observation="",
    phasecenter="",
    apply_beam=False,
    beam="",
    accuracy=None,
    kernel=None,
    threads=None,
):
    """
    Write a model's visibilities into a column of a MeasurementSet, as `misfit predict` does.

    Parameters
    ----------
    vis : path
        The MeasurementSet; only the column is written.
    model, components : path
        One of them: a FITS or CASA image in Jy/pixel, or a CSV list of sources.
    column : str
        Column to write.
    field, spw, timerange, uvrange, antenna, scan, intent, observation : str
        What is written: selections as CASA's tasks take them.
    phasecenter : str
        What the model is about, where it does not say so itself; see `misfit predict --help`.
    apply_beam : bool
        The model is the sky without a primary beam, which each row sees through its own dishes' beams.
    beam : str
        The primary beam of `apply_beam` in place of the antennas' own, as `misfit image --beam` takes it.
    accuracy : float, optional
        Relative accuracy of the visibilities.
    kernel : str, optional
        Gridding function of `model`: a name, or a kernel-table file.
    threads : int, optional
        Threads; all cores where it is None.

    Returns
    -------
    dict
        column, visibilities, rows, rows_written_before (by a run that was cut), rows_of_nonfinite_uvw.

    Raises
    ------
    ValueError
        For a parameter that is wrong.
    RuntimeError
        For data or files that cannot be used.
    KeyboardInterrupt
        After Ctrl-C. The same call goes on from there.
    """
    return _write(vis, dict(model=model, components=components, column=column, field=field, spw=spw, timerange=timerange,
                            uvrange=uvrange, antenna=antenna, scan=scan, intent=intent, observation=observation,
                            phasecenter=phasecenter, beam=beam, accuracy=accuracy, kernel=kernel, threads=threads),
                  ["--apply-beam"] if apply_beam else [])


def subtract(
    vis,
    *,
    model=None,
    components=None,
    datacolumn=None,
    column=None,
    field="",
    spw="",
    timerange="",
    uvrange="",
    antenna="",
    scan="",
    intent="",
    observation="",
    phasecenter="",
    apply_beam=False,
    beam="",
    accuracy=None,
    kernel=None,
    threads=None,
):
    """
    Write data without a model's visibilities into a column of a MeasurementSet, as `misfit predict --subtract` does.

    Parameters
    ----------
    vis : path
        The MeasurementSet; only the column is written.
    model, components : path
        One of them: a FITS or CASA image in Jy/pixel, or a CSV list of sources.
    datacolumn : str, optional
        What is subtracted from: "data" where it is None, "corrected", "model", or a column's name.
    column : str, optional
        Column to write: CORRECTED_DATA where it is None, which must not exist then.
    field, spw, timerange, uvrange, antenna, scan, intent, observation : str
        What is written: selections as CASA's tasks take them.
    phasecenter : str
        What the model is about, where it does not say so itself.
    apply_beam : bool
        As of `predict`.
    beam : str
        As of `predict`.
    accuracy : float, optional
        Relative accuracy of the visibilities.
    kernel : str, optional
        Gridding function of `model`.
    threads : int, optional
        Threads; all cores where it is None.

    Returns
    -------
    dict
        As `predict`.

    Raises
    ------
    ValueError, RuntimeError, KeyboardInterrupt
        As `predict` does.
    """
    return _write(vis, dict(model=model, components=components, datacolumn=datacolumn, column=column, field=field, spw=spw,
                            timerange=timerange, uvrange=uvrange, antenna=antenna, scan=scan, intent=intent,
                            observation=observation, phasecenter=phasecenter, beam=beam, accuracy=accuracy, kernel=kernel,
                            threads=threads), ["--subtract"] + (["--apply-beam"] if apply_beam else []))
