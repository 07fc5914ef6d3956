"""isoweave on volumes by URL: a local server counts what is asked, and fails on cue.

    python3 run.py ISOWEAVE [TEST...]
"""
import sys
import unittest

from credentials import Secrets  # noqa: F401
from faults import Faults  # noqa: F401
from same_mesh import SameMesh  # noqa: F401

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
