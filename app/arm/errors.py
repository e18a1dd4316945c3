"""What can go wrong with an arm; each message says what, where and what to do."""

from __future__ import annotations


class ArmError(Exception):
    """The arm cannot do what it was asked."""


class ArmInputError(ArmError, ValueError):
    """Joints, a position or a time handed to an arm are not usable numbers."""

    def __init__(self, what: str, wanted: str, got: object) -> None:
        super().__init__(
            f"The arm needs {what} as {wanted}, but got {got}. Check where the numbers come from."
        )
        self.what = what


class ArmModelError(ArmError):
    """The arm's model could not be found, read or prepared."""

    def __init__(self, what: str, remedy: str) -> None:
        super().__init__(f"The arm's model cannot be used: {what}. {remedy}")


class ArmClosedError(ArmError):
    """The arm was given back and is used nevertheless."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"This {name} was closed and may serve somebody else by now. Open a new one instead."
        )
