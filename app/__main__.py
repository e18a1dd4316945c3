"""The command line: ``gc-teach`` serves; the other commands work on files."""

import logging
import os
import sys
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Final

import tyro
from tyro.extras import SubcommandApp

from app import commands
from app.check import check
from app.compare import compare
from app.figures.command import figure
from app.study.command import study
from gc_core import GcError

DESCRIPTION: Final = "Teach a robot arm a motion in the browser; `gc-teach` alone serves the app."


def serve(
    files: Annotated[tuple[Path, ...], tyro.conf.Positional] = (),
    host: str = "127.0.0.1",
    port: int = 8080,
    library: str = "",
    open: tyro.conf.FlagCreatePairsOff[bool] = False,
) -> None:
    """Serve the teaching app; a fresh page opens on the files' demonstrations, or on a built-in skill.

    Args:
        files: A skill (.gcteach) or recordings to open (.mat .csv .npy .npz .h5 .hdf5).
        host: Address to listen on; by default only this computer can connect.
        port: Port to listen on.
        library: Where skills are saved: a file (skills.db, sqlite:///skills.db) or postgresql://….
        open: Open the page in the browser of this computer.
    """
    # Only this command needs viser, placo and the database, which take a second to import.
    from app.library import default_url, told  # noqa: PLC0415
    from app.pauses import avoid_pauses  # noqa: PLC0415
    from app.server import Options, Server, first_document, stop_signal  # noqa: PLC0415

    logging.basicConfig(level=logging.WARNING, format="%(message)s")
    logging.getLogger("app").setLevel(logging.INFO)
    stop = stop_signal()  # first, so that a signal while starting stops cleanly, too
    first = first_document(files)
    kept = library or default_url()
    server = Server(Options(host, port, kept), first)
    avoid_pauses()
    address = f"http://{'127.0.0.1' if host == '0.0.0.0' else host}:{server.port}/"
    print(f"gc-teach is ready: {address}   (Ctrl+C saves and stops)\n{told(kept)}", flush=True)
    if open:
        webbrowser.open(address)
    stop.wait()
    server.close()


COMMANDS: Final = (serve, commands.encode, commands.reproduce, check, compare, figure, study)


HELP: Final = ("-h", "--help")


def main(args: Sequence[str] | None = None) -> None:
    """Run the command that the arguments name; without one, serve."""
    arguments = list(sys.argv[1:] if args is None else args)
    if not arguments or (arguments[0].startswith("-") and arguments[0] not in HELP):
        arguments = ["serve", *arguments]
    cli = SubcommandApp()
    for command in COMMANDS:
        cli.command(is_default=command is serve and arguments[0] in HELP)(command)
    if arguments[0] not in {command.__name__ for command in COMMANDS}:
        # The database takes a third of a second to import, which the other commands need not.
        from app.skill_commands import cli as skills_cli  # noqa: PLC0415

        cli.command(skills_cli, name="skills", help="Saved and built-in skills, by name.")
    try:
        cli.cli(prog="gc-teach", description=DESCRIPTION, args=arguments)
    except GcError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
    except BrokenPipeError:  # `gc-teach encode ... | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)


if __name__ == "__main__":
    main()
