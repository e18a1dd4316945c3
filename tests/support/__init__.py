"""What several test folders share: a client without a browser, and a real browser."""
