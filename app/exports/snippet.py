"""A Python program that holds a skill and opens it again: one file, with the data in it."""

from __future__ import annotations

import base64
import textwrap
from string import Template
from typing import Final

from app.document import Document
from app.exports.skill_file import pack

_PROGRAM: Final = Template('''\
"""$title: a skill from gc-teach. Run this where gc-teach is installed, or import `skill` from it."""

import base64

from app.document import Document
from app.exports import unpack
from app.model import learn


def skill() -> Document:
    """Open the skill that is in this file."""
    return unpack("$name.gcteach", base64.b64decode(DATA))


def main() -> None:
    """Learn it, and say what is in it."""
    model = learn(skill())
    for shown in model.demonstrations:  # .times (T,) [s], .positions (T, 3) [m]
        print(f"{shown.name}: {len(shown.times)} samples, {shown.times[-1]:.1f} s")
    tube = model.cylinder  # the generalized cylinder: .directrix (N, 3), .surface() (N, M, 3) [m]
    if tube is not None:
        print(f"The tube is {tube.arc_length[-1]:.3f} m long and holds {1000.0 * tube.volume:.2f} litres.")
    for run in model.runs:
        path = run.reproduction  # .times (K,) [s], .positions (K, 3) [m]
        print(f"A run of {path.times[-1]:.1f} s from {path.positions[0]} to {path.positions[-1]} m")


DATA = """
$data
"""

if __name__ == "__main__":
    main()
''')


def snippet(document: Document, name: str) -> bytes:
    """Write the program.

    Parameters
    ----------
    document : Document
        What it shall open, exactly.
    name : str
        Of a file: letters, digits and hyphens.
    """
    data = "\n".join(textwrap.wrap(base64.b64encode(pack(document)).decode(), 100))
    # Whatever a person called the skill, it cannot end the text that it stands in.
    title = "".join(c for c in " ".join(document.title.split()) if c.isprintable() and c not in '"\\')
    return _PROGRAM.substitute(title=title, data=data, name=name).encode()
