"""
Zero reaction manipulators: the part of the package that is written in Rust.
"""

import os
import typing
from typing import Any, Final, SupportsFloat, SupportsIndex, final

import numpy
import numpy.typing


__version__: Final[str]
"""
Version of the package.
"""

@final
class Dynamics:
    """
    Loads of states of motion, as `stillbase dynamics`.

    ```python
    >>> import stillbase as sb
    >>> loads = sb.Machine.builtin("spot").dynamics([0, 1, 2], [0.1, 0, 0], [0, 0, 0])
    >>> loads.torque.shape, loads.base_force.shape, loads.base_moment.shape
    ((3,), (2,), ())

    ```
    """
    def __repr__(self, /) -> str: ...
    @property
    def base_force(self, /) -> numpy.typing.NDArray[numpy.float64]:
        """
        Force on the base in its axes, weight included, N, of shape (..., 2).

        ```python
        >>> import stillbase as sb
        >>> loads = sb.Machine.builtin("nine-link").dynamics([0, 1, 2], [1, 0, 0], [1, 0, 0])
        >>> bool(abs(loads.base_force).max() < 1e-12)  # the machine is balanced
        True

        ```
        """
    @property
    def base_moment(self, /) -> numpy.typing.NDArray[numpy.float64]:
        """
        Moment about B on the base, weight included, counter-clockwise, N m, of shape (...).

        ```python
        >>> import stillbase as sb
        >>> loads = sb.Machine.builtin("nine-link").dynamics([0, 1, 2], [0, 0, 0], [1, 0, 0])
        >>> round(float(loads.base_moment), 6)
        -1.367926

        ```
        """
    @property
    def torque(self, /) -> numpy.typing.NDArray[numpy.float64]:
        """
        Torque of each motor, N m, of shape (..., drives).

        ```python
        >>> import stillbase as sb
        >>> loads = sb.Machine.builtin("nine-link").dynamics([0, 1, 2], [0, 0, 0], [1, 1, 1])
        >>> loads.torque.round(6)  # the mass matrix is diagonal
        array([1.367926, 0.159698, 0.174942])

        ```
        """

@final
class Machine:
    """
    A robot arm: its links, drives and counterweights. It never changes; `set` returns another one.

    ```python
    >>> import stillbase as sb
    >>> sb.Machine.builtin("nine-link")
    <stillbase.Machine nine-link: 3 drives, 16.050 kg>

    ```
    """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, tuple[str]]:
        """
        Machines are copied, and sent to workers, as their text.
        """
    def __repr__(self, /) -> str: ...
    def _repr_svg_(self, /) -> str:
        """
        Draws the machine from above, with a scale; notebooks show it. The links for cutting are drawn by `export-model`.

        ```python
        >>> import stillbase as sb
        >>> sb.Machine.builtin("nine-link")._repr_svg_().count("</svg>")
        1

        ```
        """
    @classmethod
    def builtin(cls, /, name: str) -> Machine:
        """
        Returns a built-in machine.

        ```python
        >>> import stillbase as sb
        >>> sb.Machine.builtin("spot").drives
        ['shoulder', 'elbow', 'wrist']

        ```
        """
    def check(self, /) -> dict[str, typing.Any]:
        """
        Whether the machine is balanced and its mass matrix constant, as `stillbase check`.

        ```python
        >>> import stillbase as sb
        >>> sb.Machine.builtin("nine-link").check()["invariant"]
        True

        ```
        """
    def counterweights(self, /, **given: typing.Any) -> dict[str, typing.Any]:
        """
        Finds the counterweights that balance the machine, as `stillbase design --counterweights` with its options.

        ```python
        >>> import stillbase as sb
        >>> found = sb.Machine.builtin("nine-link-bare").counterweights()
        >>> found["certified"], round(found["added_mass"], 2)
        (True, 6.33)

        ```
        """
    def design(self, /, **given: typing.Any) -> dict[str, typing.Any]:
        """
        Places the links' centres of mass so that the machine is balanced, as `stillbase design` with its options.

        ```python
        >>> import stillbase as sb
        >>> design = sb.Machine.builtin("nine-link-table-1").design(preset="table-1")
        >>> round(design["com"][0], 6)
        -0.221438

        ```
        """
    @property
    def drives(self, /) -> list[str]:
        """
        Names of the drives.

        ```python
        >>> import stillbase as sb
        >>> sb.Machine.builtin("nine-link").drives
        ['1', '2', '3']

        ```
        """
    def dynamics(self, /, q: numpy.typing.ArrayLike, qd: numpy.typing.ArrayLike, qdd: numpy.typing.ArrayLike, *, out: Dynamics | None = None, threads: SupportsIndex = 1) -> Dynamics:
        """
        Motor torques and base reactions of states of motion: absolute drive angles, rad, rates, rad/s, and
        accelerations, rad/s², each of shape (..., drives). They broadcast as arrays of NumPy do. `out` is an earlier
        result of the same shape, which is overwritten, after an interrupt in part. The numbers are those of `stillbase
        dynamics`, to the last bit.

        ```python
        >>> import numpy as np, stillbase as sb
        >>> machine = sb.Machine.builtin("nine-link")
        >>> machine.dynamics(np.zeros((4, 1, 3)), np.zeros((5, 3)), np.ones(3)).torque.shape
        (4, 5, 3)

        ```
        """
    @classmethod
    def from_dict(cls, /, spec: dict[str, typing.Any]) -> Machine:
        """
        Returns the machine that a dictionary describes, with the keys of a file.

        ```python
        >>> import stillbase as sb
        >>> spec = sb.Machine.builtin("nine-link").to_dict()
        >>> spec["gravity"] = [0.0, -9.81]
        >>> sb.Machine.from_dict(spec).drives
        ['1', '2', '3']

        ```
        """
    @classmethod
    def from_toml(cls, /, text: str) -> Machine:
        """
        Returns the machine that a text in TOML describes.

        ```python
        >>> import stillbase as sb
        >>> machine = sb.Machine.builtin("scara")
        >>> sb.Machine.from_toml(machine.to_toml()) == machine
        True

        ```
        """
    def front(self, /, count: SupportsIndex = 9, **given: typing.Any) -> dict[str, typing.Any]:
        """
        Finds the Pareto front of a number of designs, as `stillbase design --counterweights --front` with its options.

        ```python
        >>> import stillbase as sb
        >>> front = sb.Machine.builtin("nine-link-bare").front(3)
        >>> len(front["front"])
        3

        ```
        """
    @classmethod
    def load(cls, /, path: str | os.PathLike[str]) -> Machine:
        """
        Reads a machine from a file: TOML, URDF or MJCF.

        ```python
        >>> import stillbase as sb
        >>> machine = sb.Machine.builtin("scara")
        >>> with open("scara.toml", "w") as file:
        ...     _ = file.write(machine.to_toml())
        >>> sb.Machine.load("scara.toml") == machine
        True

        ```
        """
    @property
    def name(self, /) -> str:
        """
        Name.

        ```python
        >>> import stillbase as sb
        >>> sb.Machine.builtin("spot").name
        'spot'

        ```
        """
    def poses(self, /, point: typing.Sequence[float], b: SupportsFloat | SupportsIndex) -> dict[str, typing.Any]:
        """
        The poses that put the end effector on a point (x, y), m, at b, rad, as `stillbase pose`.

        ```python
        >>> import stillbase as sb
        >>> len(sb.Machine.builtin("nine-link").poses((0.5, 0.5), 2.4)["poses"])
        1

        ```
        """
    def reach(self, /, points: typing.Sequence[typing.Sequence[float]]) -> dict[str, typing.Any]:
        """
        The pose constants b that reach points (x, y), m, as `stillbase reach`.

        ```python
        >>> import stillbase as sb
        >>> answer = sb.Machine.builtin("nine-link").reach([(0.5, 0.5), (0.55, 0.9)])
        >>> [[round(b, 3) for b in interval] for interval in answer["overlap"]]
        [[2.216, 2.661]]

        ```
        """
    def set(self, /, keys: dict[str, typing.Any] | str, value: typing.Any = None) -> Machine:
        """
        Returns the machine with a key set, such as `set("link.2.com", 0.22)`, or with several, as a dictionary.

        ```python
        >>> import stillbase as sb
        >>> machine = sb.Machine.builtin("nine-link")
        >>> machine.set("link.5.com", 0).check()["force_balanced"]
        False
        >>> machine.set({"link.5.com": 0, "gravity": (0, -9.81)}) == machine.set("link.5.com", 0)
        False

        ```
        """
    def step_batch(self, /, q: numpy.typing.ArrayLike, qd: numpy.typing.ArrayLike, torque: numpy.typing.ArrayLike, dt: SupportsFloat | SupportsIndex, *, steps: SupportsIndex = 1, out: tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]] | None = None, threads: SupportsIndex = 1) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Simulates states of motion on a base that is held, each for a number of steps of dt, s. Motor torques, N m, are
        constant meanwhile. Returns absolute drive angles, rad, and rates, rad/s, after the last step.

        `q`, `qd` and `torque` have the shape (..., drives), and broadcast as arrays of NumPy do. `out` is a pair of
        arrays for the results, which may be `(q, qd)` itself. After an interrupt some states are advanced, others not.

        A step is one of the classical fourth-order Runge–Kutta method, as `stillbase simulate` makes it: to the last
        bit, where that needs no substeps. Nothing chooses the step here: the error of a state is of order dt⁴. Rates
        become momenta at the beginning of a call, and rates again at its end. So two calls may differ from one in the
        last digits.

        ```python
        >>> import numpy as np, stillbase as sb
        >>> machine = sb.Machine.builtin("nine-link").set({"gravity": (0, -9.81)})
        >>> q, qd = machine.step_batch(np.zeros((1000, 3)), [1, 2, 3], [0, 0, 0], 1e-3, steps=100)
        >>> q.shape, q[0].round(6)  # it is balanced and decoupled
        ((1000, 3), array([0.1, 0.2, 0.3]))

        ```
        """
    def to_dict(self, /) -> dict[str, typing.Any]:
        """
        Returns the machine as a dictionary, with the keys of a file.

        ```python
        >>> import stillbase as sb
        >>> spec = sb.Machine.builtin("spot").to_dict()
        >>> [link["name"] for link in spec["link"]]
        ['1', '2', '3']

        ```
        """
    def to_mjcf(self, /, **given: typing.Any) -> str:
        """
        Returns the machine as a model for MuJoCo, MJCF. Options are those of `stillbase export-model`: `pose`, `base`.

        ```python
        >>> import stillbase as sb
        >>> sb.Machine.builtin("nine-link").to_mjcf(pose=[1.5, 4.2, 3.1]).count("<body ")  # the base is one
        10

        ```
        """
    def to_toml(self, /) -> str:
        """
        Returns the machine as text in TOML.

        ```python
        >>> import stillbase as sb
        >>> "[[link]]" in sb.Machine.builtin("spot").to_toml()
        True

        ```
        """
    def to_urdf(self, /, **given: typing.Any) -> str:
        """
        Returns the machine as a model for ROS and Pinocchio, URDF. Options are those of `stillbase export-model`:
        `base`.

        ```python
        >>> import stillbase as sb
        >>> "drive_3" in sb.Machine.builtin("nine-link").to_urdf()
        True

        ```
        """
    def workspace(self, /, b: SupportsFloat | SupportsIndex, **given: typing.Any) -> dict[str, typing.Any]:
        """
        The reactionless workspace of b, rad, as `stillbase workspace` with its options.

        ```python
        >>> import stillbase as sb
        >>> round(sb.Machine.builtin("nine-link").workspace(2.4)["area"], 6)  # m²
        0.845145

        ```
        """

@final
class Run:
    """
    A simulated motion: a mapping of names to the arrays of its signals, the time, and the verdict.

    ```python
    >>> import stillbase as sb
    >>> run = sb.simulate("case-3")
    >>> float(abs(run["moment/total"]).max()) < 1e-8
    True
    >>> "torque/1" in run, dict(run)["torque/1"] is run["torque/1"], run.get("torque/9") is None
    (True, True, True)

    ```
    """
    def __contains__(self, name: Any, /) -> bool: ...
    def __getitem__(self, name: str, /) -> Any:
        """
        Returns the signal of a name, such as `torque/1`.
        """
    def __iter__(self, /) -> typing.Iterator[str]: ...
    def __len__(self, /) -> int:
        """
        Returns the number of signals; `len(run.time)` is that of the rows.
        """
    def __repr__(self, /) -> str: ...
    def _repr_html_(self, /) -> str:
        """
        A table of scenario, verdict and figures of the run with their units, which notebooks show.

        ```python
        >>> import stillbase as sb
        >>> table = sb.simulate("case-1")._repr_html_()
        >>> "<th>peak_base_moment</th><td>1.089" in table and "N m" in table
        True

        ```
        """
    def get(self, /, name: Any, default: typing.Any = None) -> typing.Any:
        """
        The signal of a name, or `default` if there is none.

        ```python
        >>> import stillbase as sb
        >>> sb.simulate("case-1").get("torque/9", 0)
        0

        ```
        """
    def items(self, /) -> typing.ItemsView[str, numpy.typing.NDArray[numpy.float64]]:
        """
        Names and arrays of the signals.

        ```python
        >>> import stillbase as sb
        >>> {name: array.shape for name, array in sb.simulate("case-1", signals="torque/1").items()}
        {'torque/1': (1001,)}

        ```
        """
    def keys(self, /) -> typing.KeysView[str]:
        """
        Names of the signals.

        ```python
        >>> import stillbase as sb
        >>> list(sb.simulate("case-1", signals="torque").keys())
        ['torque/1', 'torque/2', 'torque/3']

        ```
        """
    @property
    def scenario(self, /) -> str:
        """
        Name of the scenario.

        ```python
        >>> import stillbase as sb
        >>> sb.simulate("case-3").scenario
        'case-3'

        ```
        """
    @property
    def signals(self, /) -> dict:
        """
        Names and arrays of all signals.

        ```python
        >>> import stillbase as sb
        >>> list(sb.simulate("case-1", signals="torque").signals)
        ['torque/1', 'torque/2', 'torque/3']

        ```
        """
    @property
    def time(self, /) -> numpy.typing.NDArray[numpy.float64]:
        """
        Time of each row, s.

        ```python
        >>> import stillbase as sb
        >>> float(sb.simulate("case-1").time[-1])
        1.0

        ```
        """
    @property
    def units(self, /) -> dict:
        """
        Name and unit of each signal.

        ```python
        >>> import stillbase as sb
        >>> sb.simulate("case-1").units["torque/1"]
        'N m'

        ```
        """
    def values(self, /) -> typing.ValuesView[numpy.typing.NDArray[numpy.float64]]:
        """
        Arrays of the signals.

        ```python
        >>> import stillbase as sb
        >>> [array.shape for array in sb.simulate("case-1", signals="torque").values()]
        [(1001,), (1001,), (1001,)]

        ```
        """
    @property
    def verdict(self, /) -> dict:
        """
        The verdict of the command line, with peaks and audit.

        ```python
        >>> import stillbase as sb
        >>> sb.simulate("case-3").verdict["reactionless"]
        True

        ```
        """

def ask(*words: typing.Any, **given: typing.Any) -> typing.Any:
    """
    Carries out a command of the command line, and returns its answer as dictionaries and lists. A machine is named, or
    is a `Machine`. Options are keywords: `min_reach=1.2` is `--min-reach 1.2`, `keep=True` is `--keep`,
    `set={"payload.mass": 0.1}` is `--set payload.mass=0.1`; a list repeats an option that may be repeated.

    ```python
    >>> import stillbase as sb
    >>> sb.ask("reach", "nine-link", "0.5,0.5")["period"] > 6
    True

    ```
    """

def main(words: typing.Sequence[str], ends_process: bool = False) -> int:
    """
    Carries out a command line as the program does, and returns its exit status. The first word is the name of the
    program. With `ends_process` signals end the process at once and leave no half-written file, as they do for the program.

    ```python
    >>> from stillbase._stillbase import main
    >>> main(["stillbase", "check", "spot", "--strange"])
    2

    ```
    """

def plan(machine: str | os.PathLike[str] | Machine, points: typing.Iterable[typing.Sequence[float]] | None = None, **given: typing.Any) -> dict[str, typing.Any]:
    """
    Plans a motion through points (x, y), m, as `stillbase plan` with its options: `shape="line"`, `b=2.4`,
    `law="fastest"`. The first word is a machine, or a scenario, whose own points are the default. The plan is written
    as a scenario to `output`, a new file.

    ```python
    >>> import stillbase as sb
    >>> plan = sb.plan("nine-link", [(0.5, 0.5), (0.55, 0.9)], shape="line", b=2.4, output="line.toml", force=True)
    >>> plan["peak_base_moment"] < 1e-9
    True
    >>> sb.simulate("line.toml").verdict["reactionless"]
    True

    ```
    """

def record(scenario: str | os.PathLike[str] | typing.Sequence[str | os.PathLike[str]], output: str | os.PathLike[str], **given: typing.Any) -> dict[str, typing.Any]:
    """
    Records a scenario, or several, for the Rerun viewer, as `stillbase headless` with its options. `output` is the
    file, which ends in .rrd.

    ```python
    >>> import stillbase as sb
    >>> answer = sb.record(["case-1", "case-3"], "cases.rrd", force=True)
    >>> [(run["scenario"], run["reactionless"]) for run in answer["recordings"]]
    [('case-1', False), ('case-3', True)]

    ```
    """

def simulate(scenario: str | os.PathLike[str], **given: typing.Any) -> Run:
    """
    Simulates a scenario, built in or a file.

    Options are those of `stillbase simulate`: `set={"plant.payload.mass": 0.1}`, `signals=["torque", "moment/total"]`,
    `every=10`.

    ```python
    >>> import stillbase as sb
    >>> sb.simulate("case-1", signals=["torque", "moment/total"], every=10)
    <stillbase.Run of case-1: 4 signals in 101 rows>

    ```
    """

class StillbaseError(Exception):
    """
    Why a command did not finish; `answer` holds what it answered before.

    >>> import stillbase as sb
    >>> try:
    ...     sb.Machine.builtin('nine-link').reach([(0.5, 0.5), (-0.9, -0.8)])
    ... except sb.StillbaseError as why:
    ...     print(len(why.answer['points']))
    2
    """
    answer: Any


class NoAnswer(StillbaseError):
    """
    The question has no answer: the reason, and ways out of it.

    >>> import stillbase as sb
    >>> try:
    ...     sb.Machine.builtin('nine-link').reach([(5, 5)])
    ... except sb.NoAnswer as why:
    ...     print(str(why).splitlines()[0])
    (5.000, 5.000) m: the point is 7.0711 m from the base, but the arms reach only 1.2600 m
    """


class WrongInput(StillbaseError):
    """
    The input is wrong: where, and what would be right.

    >>> import stillbase as sb
    >>> try:
    ...     sb.Machine.builtin('nine-link').set({'link.1.mass': -2})
    ... except sb.WrongInput as why:
    ...     print(why)
    mass of link 1 (link.1.mass) is -2: want 1e-15 to 1000000 kg
    """
