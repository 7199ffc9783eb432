"""Moving pictures: reading, writing, frames of a walk, static pictures, movement of a fixed camera."""
