"""The prepared model on disk: made once, read ever after, never half made.

A folder's name says how it was made, so an old one is never read by a new
program. It is filled under another name and then renamed: whoever comes first
wins, and the others use what the winner made.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib.metadata
import logging
import os
import shutil
import tempfile
import time
from pathlib import Path

import platformdirs

from app.arm import meshes, urdf
from app.arm.errors import ArmModelError

_log = logging.getLogger(__name__)


def cache_folder() -> Path:
    """Say where prepared models are kept: ``GC_TEACH_CACHE`` or the user's cache folder."""
    wanted = os.environ.get("GC_TEACH_CACHE")
    return Path(wanted) if wanted else platformdirs.user_cache_path("gc-teach")


def prepared_folder(cache: Path | None = None) -> Path:
    """Give the folder with the prepared Jaco, preparing it first where needed.

    Parameters
    ----------
    cache : Path, optional
        Where prepared models are kept; by default `cache_folder`.

    Returns
    -------
    Path
        Holds the cleaned description, the pairs of links that could touch, and the meshes.

    Raises
    ------
    ArmModelError
        If the model cannot be read or the cache cannot be written.
    """
    cache = cache_folder() if cache is None else cache
    folder = cache / f"jaco-{_fingerprint()}"
    if not folder.is_dir():
        try:
            _prepare(folder)
        except OSError as error:
            raise ArmModelError(
                f"{cache} cannot be written ({error.strerror or error})",
                "Set GC_TEACH_CACHE to a folder that can be.",
            ) from error
    return folder


def _prepare(folder: Path) -> None:
    _log.info("Preparing the Jaco model, once, in %s ...", folder)
    started = time.perf_counter()
    folder.parent.mkdir(parents=True, exist_ok=True)
    draft = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        urdf.write(draft)
        meshes.write(draft)
        draft.chmod(0o755)
        _publish(draft, folder)
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    _log.info("The Jaco model is ready (%.1f s).", time.perf_counter() - started)


def _publish(draft: Path, folder: Path) -> None:
    try:
        draft.rename(folder)
    except OSError:
        # Another process was faster, and a folder that is not empty is not replaced: theirs is as good.
        if not folder.is_dir():
            raise


def _fingerprint() -> str:
    """Hash everything the prepared files depend on: the recipe's text and the packages."""
    recipe = hashlib.sha256()
    for module in (urdf.__file__, meshes.__file__):
        recipe.update(Path(module).read_bytes())
    for package in (urdf.PACKAGE, "fast-simplification"):
        with contextlib.suppress(importlib.metadata.PackageNotFoundError):
            recipe.update(importlib.metadata.version(package).encode())
    return recipe.hexdigest()[:16]
