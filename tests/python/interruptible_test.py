"""What takes long leaves the interpreter to others, and ends with Ctrl-C."""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import misfit


class Interruptible(unittest.TestCase):
    def count_during(self, call):
        """How often another Python thread ran, which gets its turn only where `call` lets go of the interpreter."""
        count, stop = 0, False

        def others():
            nonlocal count
            while not stop:
                count += 1
                time.sleep(1e-4)

        thread = threading.Thread(target=others)
        interval = sys.getswitchinterval()
        sys.setswitchinterval(1000)
        try:
            thread.start()
            before = count
            call()
            return count - before
        finally:
            sys.setswitchinterval(interval)
            stop = True
            thread.join()

    def test_other_threads_run_meanwhile(self):
        kernel = misfit.kernel(width=20)
        many = np.full(100000, 0.2)
        grid = dict(uvw=np.zeros((100000, 3)), freq=[1e9], pixsize_x=1e-5, pixsize_y=1e-5, epsilon=1e-9)
        for call in [lambda: misfit.kernel("prolate", 20, 0.21), lambda: kernel(np.tile(many, 20)),
                     lambda: kernel.taps(np.tile(many, 4)), lambda: kernel.correction(many), lambda: kernel.map_error(many),
                     lambda: misfit.vis2dirty(**grid, vis=np.ones((100000, 1), complex), npix_x=1000, npix_y=1000),
                     lambda: misfit.dirty2vis(**grid, dirty=np.ones((1000, 1000)))]:
            self.assertGreater(self.count_during(call), 2)
        self.assertLess(self.count_during(lambda: sum(range(100000))), 2)  # which keeps the interpreter to itself

    def test_an_interrupt_ends_a_computation_before_it_sees_the_last_number(self):
        places = np.full(2000000, 0.2)
        places[-1] = np.nan
        kernel = misfit.kernel()
        threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            kernel.map_error(places)

    def test_an_interrupt_ends_the_wait_for_a_solution(self):
        code = """if True:
            import os, signal, threading, misfit
            threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
            try:
                misfit.kernel("minimax", 20, 0.22)
            except KeyboardInterrupt:
                print("interrupted, kept", os.listdir(os.environ["MISFIT_CACHE"]))"""
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.run([sys.executable, "-c", code], env=dict(os.environ, MISFIT_CACHE=folder), capture_output=True)
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, b"interrupted, kept []\n", b""))


if __name__ == "__main__":
    unittest.main()
