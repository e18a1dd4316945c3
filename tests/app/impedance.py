"""The yielding hand in full physics: torques instead of the admittance law, to check the latter against."""

from __future__ import annotations

import math

import numpy as np

from app.arm import FloatArray
from app.arm.physics import World
from app.compliance import DAMPING_RATIO, GRIP, MASS, STRONGEST, Feel
from app.route import Route

STEPS_PER_SECOND = 480
JOINT_DAMPING = np.array([2.0, 3.0, 2.0, 0.6, 0.6, 0.2])
"""More of it makes the light wrist unstable at this rate [N m s/rad]."""


def deviations(
    world: World,
    route: Route,
    joints: FloatArray,
    *,
    feel: Feel,
    pull: FloatArray,
    held: tuple[float, float],
) -> FloatArray:
    """Pull the hand of a torque-controlled arm aside and let it go.

    Gives (T, 3) tool minus route at 480 Hz. The pull [m] grows for 50 ms from
    the first time ``held`` and ends at the second; ``joints`` (K, 6) of the
    route are what the joint damping refers to.
    """
    world.place(joints[0])
    world.call("setTimeStep", 1.0 / STEPS_PER_SECOND)
    motors_off = world.constant("VELOCITY_CONTROL")
    world.call("setJointMotorControlArray", world.arm, world.joints, motors_off, forces=[0.0] * 6)
    found: list[FloatArray] = []
    rates = np.gradient(joints, route.times, axis=0)
    for step in range(int(route.times[-1] * STEPS_PER_SECOND)):
        time = step / STEPS_PER_SECOND
        share = np.clip((time - held[0]) / 0.05, 0.0, 1.0)
        rate = np.array([np.interp(time, route.times, rates[:, joint]) for joint in range(6)])
        grabbed = held[0] <= time < held[1]
        found.append(_push(world, route, time, feel=feel, pull=share * pull if grabbed else None, rate=rate))
    return np.array(found)


def _push(
    world: World, route: Route, time: float, *, feel: Feel, pull: FloatArray | None, rate: FloatArray
) -> FloatArray:
    """Do one step; give how far the hand is from the route before it."""
    states = world.call("getJointStates", world.arm, world.joints)
    angles, speeds = [state[0] for state in states], [state[1] for state in states]
    place = world.tool_position()
    still = [0.0] * 6
    jacobian = np.array(
        world.call("calculateJacobian", world.arm, world.tool, [0.0] * 3, angles, still, still)[0]
    )
    away = place - route.at(time)
    along = (route.at(time + 0.005) - route.at(time - 0.005)) / 0.01
    at_work = feel.stiffness + (GRIP if pull is not None else 0.0)
    damping = 2.0 * DAMPING_RATIO * math.sqrt(at_work * MASS)
    force = -feel.stiffness * away + damping * (along - jacobian @ speeds)
    torque = np.array(world.call("calculateInverseDynamics", world.arm, angles, speeds, still))
    torque += jacobian.T @ force - JOINT_DAMPING * (np.array(speeds) - rate)
    world.call(
        "setJointMotorControlArray",
        world.arm,
        world.joints,
        world.constant("TORQUE_CONTROL"),
        forces=np.clip(torque, -world.torque_limits, world.torque_limits).tolist(),
    )
    if pull is not None:
        pulling = GRIP * (pull - away)
        pulling *= min(1.0, STRONGEST / max(float(np.linalg.norm(pulling)), 1e-9))
        frame = world.constant("WORLD_FRAME")
        world.call("applyExternalForce", world.arm, world.tool, pulling.tolist(), place.tolist(), frame)
    world.call("stepSimulation")
    return away
