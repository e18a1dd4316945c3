"""A whole server with a tiny arm, and a person in a tab of it."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final, TypeAlias

import numpy as np

from app.arm import PlanarArm
from app.document import Document
from app.server import Options, Server
from tests.app.makers import taught
from tests.support.fake_client import FakeClient

FIRST_SCREEN: Final = (
    "/hand",
    "/start/0",
    "/demonstrations/0",
    "/demonstrations/1",
    "/demonstrations/2",
    "/directrix",
    "/tube",
    "/reproductions/0",
    "/landmarks/start",
    "/landmarks/goal",
)
"""Names that people and checks rely on."""
WORK: Final = ("tube", "directrix", "demonstrations", "reproductions", "start", "landmarks")
"""What shows the document; the arm and the hand move by themselves."""

Picture: TypeAlias = dict[str, tuple[object, ...]]


def library_in(folder: Path) -> str:
    """Address of a library of its own."""
    return f"sqlite:///{folder / 'library.db'}"


def first_document() -> Document:
    """A built-in skill, small enough to be learned in a moment."""
    return taught(built_in=True)


@contextlib.contextmanager
def serving(library: str) -> Iterator[Server]:
    """A server on a free port of this machine."""
    server = Server(Options("127.0.0.1", 0, library), first_document, PlanarArm)
    try:
        yield server
    finally:
        server.close()


@contextlib.contextmanager
def tab(server: Server, code: str) -> Iterator[FakeClient]:
    """A tab on a session, once its first screen is there."""
    with FakeClient(f"ws://127.0.0.1:{server.port}/s/{code}") as client:
        client.wait_nodes(*FIRST_SCREEN)
        yield client


def picture(client: FakeClient) -> Picture:
    """What a tab shows of the document: the place and the geometry of all that is visible.

    To the micrometre: the last bit of a product depends on where its arrays lie in memory.
    """
    nodes = client.nodes

    def visible(name: str) -> bool:
        parts = name.split("/")
        above = ["/".join(parts[:count]) for count in range(2, len(parts) + 1)]
        return all(nodes[one].visible for one in above if one in nodes)

    shown: Picture = {}
    for name, node in nodes.items():
        if name.split("/")[1] in WORK and visible(name):
            arrays = [node.props.get(prop, ()) for prop in ("points", "vertices")]
            shown[name] = (tuple(np.round(node.position, 6)), *(np.round(a, 6).tobytes() for a in arrays))
    return shown


def changed(before: Picture, after: Picture) -> set[str]:
    """First two parts of the names of what is shown otherwise, is new or is gone."""
    names = {name for name in before.keys() | after.keys() if before.get(name) != after.get(name)}
    return {"/".join(name.split("/")[:3]) for name in names}


def middle_of(client: FakeClient, line: str) -> np.ndarray:
    """(3,) the middle of a drawn line [m]."""
    points = client.node(f"{line}/line").array("points", -1, 2, 3)
    return points[len(points) // 2, 0].astype(float)


def grip_of(client: FakeClient, node: str) -> np.ndarray:
    """(3,) where one would grab a node [m]."""
    if node.startswith(("/demonstrations", "/reproductions")):
        return middle_of(client, node)
    return client.world_position(node)


def say(
    client: FakeClient, node: str, phase: str, grabbed: Sequence[float], pointer: Sequence[float]
) -> None:
    """One event of a pull, as a page sends it."""
    client.send(
        "SceneNodeDragMessage",
        phase=phase,
        name=node,
        instance_index=None,
        start_position=tuple(float(value) for value in grabbed),
        start_screen_pos=(0.5, 0.5),
        end_position=tuple(float(value) for value in pointer),
        end_screen_pos=(0.5, 0.5),
        button="left",
        modifier=None,
        owner=client.node(node).owner,
    )


def pull(client: FakeClient, node: str, by: Sequence[float], *, events: int = 8, let_go: bool = True) -> None:
    """Grab a node, pull it by some way [m] in even steps, and let go."""
    at = grip_of(client, node)
    say(client, node, "start", at, at)
    for event in range(1, events + 1):
        pointer = at + np.asarray(by) * event / events
        say(client, node, "update", at, pointer)
    if let_go:
        say(client, node, "end", at, at + np.asarray(by))


def button(client: FakeClient, begins: str) -> str:
    """Label of the button that begins with a word and can be pressed; empty when there is none."""
    labels = [e.label for e in client.gui if e.kind == "Button" and e.label.startswith(begins) and e.usable]
    return labels[0] if len(labels) == 1 else ""


def press(client: FakeClient, begins: str) -> None:
    """Press it as soon as it can be pressed."""
    client.wait(lambda c: button(c, begins))
    client.press(button(client, begins))
