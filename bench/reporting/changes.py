"""What has changed since the results that are kept, goal by goal."""
from reporting.goals import GOALS
from reporting.results import machines, on_machine
from reporting.tables import number

UNKNOWN_NOISE = 0.05  # of a value whose rounds have told nothing of it


def change(goal, before, now):
    """Whether a case is better, worse, or the same within its noise."""
    noise = max(UNKNOWN_NOISE if case.noise is None else case.noise for case in (before, now))
    if abs(now.value - before.value) <= noise * abs(before.value):
        return "same"
    return "better" if (now.value > before.value) == goal.at_least else "worse"


def compared_text(goal, before, now):
    """The figures of the cases that both have, and how many of these changed. `before`, `now`: cases by their names."""
    both = sorted(before.keys() & now.keys())
    if not both:
        return f"before not measured, now {number(goal.figure(now.values()).value)}"
    old, new = (goal.figure([cases[name] for name in both]) for cases in (before, now))
    changes = [change(goal, before[name], now[name]) for name in both]
    return (f"before {number(old.value)}, now {number(new.value)}: {change(goal, old, new)} "
            f"({changes.count('better')} better, {changes.count('worse')} worse of {len(both)})")


def goal_line(goal, before, now, processors):
    """`before`, `now`: results of machines with so many processors. Nothing where such a machine has no such goal."""
    if goal.bound_on(processors) is None:
        return None
    kept, found = ({case.name: case for case in goal.cases(results)} for results in (before, now))
    if not found:
        return f"{goal.name()}: not measured now" if kept else None
    met = goal.is_met(goal.figure(found.values()).value, processors)
    return f"{goal.name()}, {goal.text()}: {compared_text(goal, kept, found)}; {'met' if met else 'missed'}"


def change_lines(before, now):
    """A line for each goal that either has measured."""
    for processors in machines(now):
        yield f"On {processors} processors:"
        sides = on_machine(before, processors), on_machine(now, processors)
        yield from filter(None, (goal_line(goal, *sides, processors) for goal in GOALS))
