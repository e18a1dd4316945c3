"""What the app asks of an arm: joints go in, joints and poses come out.

Every call is a function of its arguments alone, whatever an arm keeps inside;
an arm object belongs to one thread at a time. Positions are metres in the
arm's base frame, which is the world of the scene. Joints are radians and never
wrap: a joint that turns without end counts its turns.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol

from app.arm.findings import HERE, STUCK, Clearance, FloatArray, JointPath, LinkMesh, Shortfall

if TYPE_CHECKING:
    from app.arm.conditions import Conditions

__all__ = ("HERE", "STUCK", "Arm", "Clearance", "FloatArray", "JointPath", "LinkMesh", "Shortfall")


class Arm(Protocol):
    """An arm that can be drawn, dragged by its hand and led along a path."""

    @property
    def name(self) -> str:
        """What people call it."""
        ...

    @property
    def joint_names(self) -> tuple[str, ...]:
        """One name for each of the J joints, from the base outwards."""
        ...

    @property
    def home(self) -> FloatArray:
        """(J,) joints at rest [rad]."""
        ...

    @property
    def lower(self) -> FloatArray:
        """(J,) lower joint limits [rad]."""
        ...

    @property
    def upper(self) -> FloatArray:
        """(J,) upper joint limits [rad]."""
        ...

    @property
    def velocity_limits(self) -> FloatArray:
        """(J,) how fast the real joints turn [rad/s]; `step` may be faster."""
        ...

    @property
    def acceleration_limits(self) -> FloatArray:
        """(J,) how fast a played path may change the joints' speeds [rad/s^2]."""
        ...

    @property
    def link_meshes(self) -> tuple[LinkMesh, ...]:
        """The parts to draw, once."""
        ...

    @property
    def conditions(self) -> Conditions:
        """What this arm heeds."""
        ...

    def under(self, conditions: Conditions) -> Arm:
        """Give the same arm, heeding other conditions; it is closed when this one is.

        Parameters
        ----------
        conditions : Conditions
            Obstacles to keep off, and how the tool is held.
        """
        ...

    def tool_pose(self, joints: FloatArray) -> FloatArray:
        """Say where the tool is.

        Parameters
        ----------
        joints : (J,) array
            Joints [rad]; finite. Outside the limits they are clipped.

        Returns
        -------
        (4, 4) array
            ``T_world_tool``: origin at the tool tip [m].

        Raises
        ------
        ArmInputError
            If the joints are not J finite numbers.
        """
        ...

    def link_poses(self, joints: FloatArray, gripper: float) -> Mapping[str, FloatArray]:
        """Say where every drawn link is.

        Parameters
        ----------
        joints : (J,) array
            Joints [rad]; finite. Outside the limits they are clipped.
        gripper : float
            0 is open, 1 is closed; values outside are clipped.

        Returns
        -------
        mapping of str to (4, 4) array
            ``T_world_link`` of every link that carries a mesh.

        Raises
        ------
        ArmInputError
            If the joints or the gripper are not finite.
        """
        ...

    def step(self, joints: FloatArray, target: FloatArray, dt: float = 0.01) -> FloatArray:
        """Follow the pulled hand for one tick.

        Parameters
        ----------
        joints : (J,) array
            Joints before the tick [rad]; finite.
        target : (3,) array
            Where the hand is wanted [m]; any finite position, reachable or not.
        dt : float
            Length of the tick [s]; positive.

        Returns
        -------
        (J,) array
            Joints after the tick [rad], within the limits, none of them moved
            by more than a speed bound of the arm times ``dt``.

        Raises
        ------
        ArmInputError
            If an argument has the wrong shape or is not finite.
        """
        ...

    def follow(
        self,
        positions: FloatArray,
        start: FloatArray | None = None,
        orientations: FloatArray | None = None,
    ) -> JointPath:
        """Lead the tool along a path, without jumps of the joints.

        Parameters
        ----------
        positions : (K, 3) array
            Wanted tool positions [m], in order; K >= 1.
        start : (J,) array, optional
            Joints near which the path should begin [rad].
        orientations : (K, 4) array, optional
            How the tool should be turned there, w x y z; instead of a lock. The positions come first.

        Returns
        -------
        JointPath
            The best joints found for every position, with the distances left.

        Raises
        ------
        ArmInputError
            If an argument has the wrong shape or is not finite.
        """
        ...

    def shortfall(self, joints: FloatArray, target: FloatArray) -> Shortfall | None:
        """Say why the hand is not where it is wanted.

        Parameters
        ----------
        joints : (J,) array
            Joints after the arm came to rest [rad].
        target : (3,) array
            Where the hand is wanted [m].

        Returns
        -------
        Shortfall or None
            None when the hand is within `HERE` of the target.

        Raises
        ------
        ArmInputError
            If an argument has the wrong shape or is not finite.
        """
        ...

    def unreachable(self, positions: FloatArray) -> str | None:
        """Say at once, from the places alone, why a path is out of reach; `follow` knows more.

        Parameters
        ----------
        positions : (K, 3) array
            Wanted tool positions [m]; K >= 1.

        Returns
        -------
        str or None
            Of the worst one, for instance ``12 cm beyond reach``; no full stop. None says nothing.

        Raises
        ------
        ArmInputError
            If the argument has the wrong shape or is not finite.
        """
        ...

    def reposition(self, joints: FloatArray, target: FloatArray) -> FloatArray | None:
        """Find a way to another posture, for a hand that is stuck.

        Parameters
        ----------
        joints : (J,) array
            Joints to begin from [rad].
        target : (3,) array
            Where the hand is wanted [m].

        Returns
        -------
        (W, J) array or None
            Joints to pass in straight lines, W >= 2: the first are those given, the last
            bring the tool to the target; no body touches another or an obstacle on the way.
            None when there is no such posture or no way to it was found.

        Raises
        ------
        ArmInputError
            If an argument has the wrong shape or is not finite.
        """
        ...

    def way(self, joints: FloatArray, goal: FloatArray) -> FloatArray | None:
        """Find a way from one posture to another, clear of the arm itself, of obstacles and of the table.

        Parameters
        ----------
        joints, goal : (J,) array
            Joints to begin from and to come to [rad].

        Returns
        -------
        (W, J) array or None
            Joints to pass in straight lines, W >= 2, from the first to the last of those given;
            the straight line itself where that is clear. None when no way was found.

        Raises
        ------
        ArmInputError
            If an argument has the wrong shape or is not finite.
        """
        ...

    def clearance(self, joints: FloatArray) -> Clearance:
        """Measure how far the arm is from itself and from the obstacles.

        Parameters
        ----------
        joints : (K, J) array
            Joints [rad]; K >= 1.

        Raises
        ------
        ArmInputError
            If the argument has the wrong shape or is not finite.
        """
        ...

    def close(self) -> None:
        """Give the arm back; it must not be used afterwards. Closing twice is allowed."""
        ...
