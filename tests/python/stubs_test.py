"""The type stubs say of each public name what the module has."""

import ast
import inspect
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import misfit

PACKAGE = Path(misfit.__file__).parent
STUB = ast.parse((PACKAGE / "__init__.pyi").read_text())

# Every call that a reader of the stubs may write, and what its result is to the type checker.
USAGE = """
import pathlib
import numpy as np
import numpy.typing as npt
import misfit

kernel: misfit.Kernel = misfit.kernel("least-misfit", width=8, x0=0.3)
names: list[str] = misfit.kernel_names()
number: float = kernel(0.5) + kernel.correction(0.1) + kernel.map_error(x=0.1) + kernel.mean_error
values: npt.NDArray[np.float64] = kernel(np.linspace(-4, 4, 9)) + kernel.coefficients.sum()
taps: npt.NDArray[np.float64] = kernel.taps([0.1, 0.2])
kernel.write(pathlib.Path("k.fits"), sampling=64)
again: misfit.Kernel = misfit.read_kernel("k.fits")
uvw, freq, vis = np.zeros((5, 3)), [1e9, 2e9], np.zeros((5, 2), np.complex64)
dirty: npt.NDArray[np.float32] = misfit.vis2dirty(
    uvw=uvw, freq=freq, vis=vis, npix_x=8, npix_y=8, pixsize_x=1e-5, pixsize_y=1e-5, epsilon=1e-4, kernel=kernel)
double: npt.NDArray[np.float64] = np.zeros((8, 8))
back: npt.NDArray[np.complex128] = misfit.dirty2vis(
    uvw=uvw, freq=freq, dirty=double, pixsize_x=1e-5, pixsize_y=1e-5, epsilon=1e-9, mask=np.ones((5, 2), np.uint8))
cleaned: misfit.CleanResult = misfit.clean(
    uvw=uvw, freq=freq, vis=vis, npix_x=8, npix_y=8, pixsize_x=1e-5, pixsize_y=1e-5, scales=[0, 5])
beam: tuple[float, float, float] = cleaned.beam
summary: dict[str, object] = misfit.tclean(
    ["a.ms", pathlib.Path("b.ms")], spw=["0", "1:3~5"], imagename="a", imsize=[64, 64], cell=["1arcsec"], start=3, dryrun=True)
written: dict[str, object] = misfit.predict("a.ms", model=pathlib.Path("a.model"))
written = misfit.subtract("a.ms", components="a.csv", column="DATA")
"""


def defined(node):
    """The functions and classes below `node` by name; of an overloaded function the last form, which is the widest."""
    return {item.name: item for item in node.body if isinstance(item, (ast.FunctionDef, ast.ClassDef))}


def is_property(function):
    return any(isinstance(decorator, ast.Name) and decorator.id == "property" for decorator in function.decorator_list)


def parameters_of_stub(function):
    """(name, kind, default) of each parameter."""
    unnamed = ast.parse("def f(): ...").body[0]
    unnamed.args = function.args
    for argument in ast.walk(unnamed.args):
        if isinstance(argument, ast.arg):
            argument.annotation = None
    namespace = {}
    exec(ast.unparse(unnamed), namespace)
    return parameters(namespace["f"])


def parameters(function):
    return [(p.name, p.kind, p.default) for p in inspect.signature(function).parameters.values()]


def documented_parameters(function):
    """Names in the section Parameters of a docstring in numpy's style."""
    section = re.search(r"Parameters\n-+\n(.*?)(\n\n[A-Z]\w+\n-+\n|$)", inspect.getdoc(function), re.DOTALL)
    names = re.findall(r"^([\w, ]+) :", section[1], re.MULTILINE) if section else []
    return [name for group in names for name in group.split(", ")]


def functions():
    """Each public function and method: its name, what the stub has and what the module has."""
    for name, node in defined(STUB).items():
        actual = getattr(misfit, name)
        if isinstance(node, ast.FunctionDef):
            yield name, node, actual
            continue
        for method, inner in defined(node).items():
            if not is_property(inner):
                yield f"{name}.{method}", inner, getattr(actual, method)


class Stubs(unittest.TestCase):
    def test_every_public_name_has_its_stub(self):
        variables = {node.target.id for node in STUB.body if isinstance(node, ast.AnnAssign)}
        self.assertEqual(set(defined(STUB)) | variables, set(misfit.__all__))

    def test_parameters_and_defaults_are_those_of_the_module(self):
        for name, node, actual in functions():
            with self.subTest(function=name):
                self.assertEqual(parameters_of_stub(node), parameters(actual))

    def test_classes_have_what_their_stubs_have(self):
        for name, node in defined(STUB).items():
            if isinstance(node, ast.ClassDef):
                actual = getattr(misfit, name)
                public = {member for member in vars(actual) if not member.startswith("_")}
                fields = {item.target.id for item in node.body if isinstance(item, ast.AnnAssign)}
                self.assertEqual({member for member in defined(node) if not member.startswith("_")} | fields, public)
                for member in public - fields:
                    self.assertEqual(is_property(defined(node)[member]), isinstance(vars(actual)[member], property), member)

    def test_every_parameter_is_described(self):
        for name, _, actual in functions():
            names = [parameter for parameter, _, _ in parameters(actual) if parameter != "self"]
            with self.subTest(function=name):
                self.assertEqual(documented_parameters(actual), names)

    @unittest.skipUnless(shutil.which("mypy"), "there is no mypy (package mypy)")
    def test_a_type_checker_takes_the_stubs_and_a_use_of_them(self):
        with tempfile.TemporaryDirectory() as folder:
            usage = Path(folder) / "usage.py"

            def errors(text):
                usage.write_text(text)
                checks = ["mypy", "--strict", "--cache-dir", folder, str(usage)]
                run = subprocess.run(checks, env=dict(os.environ, MYPYPATH=str(PACKAGE.parent)), capture_output=True, text=True)
                return [line for line in (run.stdout + run.stderr).splitlines() if ": error:" in line]

            self.assertEqual(errors(USAGE), [])
            self.assertEqual(len(errors(USAGE + "misfit.kernel(widht=7)\nmisfit.read_kernel(3)\n")), 2)


if __name__ == "__main__":
    unittest.main()
