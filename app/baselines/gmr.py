"""Gaussian mixture regression: the motion is the mean of a mixture of Gaussians, given the time.

The start plays no part in it, as in Fig. 9 of the paper. The mixtures are those of the package `gmr`.

References
----------
.. [1] S. Calinon, F. Guenter, A. Billard. On learning, representing, and generalizing a task in a
   humanoid robot. IEEE Transactions on Systems, Man and Cybernetics B 37(2), 2007.
   doi:10.1109/TSMCB.2006.886952
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from app.baselines.protocol import SAMPLES, CannotLearnError, Run, failing_as, finite_run, package, taught
from app.document import Alignment, FloatArray
from gc_core import Demonstration
from gc_core.alignment import align
from gc_core.demonstration import trim

NOISE: Final = 3e-4
"""Part of the motion's size by which samples are shaken. `gmr` does not regularize: without it, the mixture
of a flat motion or of equal demonstrations becomes singular, and misses the motion by centimetres [-]."""
FEWEST: Final = 5
"""Samples of which a Gaussian in four dimensions has a covariance that is not singular."""


@dataclass(frozen=True)
class Mixture:
    """Gaussian mixture regression over time."""

    components: int = 5
    align_by: Alignment = "arc_length"

    @property
    def name(self) -> str:
        """How it is called in tables."""
        return f"gmr-{self.components}"

    def ready(self) -> None:
        """Import `gmr`; see `Method.ready`."""
        package(self.name, "gmr")

    def fit(self, demonstrations: Sequence[Demonstration]) -> MixtureSkill:
        """Learn the mixture; see `Method.fit`."""
        shown = taught(demonstrations, self.align_by)
        curve = _regression(self.name, shown.phase, shown.paths, self.components, shown.phase)
        return MixtureSkill(self.name, shown.times, curve)


@dataclass(frozen=True, eq=False)
class MixtureSkill:
    """The one motion that regression over time gives."""

    name: str
    times: FloatArray
    """(K,) [s]."""
    positions: FloatArray
    """(K, 3) [m]."""

    def reproduce(self, start: FloatArray, goal: FloatArray | None = None) -> Run:  # noqa: ARG002 - the protocol's
        """Give the one motion, wherever the start and the goal are."""
        return finite_run(self.name, self.times, self.positions)


def mixture_directrix(
    demonstrations: Sequence[Demonstration],
    components: int = 5,
    align_by: Alignment = "time",
    samples: int = SAMPLES,
) -> FloatArray:
    """Give the paper's other directrix: Gaussian mixture regression in place of the mean.

    Parameters
    ----------
    demonstrations : sequence of n Demonstration
        n >= 1.
    components : int
        Gaussians, at least 1.
    align_by : {"time", "arc_length", "dtw"}
        What corresponds; to be given to `gc_core.encode`, too.
    samples : int
        K.

    Returns
    -------
    (K, 3) array
        Curve for ``encode(demonstrations, directrix=curve, align_by=align_by)``, evenly sampled in the
        alignment's parameter [m].

    Raises
    ------
    BaselineError
        If `gmr` is missing or fails.
    GcError
        As `gc_core.encode`.
    """
    found = align(tuple(trim(each) for each in demonstrations), samples, align_by, None)
    even = np.linspace(0.0, 1.0, samples)
    return _regression(f"gmr-{components}", found.parameter, found.aligned, components, even)


def _regression(
    name: str, phase: FloatArray, paths: FloatArray, components: int, at: FloatArray
) -> FloatArray:
    """Mean place (K, 3) at phases `at` (K,) of a mixture learned from paths (n, N, 3) at phases (N,)."""
    mixtures = package(name, "gmr")
    most = len(paths) * len(phase) // FEWEST
    if not 1 <= components <= most:
        raise CannotLearnError(name, f"their samples suffice for 1 to {most} Gaussians")
    samples = _shaken(np.concatenate([np.column_stack((phase, path)) for path in paths]))
    with failing_as(CannotLearnError, name):
        means, covariances = _even_start(samples, components)
        mixture: Any = mixtures.GMM(
            components,
            priors=np.full(components, 1.0 / components),
            means=means,
            covariances=covariances,
            random_state=0,
        )
        mixture.from_samples(samples)
        if not np.linalg.eigvalsh(mixture.covariances).min() > 0.0:
            raise CannotLearnError(name, "the covariance of one of its Gaussians is singular")
        curve = np.asarray(mixture.predict(np.array([0]), at[:, None]), dtype=np.float64)
    if not np.isfinite(curve).all():
        raise CannotLearnError(name, "its path holds values that are no numbers")
    return curve


def _shaken(samples: FloatArray) -> FloatArray:
    """Add the same little noise every time to samples (K, 4) of phase and place."""
    size = float(np.linalg.norm(np.ptp(samples[:, 1:], axis=0)))
    noise = np.random.default_rng(0).normal(0.0, NOISE, samples.shape)
    return samples + noise * np.array([1.0, size, size, size])


def _even_start(samples: FloatArray, components: int) -> tuple[FloatArray, FloatArray]:
    """Means (c, 4) and covariances (c, 4, 4) of equal parts by time: every time the same."""
    groups = np.array_split(samples[np.argsort(samples[:, 0], kind="stable")], components)
    covariances = np.array([np.cov(group, rowvar=False) for group in groups], dtype=np.float64)
    return np.array([group.mean(axis=0) for group in groups]), covariances
