"""The study itself: its configuration, its execution, where results come from."""
