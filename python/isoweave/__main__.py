"""The command line: ``python -m isoweave``, and the script ``isoweave``."""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys
from typing import NoReturn, Sequence

PROGRAM = pathlib.Path(__file__).resolve().parent / "bin" / "isoweave"


def run_program(arguments: Sequence[str]) -> subprocess.CompletedProcess[bytes]:
    """Runs the command line, with its output kept."""
    return subprocess.run([str(PROGRAM), *arguments], capture_output=True, check=False)


def main() -> NoReturn:
    """Becomes the command line."""
    try:
        os.execv(PROGRAM, ["isoweave", *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"isoweave: {PROGRAM}: {error.strerror}")


if __name__ == "__main__":
    main()
