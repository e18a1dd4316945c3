"""What the desk says to a person: what happened, why, and what to do, in centimetres and seconds."""

from app.handpull import Drawn, TakenBack


def too_short(drawn: Drawn) -> str:
    """A slip of the hand was not kept."""
    return (
        f"That was only {100 * drawn.length:.1f} cm, so it was not kept. Pull the hand through the whole "
        "motion and let go at its end."
    )


def demonstrated(drawn: Drawn, learned_from: int, kept: TakenBack) -> str:
    """A demonstration was kept, perhaps not where it was drawn."""
    if kept.muted:
        return (
            "This demonstration is kept, but muted: where you drew it the tube is turned inside out, so it "
            "cannot be taken back to where the landmarks stood. Put them back (Move) and show it again."
        )
    if kept.carried:
        return (
            f"That was a demonstration of {drawn.times[-1]:.1f} s. Landmarks are moved, so it is kept where "
            "it would have been before (red line), and the tube takes it along to here."
        )
    more = "Show it once more, a little differently."
    if learned_from >= 3:
        more = f"The tube holds {learned_from} now."
    return f"That was a demonstration of {drawn.times[-1]:.1f} s. {more}"
