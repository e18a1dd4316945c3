"""Commands that measure what a decision rests on, run by hand; what they measure with is tested."""
