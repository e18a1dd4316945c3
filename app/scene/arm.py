"""The arm: one frame for every link that carries a mesh.

The meshes themselves are part of the shared world and hang under these frames, see
`app.scene.world`. A frame is moved only when its pose changed.
"""

from typing import Final

import numpy as np
import viser

from app.arm.protocol import Arm
from app.document import FloatArray
from app.scene.geometry import quaternions
from app.scene.nodes import move, turn
from app.store import State

STILL: Final = 1e-4
"""A change of a pose below this is not worth a message [m, -]."""


class ArmFrames:
    """``/arm/<link>``."""

    def __init__(self, api: viser.SceneApi, arm: Arm) -> None:
        self._arm = arm
        links = dict.fromkeys(mesh.link for mesh in arm.link_meshes)
        self._frames = {link: api.add_frame(f"/arm/{link}", show_axes=False) for link in links}
        self._poses = np.broadcast_to(np.eye(4), (len(links), 4, 4))
        self._joints: FloatArray | None = None
        self._gripper: float | None = None

    def draw(self, state: State) -> None:
        """Move the links to where the joints put them."""
        gripper = gripper_of(state)
        if state.hand.joints is self._joints and gripper == self._gripper:
            return
        self._joints, self._gripper = state.hand.joints, gripper
        by_link = self._arm.link_poses(state.hand.joints, gripper)
        poses = np.stack([by_link[link] for link in self._frames])
        change = np.abs(poses - self._poses)
        turned = change[:, :3, :3].max(axis=(1, 2)) > STILL
        moved = change[:, :3, 3].max(axis=1) > STILL
        wxyz = quaternions(poses[:, :3, :3])
        for i, frame in enumerate(self._frames.values()):
            if turned[i]:
                turn(frame, wxyz[i])
            if moved[i]:
                move(frame, poses[i, :3, 3])
        drawn = (turned | moved)[:, None, None]
        self._poses = np.where(drawn, poses, self._poses)


def gripper_of(state: State) -> float:
    """0 is open, 1 is closed: as shown while a reproduction plays, else as the hand holds it."""
    playback = state.playback
    if state.replay is not None or (state.trial is not None and state.trial.time is not None):
        return state.hand.gripper
    if playback.playing and playback.run < len(state.model.runs):
        played = state.model.runs[playback.run].reproduction
        if played.gripper is not None:
            sample = int(np.searchsorted(played.times, playback.time))
            return float(played.gripper[min(sample, len(played.times) - 1)])
    return 1.0 if state.view.gripper_closed else 0.0
