"""gc-teach: teach a robot arm a motion in the browser."""
