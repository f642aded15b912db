"""Finishes the type stub that `maturin generate-stubs` makes: `python package_stub.py GENERATED > _stillbase.pyi`.

Generated stubs know neither the arrays of NumPy nor exceptions. The package has to be installed as it is.
"""

import inspect
import re
import sys

from stillbase import _stillbase

IMPORTS = """\
import os
import typing
from typing import Any, Final, SupportsFloat, SupportsIndex, final

import numpy
import numpy.typing
"""


def exceptions():
    """Returns the exceptions of the module, each after the one that it is a kind of."""
    all_of = [one for one in vars(_stillbase).values() if isinstance(one, type) and issubclass(one, Exception)]
    for one in sorted(all_of, key=lambda one: (len(one.__mro__), one.__name__)):
        base = one.__mro__[1]
        documentation = "\n".join(f"    {line}".rstrip() for line in inspect.getdoc(one).splitlines())
        answer = "    answer: Any\n" if base is Exception else ""
        yield f'\nclass {one.__name__}({base.__name__}):\n    """\n{documentation}\n    """\n{answer}'


with open(sys.argv[1], encoding="utf-8") as file:
    generated = file.read()
head, body = re.split(r"\n(?:from|import) [^\n]*\n(?:(?:from|import) [^\n]*\n)*", generated, maxsplit=1)
body, rest = body.split("\ndef __getattr__")
assert rest.count("\n") <= 1, rest
# Annotations need no quotes in a stub.
body = re.sub(r'(: |-> )"([^"\n]+)"(?=[,:)]| =)', r"\1\2", body)
body = body.replace("Incomplete", "numpy.typing.NDArray[numpy.float64]")
body = body.replace("SupportsGetItem[int, str]", "typing.Sequence[str]")
body = body.replace("-> Iterator:", "-> typing.Iterator[str]:")
print(head, IMPORTS, body.rstrip(), *exceptions(), sep="\n", end="")
