"""The regression tests: Python, validation, stability, and what accuracy costs."""
