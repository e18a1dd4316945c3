"""What physics makes of a run: the worker's job, and the report that the panel and the scene show.

The job opens a physical world, lets the arm play the run under the limits of its motors
with the document's things around it, and closes the world again. It can be told at
every quarter of a second that nobody wants it any more.
"""

from collections.abc import Callable
from dataclasses import replace

from app.arm.errors import ArmError
from app.arm.physics import World
from app.arm.physics_engine import missing
from app.arm.physics_playback import play
from app.arm.physics_words import played as in_words
from app.arm.protocol import Arm
from app.arm.shapes import Shape
from app.measures import TABLE
from app.planning import plan_run
from app.store import Plan, Task
from app.trial import Trial


class SupersededError(Exception):
    """Nobody waits for this trial any more."""


def simulate(task: Task, make_arm: Callable[[], Arm], watch: Callable[[float], None]) -> Trial:
    """Play a run in a physical world.

    Parameters
    ----------
    task : Task
        The run, and what is around the arm.
    make_arm : callable
        Gives an arm of this thread's own, which is closed again.
    watch : callable
        Told now and then how much is done, 0 .. 1; may raise `SupersededError` to end it.

    Returns
    -------
    Trial
        Where physics is not installed, or the run cannot be played, with a sentence that says so.
    """
    run = task.model.runs[task.run].reproduction
    things = around(task)
    said = missing()
    if said is not None:
        return Trial(task.model, task.run, 1.0, (said,))
    try:
        plan = _planned(task, make_arm) if task.plan is None else task.plan
        with World(things, table=TABLE) as world:
            played = play(world, plan.clock, plan.path.joints, run.gripper, watch=watch)
    except ArmError as error:
        return Trial(task.model, task.run, 1.0, (str(error),))
    movable = tuple(shape for shape in things if shape.mass > 0.0)
    return Trial(task.model, task.run, 1.0, in_words(played), played, movable)


def around(task: Task) -> tuple[Shape, ...]:
    """Everything around the arm: what it keeps off, and what it may touch; no two have one name."""
    things = task.model.source.things
    names = {thing.name for thing in things}
    posts = (shape for shape in task.conditions.obstacles if shape not in things)
    return (
        *things,
        *(replace(post, name=f"{post.name} (landmark)") if post.name in names else post for post in posts),
    )


def _planned(task: Task, make_arm: Callable[[], Arm]) -> Plan:
    arm = make_arm()
    try:
        return plan_run(arm, task.model, task.run, task.conditions, task.near)
    finally:
        arm.close()
