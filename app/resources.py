"""Where the files that are not code lie: skills, lessons, help, style.

In a checkout they are the folder `static` beside `app`; in an installed wheel they are `app/static`.
"""

from pathlib import Path


class MissingResourcesError(RuntimeError):
    """The installation lacks the folder `static`; nothing a person gave is at fault."""

    def __init__(self, looked_in: tuple[Path, ...]) -> None:
        places = " and ".join(str(place) for place in looked_in)
        super().__init__(
            f"The folder 'static' with skills and styles is neither of {places}. Install gc-teach again."
        )
        self.looked_in = looked_in


def static_folder(package: Path | None = None) -> Path:
    """Find the folder with skills, lessons, help and style.

    Parameters
    ----------
    package
        The folder of the package `app`; this one's when not given.

    Returns
    -------
    Path
        ``app/static`` of a wheel, else ``static`` beside `app` in a checkout.

    Raises
    ------
    MissingResourcesError
        If it is in neither place.
    """
    home = Path(__file__).resolve().parent if package is None else package
    places = (home / "static", home.parent / "static")
    for place in places:
        if place.is_dir():
            return place
    raise MissingResourcesError(places)
