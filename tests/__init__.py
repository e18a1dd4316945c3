"""The project's tests, fastest first; see ARCHITECTURE.md."""
