"""Stories in a real browser, with a real mouse, on the real Jaco."""
