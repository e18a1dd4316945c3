"""The command line: ``gc-teach`` serves; the other commands work on files."""

import webbrowser
from pathlib import Path
from typing import Annotated

import tyro
from tyro.extras import SubcommandApp

cli = SubcommandApp()

Files = Annotated[tuple[Path, ...], tyro.conf.Positional]
OneFile = Annotated[Path, tyro.conf.Positional]


@cli.command
def serve(
    files: Files = (),
    host: str = "127.0.0.1",
    port: int = 8080,
    library: str = "",
    open: bool = False,
) -> None:
    """Serve the teaching app; with FILES, a fresh page opens on their demonstrations.

    Args:
        files: Recordings to open (.mat .csv .npy .npz .h5 .hdf5).
        host: Address to listen on; the default is this computer only.
        port: Port to listen on.
        library: Database of the saved skills, for instance sqlite:///skills.db.
        open: Open the page in the browser of this computer.
    """
    from app.library import default_url  # noqa: PLC0415 - only `serve` needs viser, placo and the database
    from app.server import Options, Server, first_document  # noqa: PLC0415

    first = first_document([str(file) for file in files])
    server = Server(Options(host, port, library or default_url()), first)
    address = f"http://{'127.0.0.1' if host in ('0.0.0.0', '') else host}:{server.port}/"
    print(f"gc-teach is ready: {address}   (Ctrl+C saves and stops)", flush=True)
    if open:
        webbrowser.open(address)
    server.wait()
