"""A document in which nothing has its default value."""

import numpy as np

from app.document import Box, Cylinder, Document, Place, Ring, Rule, Settings, Shown, Sphere
from gc_core import Constraint, Demonstration


def demonstration(n: int = 30, seed: int = 0) -> Demonstration:
    rng = np.random.default_rng(seed)
    half = np.linspace(0.1, 0.7, n)
    return Demonstration(
        times=np.arange(n) / 50.0,
        positions=np.cumsum(rng.uniform(0.001, 0.01, (n, 3)), axis=0),
        orientations=np.stack([np.cos(half), 0.0 * half, 0.0 * half, np.sin(half)], axis=1),
        gripper=np.linspace(0.0, 1.0, n),
        name=f"Demonstration {seed} à gauche",
    )


def constraint(n: int = 20) -> Constraint:
    original = np.stack([np.linspace(0.0, 0.5, n)] * 3, axis=1)
    return Constraint.from_correction(original, original + np.array([0.0, 0.0, 0.02]), name="The lid")


def document(n: int = 30, demonstrations: int = 2) -> Document:
    return Document(
        title="Über the top",
        about="One sentence.",
        demonstrations=tuple(Shown(demonstration(n, i), muted=True) for i in range(demonstrations)),
        settings=Settings(section="ellipse", align_by="time", stations=123),
        landmarks=(
            Place(
                "cup",
                taught=np.array([0.1, -0.4, 0.2]),
                now=np.array([0.2, -0.4, 0.2]),
                kind="object",
                turn=np.array([0.0, 0.1, 0.5]),
            ),
        ),
        tries=(
            Place(
                "cup",
                taught=np.array([0.1, -0.4, 0.2]),
                now=np.array([0.0, -0.4, 0.2]),
                kind="object",
                turn=np.array([0.0, 0.0, 0.3]),
            ),
        ),
        smoothing=0.1,
        starts=(np.array([0.1, 0.2, 0.3]), np.array([-0.0, 1e-300, np.pi])),
        rules=(Rule(constraint(), "Below the lid", enabled=False),),
        things=(
            Box("crate", (0.3, -0.2, 0.1), (0.1, 0.2, 0.2), wxyz=(0.0, 0.0, 0.0, 1.0), mass=0.2),
            Sphere("ball", (0.3, 0.2, 0.1), 0.03, wxyz=(0.0, 0.0, 1.0, 0.0), mass=0.1),
            Cylinder("post", (0.4, 0.0, 0.2), 0.05, 0.4, wxyz=(0.6, 0.8, 0.0, 0.0), mass=0.3),
            Ring("hoop", (0.4, 0.3, 0.3), 0.1, 0.01, wxyz=(0.6, 0.0, 0.8, 0.0), mass=0.4),
        ),
        built_in=True,
    )
