"""Runs of the command line that can be stopped, with its errors as exceptions."""

from __future__ import annotations

import subprocess
from typing import Callable

from .__main__ import PROGRAM
from ._library import Stopped, error_of


def run(*arguments: str, wanted: Callable[[], bool] = lambda: True) -> bytes:
    """Runs the command line, and returns its output. An exception such as Ctrl-C ends it, and so does not being wanted."""
    with subprocess.Popen([str(PROGRAM), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        try:
            while True:
                try:
                    output, line = process.communicate(timeout=0.2)
                    break
                except subprocess.TimeoutExpired:
                    if not wanted():
                        raise Stopped(f"isoweave {arguments[0]}: stopped") from None
        except BaseException:
            process.terminate()  # by the signal upon which the program leaves no file
            process.communicate()
            raise
    if process.returncode < 0:
        raise RuntimeError(f"isoweave {arguments[0]}: ended by signal {-process.returncode}")
    if process.returncode > 0:
        raise error_of(process.returncode, line.decode(errors="replace").strip().removeprefix("isoweave: "))
    return output
