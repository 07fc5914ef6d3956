"""How a run behaves in Python: Ctrl-C stops it, exceptions of callbacks come out as they were, progress is told."""

from __future__ import annotations

import ctypes
import os
import queue
import sys
import threading
from dataclasses import dataclass
from typing import Any, Callable, Protocol, Union

from . import _library as c

_DEVICES = {"auto": 0, "cpu": 1, "cuda": 2}
_SECONDS = {"s": 1, "min": 60, "h": 3600}
_BYTES = {"": 1, "K": 10**3, "M": 10**6, "G": 10**9, "T": 10**12, "Ki": 2**10, "Mi": 2**20, "Gi": 2**30, "Ti": 2**40}


@dataclass(frozen=True)
class Progress:
    """How far a run is."""

    layer: int
    """Layers that are done."""
    layers: int
    """Layers in all."""
    voxels: int
    """Samples read so far."""
    live_triangles: int
    """Triangles that are held."""
    final_triangles: int
    """Triangles that are written."""
    bytes: int
    """Bytes held by the slab and the undecided zone."""

    def _steps(self) -> tuple[int, int, str]:
        return self.layer, self.layers, "layer"

    def _line(self) -> str:
        return f"layer {self.layer} of {self.layers}, {self.final_triangles} triangles"


ProgressLike = Union[bool, Callable[[Progress], Any], None]


class _Told(Protocol):
    """What a bar or a line shows."""

    def _steps(self) -> tuple[int, int, str]:
        """Steps that are done, steps in all, and what a step is called."""

    def _line(self) -> str: ...


class Teller(Protocol):
    """Tells how far a run is."""

    def tell(self, progress: Any) -> Any: ...

    def close(self) -> None: ...


class _Silent:
    def tell(self, progress: _Told) -> None:
        pass

    def close(self) -> None:
        pass


class _Callback:
    def __init__(self, callback: Callable[[Any], Any]) -> None:
        self.tell = callback

    def close(self) -> None:
        pass


class _Lines:
    """One line on standard error, rewritten."""

    def tell(self, progress: _Told) -> None:
        sys.stderr.write(f"\risoweave: {progress._line()}")
        sys.stderr.flush()

    def close(self) -> None:
        sys.stderr.write("\n")


class _Bar:
    """A bar of tqdm."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm = tqdm
        self._bar: Any = None

    def tell(self, progress: _Told) -> None:
        done, total, unit = progress._steps()
        if self._bar is None:
            self._bar = self._tqdm(total=total, unit=unit, desc="isoweave")
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


def teller(progress: bool | Callable[[Any], Any] | None) -> Teller:
    """Who tells how far a run is: a function, a bar of tqdm, one line, or nobody."""
    if progress is None or progress is False:
        return _Silent()
    if callable(progress):
        return _Callback(progress)
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Lines()
    return _Bar(tqdm)


def parse_bytes(memory: int | str | None) -> int:
    """An amount of memory such as 800000000, "800M" or "2G"; 0 for None."""
    if memory is None:
        return 0
    if isinstance(memory, str):
        text = memory.strip().removesuffix("B")
        digits = text.rstrip("KMGTi")
        try:
            memory = int(float(digits) * _BYTES[text[len(digits) :]])
        except (KeyError, ValueError):
            raise ValueError(f"memory: expected an amount such as 800M or 2G, found {memory!r}") from None
    if memory < 1:
        raise ValueError(f"memory: expected at least 1 byte, found {memory}")
    return memory


def parse_every(every: float | str) -> tuple[float, int]:
    """How often a state is saved: seconds, and layers or 0. As the command line's --every: 300, "5min" or "16layers"."""
    number, unit = str(every), "s"
    if isinstance(every, str):
        number = every.rstrip("abcdefghijklmnopqrstuvwxyz")
        unit = every[len(number) :]
    try:
        if unit == "layers":
            seconds, layers = 0.0, int(number)
        else:
            seconds, layers = float(number) * _SECONDS[unit], 0
    except (KeyError, ValueError):
        seconds, layers = 0.0, 0
    if not (seconds > 0 or layers > 0):
        raise ValueError(f"every: expected seconds above 0, or a text such as 90s, 5min, 2h or 16layers, found {every!r}")
    return seconds, layers


class _Errand:
    """Work for another thread, and what became of it."""

    def __init__(self, work: Callable[[], Any]) -> None:
        self._work = work
        self.done = threading.Event()
        self.result: Any = None
        self.error: BaseException | None = None

    def do(self) -> None:
        try:
            self.result = self._work()
        except BaseException as error:
            self.error = error
        self.done.set()


class RunState:
    """A run that may be stopped: by Ctrl-C, by a callback's exception, or by False from a progress callback.

    Callbacks are wrapped by :meth:`guarded`: an exception is kept, the run stops, and :meth:`call` raises it.
    """

    def __init__(self) -> None:
        self._stop = c.Handle(c.library.iw_stop_new(), "iw_stop_free")
        if not self._stop.pointer:
            raise MemoryError("expected memory for a run, found none")
        self._lock = threading.Lock()
        self._error: BaseException | None = None
        self._errands: queue.SimpleQueue[_Errand | None] | None = None  # where the call has a thread of its own
        self._abandoned = False

    @property
    def stop_pointer(self) -> int | None:
        return self._stop.pointer

    def stop(self) -> None:
        c.library.iw_stop_set(self._stop.pointer)

    def guarded(self, work: Callable[[], Any]) -> int:
        """Does a callback's work. Returns 0, or 1 to stop the run."""
        try:
            return 1 if work() is False else 0
        except BaseException as error:
            with self._lock:
                if self._error is None:
                    self._error = error
            self.stop()
            return 1

    def in_caller(self, work: Callable[[], Any]) -> Any:
        """Does work in the thread that has asked for the run, where programs with windows must touch them."""
        if self._errands is None:
            return work()
        errand = _Errand(work)
        self._errands.put(errand)
        while not errand.done.wait(0.1):
            if self._abandoned:
                return False
        if errand.error is not None:
            raise errand.error
        return errand.result

    @staticmethod
    def _call_is_done(errands: queue.SimpleQueue[_Errand | None]) -> bool:
        """Does the next errand of the thread that makes the call."""
        try:
            errand = errands.get(timeout=0.1)
        except queue.Empty:
            return False
        if errand is None:
            return True
        errand.do()
        return False

    def call(self, name: str, *arguments: Any) -> Any:
        """Makes a call of the C interface, without the GIL.

        In the main thread the call is made by a thread of its own, so that Ctrl-C arrives here.
        """
        if threading.current_thread() is not threading.main_thread():
            return self._finish(lambda: c.call(name, *arguments))
        outcome: list[Any] = []
        self._errands = queue.SimpleQueue()

        def work() -> None:
            try:
                outcome.append((c.call(name, *arguments), None))
            except BaseException as error:
                outcome.append((None, error))
            errands.put(None)

        errands = self._errands
        thread = threading.Thread(target=work, name="isoweave")
        thread.start()
        try:
            while not self._call_is_done(errands):
                pass
        except BaseException:  # KeyboardInterrupt, or what a signal handler of the program raises
            self._abandoned = True
            self.stop()
            thread.join()
            raise
        thread.join()

        def result() -> Any:
            report, error = outcome[0]
            if error is not None:
                raise error
            return report

        return self._finish(result)

    def _finish(self, result: Callable[[], Any]) -> Any:
        try:
            report = result()
        except c.Stopped:
            if self._error is not None:
                raise self._error from None
            raise
        if self._error is not None:
            raise self._error
        return report


class Runner:
    """A run's settings for the C interface, and its progress."""

    def __init__(
        self, threads: int, device: str, memory: int | str | None, progress: ProgressLike, state: RunState | None = None
    ) -> None:
        self.state = RunState() if state is None else state
        self._teller = told = teller(progress)
        if device not in _DEVICES:
            raise ValueError(f"device: expected one of {', '.join(_DEVICES)}, found {device!r}")
        self.struct = c.Run(
            threads=threads, device=_DEVICES[device], memory=parse_bytes(memory), stop=self.state.stop_pointer
        )
        if progress is None or progress is False:
            return

        def tell(_context: int | None, found: Any) -> int:
            p = found.contents
            now = Progress(p.layer, p.layers, p.voxels, p.live_triangles, p.final_triangles, p.bytes)
            return self.state.guarded(lambda: self.state.in_caller(lambda: told.tell(now)))

        self.struct.progress = c.TellProgress(tell)

    def save_in(self, checkpoint: str | os.PathLike[str] | None, resume: bool, every: float | str) -> None:
        """Saves the state of the run in a folder, where one is named."""
        seconds, layers = parse_every(every)
        if checkpoint is None:
            if resume:
                raise ValueError("resume: expected the folder of the run as checkpoint, found none")
            return
        self.struct.checkpoint = os.fsencode(checkpoint)
        self.struct.checkpoint_seconds, self.struct.checkpoint_layers = seconds, layers
        self.struct.resume = int(resume)

    def call(self, name: str, *arguments: Any) -> Any:
        try:
            return self.state.call(name, *arguments)
        finally:
            self._teller.close()

    def pointer(self) -> Any:
        return ctypes.byref(self.struct)
