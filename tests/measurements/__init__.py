"""Commands that measure what a decision rests on; run by hand, not by pytest."""
