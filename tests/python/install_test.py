"""The installed module is the one that was built."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import misfit

PACKAGE = Path(misfit.__file__).parent
BUILD = PACKAGE.parents[2]


class Install(unittest.TestCase):
    def test_the_component_python_is_a_module_that_needs_nothing_of_the_build(self):
        with tempfile.TemporaryDirectory() as prefix:
            install = ["cmake", "--install", str(BUILD), "--component", "python", "--prefix", prefix]
            subprocess.run(install, check=True, capture_output=True)
            [installed] = Path(prefix).glob("**/misfit/__init__.py")
            files = [{path.name for path in folder.iterdir() if path.is_file()} for folder in (PACKAGE, installed.parent)]
            self.assertEqual(*files)
            code = "import misfit; print(misfit.__file__, misfit.__version__, misfit.kernel())"
            environment = dict(os.environ, PYTHONPATH=str(installed.parents[1]))
            printed = subprocess.check_output([sys.executable, "-c", code], env=environment, cwd=prefix, text=True)
            self.assertEqual(printed, f"{installed} {misfit.__version__} {misfit.kernel()}\n")


if __name__ == "__main__":
    unittest.main()
