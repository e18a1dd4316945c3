"""``gc-teach skills``: saved and built-in skills by name, without a browser.

A name is a skill's title, its code, or the name of a built-in one; one that several skills have is not
guessed at. What was done is said in words or, with ``--json``, as one JSON value.
"""

from __future__ import annotations

import json as json_text
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import tyro
from tyro.extras import SubcommandApp

from app import edits, skills
from app.commands import Units
from app.document import Document
from app.exports import Subject, format_of, is_skill, parcel, summary, unpack
from app.files import FileError, content_of, inspect, put
from app.library import Library, default_url
from app.model import learn
from app.pages import fresh_code
from app.resources import static_folder
from gc_core import GcError

MOST_LISTED: Final = 10_000
BACK: Final = "For 30 days it can be brought back in the app, in My skills."

cli: Final = SubcommandApp()


class SkillNameError(GcError):
    """No skill has this name, or several have."""


@dataclass(frozen=True)
class Entry:
    """A skill that can be named."""

    code: str
    """Of a saved skill, or the name of a built-in one."""
    title: str
    updated: str | None
    """When it was last saved, in ISO format, UTC; None: it is built in."""

    @property
    def built_in(self) -> bool:
        """Whether it comes with gc-teach."""
        return self.updated is None

    @property
    def facts(self) -> dict[str, Any]:
        """What ``list`` says of it as JSON."""
        return {"code": self.code, "title": self.title, "updated": self.updated, "built_in": self.built_in}


@cli.command(name="list")
def list_skills(*, library: str = "", json: bool = False) -> None:
    """List the saved skills, the last saved first, then the built-in ones.

    Args:
        library: Where skills are saved: a file (skills.db, sqlite:///skills.db) or postgresql://….
        json: Print one JSON value instead of words.
    """
    with _opened(library) as shelf:
        entries = _entries(shelf)
    lines = [
        f"{e.code:24}  {'built in' if e.updated is None else e.updated[:16]:16}  {e.title}" for e in entries
    ]
    _say([entry.facts for entry in entries], "\n".join(lines), json=json)


@cli.command(name="import")
def import_skill(
    file: tyro.conf.Positional[Path],
    *,
    name: str = "",
    units: Units = "auto",
    library: str = "",
    json: bool = False,
) -> None:
    """Save a file's skill: a .gcteach as it is, recordings as demonstrations of a new one.

    Args:
        file: A skill (.gcteach) or recordings (.mat .csv .npy .npz .h5 .hdf5).
        name: What to call it; by default as in the file, or as the file.
        units: The unit of length of recordings.
        library: Where skills are saved: a file (skills.db, sqlite:///skills.db) or postgresql://….
        json: Print one JSON value instead of words.
    """
    document = _read(file, units)
    if name:
        document = edits.rename_skill(document, name)
    code = fresh_code()
    with _opened(library) as shelf:
        shelf.save(code, document)
    facts = {"code": code, "title": document.title, "address": f"/s/{code}"}
    _say(facts, f"{summary(document)} It is saved at /s/{code}", json=json)


@cli.command(name="export")
def export_skill(
    name: tyro.conf.Positional[str],
    *,
    to: Path,
    force: tyro.conf.FlagCreatePairsOff[bool] = False,
    library: str = "",
    json: bool = False,
) -> None:
    """Write a skill as a file; the ending chooses the format.

    Args:
        name: Title or code of a saved skill, or name of a built-in one.
        to: Where to write it: .gcteach (all of it), .html (a page that plays), .csv .mat .npz .h5
            (demonstrations), .yaml .json (a run for a real Jaco), .glb (the tube), .svg .png (a figure), .py.
        force: Write in the place of a file that is there already.
        library: Where skills are saved: a file (skills.db, sqlite:///skills.db) or postgresql://….
        json: Print one JSON value instead of words.
    """
    format_of(to.name)
    if to.exists() and not force:
        raise FileError(to.name, f"{to} is there already. Choose another name, or replace it with --force.")
    document = _named(name, library)[1]
    made = parcel(to.suffix.lower(), Subject(document, learn(document), _arm))
    put(to, made.content)
    facts = {"file": str(to), "bytes": len(made.content), "title": document.title}
    _say(facts, f"{made.about}\nWritten to {to}.", json=json)


@cli.command
def show(name: tyro.conf.Positional[str], *, library: str = "", json: bool = False) -> None:
    """Say what a skill is made of.

    Args:
        name: Title or code of a saved skill, or name of a built-in one.
        library: Where skills are saved: a file (skills.db, sqlite:///skills.db) or postgresql://….
        json: Print one JSON value instead of words.
    """
    entry, document = _named(name, library)
    facts = entry.facts | _contents(document)
    demonstrations = [
        f"  {d['name']}: {d['duration_s']:.1f} s, {d['samples']} samples{', muted' if d['muted'] else ''}"
        for d in facts["demonstrations"]
    ]
    _say(facts, "\n".join([summary(document), document.about, *demonstrations]), json=json)


@cli.command
def delete(name: tyro.conf.Positional[str], *, library: str = "", json: bool = False) -> None:
    """Delete a saved skill; for 30 days the app can bring it back.

    Args:
        name: Its title or code.
        library: Where skills are saved: a file (skills.db, sqlite:///skills.db) or postgresql://….
        json: Print one JSON value instead of words.
    """
    with _opened(library) as shelf:
        entry = _find(name, _entries(shelf))
        if entry.built_in:
            raise SkillNameError(f"{entry.title} is built in and stays. Name a skill that was saved.")
        shelf.delete(entry.code)
    _say(
        {"deleted": entry.code, "title": entry.title},
        f"{entry.title} ({entry.code}) is deleted. {BACK}",
        json=json,
    )


@contextmanager
def _opened(url: str) -> Generator[Library]:
    library = Library(url or default_url())
    try:
        yield library
    finally:
        library.close()


def _entries(library: Library) -> list[Entry]:
    saved = [Entry(one.code, one.title, one.updated.isoformat()) for one in library.recent(limit=MOST_LISTED)]
    folder = _folder()
    return [
        *saved,
        *(Entry(name, skills.load_card(folder, name).title, None) for name in skills.skill_names(folder)),
    ]


def _find(name: str, entries: list[Entry]) -> Entry:
    """Find the one skill of a name; a code names at most one."""
    by_code = [entry for entry in entries if entry.code == name]
    wanted = " ".join(name.split()).casefold()
    found = by_code or [entry for entry in entries if entry.title.casefold() == wanted]
    if len(found) == 1:
        return found[0]
    if found:
        codes = ", ".join(entry.code for entry in found[:8])
        raise SkillNameError(f"{len(found)} skills are called {name[:80]}. Name one by its code: {codes}.")
    titles = ", ".join(entry.title for entry in entries[:8])
    raise SkillNameError(
        f"There is no skill called {name[:80]}. `gc-teach skills list` shows all: {titles}"
        f"{' …' if len(entries) > 8 else ''}."
    )


def _named(name: str, url: str) -> tuple[Entry, Document]:
    with _opened(url) as shelf:
        entry = _find(name, _entries(shelf))
        document = skills.load_skill(_folder(), entry.code) if entry.built_in else shelf.load(entry.code)
    if document is None:
        raise SkillNameError(f"{entry.title} was deleted just now. Name another skill.")
    return entry, document


def _read(file: Path, units: Units) -> Document:
    if is_skill(file.name):
        return unpack(file.name, content_of(file))
    reading = inspect(file)
    return edits.skill_of(file.stem, reading.accepted(None if units == "auto" else units))


def _contents(document: Document) -> dict[str, Any]:
    shown = [
        {
            "name": one.demonstration.name,
            "samples": len(one.demonstration.times),
            "duration_s": float(one.demonstration.times[-1] - one.demonstration.times[0]),
            "muted": one.muted,
        }
        for one in document.demonstrations
    ]
    return {
        "about": document.about,
        "demonstrations": shown,
        "landmarks": [place.name for place in document.landmarks],
        "starts": [start.tolist() for start in document.starts],
        "rules": [rule.name for rule in document.rules],
        "things": [thing.name for thing in document.things],
        "section": document.settings.section,
        "align_by": document.settings.align_by,
        "stations": document.settings.stations,
    }


def _arm() -> Any:
    from app.arm.jaco import Jaco  # noqa: PLC0415 - a second that only runs for an arm and pages need

    return Jaco()


def _folder() -> Path:
    return static_folder() / "skills"


def _say(facts: Any, words: str, *, json: bool) -> None:
    print(json_text.dumps(facts) if json else words, flush=True)
