"""Zero reaction manipulators: design, plan, simulate and record what a robot arm does to its base.

>>> import stillbase as sb
>>> spot = sb.Machine.builtin("spot")
>>> spot.drives
['shoulder', 'elbow', 'wrist']
>>> spot.check()["force_balanced"]
False

Numbers are SI, angles are radians. Names are those of the command line: `stillbase results` lists them.
"""

from ._stillbase import (
    Dynamics,
    Machine,
    NoAnswer,
    Run,
    StillbaseError,
    WrongInput,
    __version__,
    ask,
    plan,
    record,
    simulate,
)
from ._tables import trim

__all__ = [
    "Dynamics",
    "Machine",
    "NoAnswer",
    "Run",
    "StillbaseError",
    "WrongInput",
    "__version__",
    "ask",
    "plan",
    "record",
    "simulate",
    "trim",
]
