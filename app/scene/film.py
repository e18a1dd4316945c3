"""A skill as one page that plays by itself: no server, no network, nothing to install.

viser records the messages that would draw a scene and puts them, with its own client, into one HTML
file. They come from a server that nobody sees and that is gone when the film is made.
"""

from __future__ import annotations

import html
from dataclasses import replace
from typing import Final

import numpy as np
import viser

from app.arm.protocol import Arm
from app.document import FloatArray, View
from app.model import Model
from app.resources import static_folder
from app.scene import landmarks, things
from app.scene.arm import ArmFrames
from app.scene.cylinder import Tube
from app.scene.geometry import arrowheads
from app.scene.nodes import Ball, Line, Mesh
from app.scene.polyline import dashes, segments, thin_out
from app.scene.style import (
    CARRIED,
    DEMONSTRATION,
    DIRECTRIX,
    DOUBLE,
    HAND,
    HAND_RADIUS,
    LANDMARK,
    MUTED,
    REFINED,
    REPRODUCTION,
    START_RADIUS,
    THICK,
    THIN,
    THING,
    THING_EDGE,
    TUBE,
)
from app.scene.view import look_from_here
from app.scene.world import draw_world
from app.store import Hand, Plan, Playback, State
from app.web import open_server

RATE: Final = 20.0
"""Pictures a second."""
MOST_PICTURES: Final = 600
"""Of longer runs fewer a second are kept."""
REST: Final = 1.0
"""The film rests at its end before it begins again [s]."""
LEGEND: Final = (
    (DEMONSTRATION, "demonstrations"),
    (TUBE, "tube"),
    (DIRECTRIX, "middle line"),
    (REPRODUCTION, "new run"),
)
MOST_POINTS: Final = 300
"""Of a drawn line."""


def film(arm: Arm, model: Model, plan: Plan | None) -> str:
    """Make the page: tube, demonstrations, runs, landmarks, things, and the arm that plays a run.

    Parameters
    ----------
    arm : Arm
        Not used by anybody else meanwhile.
    model : Model
        What is drawn.
    plan : Plan, optional
        The run that is played, at the pace at which the arm plays it; without one it rests.

    Returns
    -------
    str
        HTML, about 1.5 MB with the meshes of the Jaco.
    """
    # As careful as the one that people see: for a moment it listens, though on this machine only.
    server = open_server(port=0, health=dict, static=static_folder())
    try:
        api = server.scene
        draw_world(api, arm)
        look_from_here(server.initial_camera)
        _draw_skill(api, model)
        tube, frames = Tube(api), ArmFrames(api, arm)
        hand = Ball(api, "/hand", radius=HAND_RADIUS, color=HAND)
        recording = None
        pictures = _pictures(arm, model, plan)
        for state in pictures:
            tube.draw(state)
            frames.draw(state)
            hand.show(state.hand.position)
            if recording is None:
                recording = server.get_scene_serializer()
            recording.insert_sleep(1.0 / RATE if state is not pictures[-1] else REST)
        assert recording is not None
        page = recording.as_html()
    finally:
        server.stop()
    title = html.escape(model.source.title)
    page = page.replace("<title>Viser</title>", f"<title>{title} - gc-teach</title>", 1)
    body, end, rest = page.rpartition("</body>")
    return f"{body}{_legend(title)}{end}{rest}"


def _legend(title: str) -> str:
    """Write over the picture what is played, and what its colours mean; a click goes through."""
    words = " &nbsp; ".join(
        f'<span style="white-space:nowrap"><span style="color:rgb{color}">&#9632;</span> {name}</span>'
        for color, name in LEGEND
    )
    return (
        '<div style="position:fixed;left:0.75rem;top:0.6rem;z-index:9;pointer-events:none;'
        'font:0.8rem/1.5 system-ui,sans-serif;color:#3a3f49"><b>'
        f"{title}</b><br>{words}</div>"
    )


def _pictures(arm: Arm, model: Model, plan: Plan | None) -> list[State]:
    """Give what the film shows, picture by picture; at least one."""
    view = View()
    if plan is None:
        return [_state(model, view, Hand(arm.home, arm.tool_pose(arm.home)[:3, 3]), Playback())]
    duration = float(plan.clock[-1])
    times = np.linspace(0.0, duration, min(max(round(duration * RATE), 2), MOST_PICTURES))
    run = plan.reproduction
    joints: FloatArray = np.empty((len(times), len(arm.home)))
    for joint in range(len(arm.home)):
        joints[:, joint] = np.interp(times, plan.clock, plan.path.joints[:, joint])
    own = np.interp(times, plan.clock, run.times)
    gripper = np.zeros(len(times))
    if run.gripper is not None:
        gripper = run.gripper[np.clip(np.searchsorted(run.times, own), 0, len(run.times) - 1)]
    return [
        _state(
            model,
            replace(view, gripper_closed=bool(gripper[i] > 0.5)),
            Hand(joints[i], arm.tool_pose(joints[i])[:3, 3], float(gripper[i])),
            Playback(float(own[i]), plan.taught, True, plan.run),
        )
        for i in range(len(times))
    ]


def _state(model: Model, view: View, hand: Hand, playback: Playback) -> State:
    return State(model.source, view, model, hand, playback)


def _draw_skill(api: viser.SceneApi, model: Model) -> None:
    """Draw what does not move: lines, landmarks and things."""
    if model.cylinder is not None:
        Line(api, "/directrix", color=DIRECTRIX, thickness=THICK).show(segments(model.cylinder.directrix))
    for i, shown in enumerate(model.source.demonstrations):
        line = thin_out(shown.demonstration.positions, MOST_POINTS)
        color = MUTED if shown.muted else DEMONSTRATION
        pieces = dashes(line) if shown.muted else segments(line)
        Line(api, f"/demonstrations/{i}", color=color, thickness=THIN).show(pieces)
    for i, run in enumerate(model.runs):
        path = run.reproduction.positions
        ruled = run.reproduction is not run.free
        color = REFINED if ruled else REPRODUCTION
        thickness = DOUBLE if ruled else THICK
        Line(api, f"/reproductions/{i}", color=color, thickness=thickness).show(segments(path))
        Mesh(api, f"/reproductions/{i}/arrows", color=color).show(*arrowheads(path))
        Ball(api, f"/start/{i}", radius=START_RADIUS, color=color).show(run.start)
    for anchor in model.anchors:
        body = landmarks.body(anchor, round(float(anchor.now[2]), 3))
        Mesh(api, f"/landmarks/{anchor.name}", color=LANDMARK).show(*body).position = anchor.now
    for thing in model.source.things:
        name = f"/obstacles/{thing.name}"
        node = Mesh(api, name, color=CARRIED if thing.mass > 0.0 else THING).show(*things.body(thing))
        node.position, node.wxyz = np.array(thing.position), np.array(thing.wxyz)
        Line(api, f"{name}/edges", color=THING_EDGE).show(things.edges(thing))
