"""What is said of runs and meshes: the keys of the command line's reports, as attributes and items."""

from __future__ import annotations

from typing import Any, Iterator, Mapping


class Report(Mapping[str, Any]):
    """A report: a mapping with the keys of ``isoweave mesh --report``, which are attributes, too.

    >>> report = Report({"triangles": 12, "seconds": {"total": 0.5}})
    >>> report.triangles, report["seconds"]["total"]
    (12, 0.5)
    """

    def __init__(self, facts: Mapping[str, Any]) -> None:
        self._facts = dict(facts)

    def __getitem__(self, key: str) -> Any:
        return self._facts[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._facts)

    def __len__(self) -> int:
        return len(self._facts)

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["_facts"][name]
        except KeyError:
            raise AttributeError(f"the report has no {name!r}; it has {', '.join(self.__dict__.get('_facts', ()))}") from None

    def __repr__(self) -> str:
        shown = ", ".join(f"{key}={self._facts[key]!r}" for key in self._shown() if key in self._facts)
        return f"{type(self).__name__}({shown})"

    def _shown(self) -> list[str]:
        return ["triangles", "triangles_extracted", "vertices", "components", "error", "digest"]


class Check(Report):
    """The invariants of a mesh, by its triangles alone. True where it is closed, manifold and oriented."""

    @property
    def closed(self) -> bool:
        """Whether every edge has two triangles or more."""
        return bool(self["open_edges"] == 0)

    @property
    def manifold(self) -> bool:
        """Whether no edge has more than two triangles, and no vertex more than one fan of them."""
        return bool(self["nonmanifold_edges"] == 0 and self["nonmanifold_vertices"] == 0)

    @property
    def oriented(self) -> bool:
        """Whether neighbouring triangles run along their edge in opposite directions."""
        return bool(self["misoriented_edges"] == 0)

    def __bool__(self) -> bool:
        return self.closed and self.manifold and self.oriented and self["triangles"] > 0

    def _shown(self) -> list[str]:
        return ["triangles", "vertices", "open_edges", "nonmanifold_edges", "components", "euler", "digest"]


class Forecast(Report):
    """What a run would take: ``triangles``, ``vertices``, ``peak_bytes``, ``least_bytes``, ``seconds``."""

    def _shown(self) -> list[str]:
        return ["triangles_extracted", "triangles", "peak_bytes", "least_bytes", "seconds"]


class Comparison(Report):
    """Distances between two meshes in the unit of the first: ``mean``, ``rms``, ``max`` of both ways together.

    ``a_to_b`` and ``b_to_a`` have each way. ``distances`` is a float32 array with the distance of each vertex of the
    first mesh to the second, where ``per_vertex=True`` asked for it, else None.
    """

    def __init__(self, facts: Mapping[str, Any]) -> None:
        super().__init__({**facts, **facts["both"]})

    def _shown(self) -> list[str]:
        return ["mean", "rms", "max"]
