"""Cameras knocked during a take or between takes: each has one pose before and another after.

steps: `Step`, `clearest`: turns in place that fit epipolar residuals better than one pose
poses: `adjusted`, `measured`: cameras with one more pose after each step, adjusted with people
judgement: `halves`, `judged`: what held-out joints say of a step
knocks: `Knock`, `find`, `between`, `undone`, `row`: the knocks of a take, and between takes
"""
